"""A golden ring on a table in low sunlight: its inside gathers the light into a cusp, which only scattered rays find."""

import math

import common

RADIUS, HEIGHT, THICKNESS, SEGMENTS = 1.0, 0.5, 0.05, 192


def ring(material):
    """A band: inside, outside, and the rims between them; smooth around, sharp at the rims."""
    circles = ((RADIUS, 0.0), (RADIUS, HEIGHT), (RADIUS + THICKNESS, HEIGHT), (RADIUS + THICKNESS, 0.0))
    vertices, faces = [], []
    for k in range(4):
        # Every band has vertices of its own, so that rims stay sharp.
        for r, z in (circles[k], circles[(k + 1) % 4]):
            vertices += [
                (r * math.cos(2 * math.pi * i / SEGMENTS), r * math.sin(2 * math.pi * i / SEGMENTS), z + 1 / 1024) for i in range(SEGMENTS)
            ]
        first = 2 * k * SEGMENTS
        for i in range(SEGMENTS):
            j = (i + 1) % SEGMENTS
            faces.append((first + i, first + j, first + SEGMENTS + j, first + SEGMENTS + i))
    return common.mesh("Ring", vertices, faces, [material], smooth=True)


def build():
    """The scene."""
    scene = common.new_scene("Ring caustic", 480, 320, samples=1024, max_depth=6)
    scene.glanz.sampler = "sobol"
    common.add(scene, "Table", common.quad("Table", (-6, -6, 0), (12, 0, 0), (0, 12, 0), common.diffuse("Paper", (0.62, 0.6, 0.56))))
    common.add(scene, "Ring", ring(common.glossy("Gold", (1.0, 0.76, 0.33), 0.0)))
    common.light(scene, "Sun", "SUN", (2.2, 3.4, 2.6), (0, 0, 0), 2.4, angle=math.radians(12), color=(1.0, 0.95, 0.85))
    scene.world = common.world((0.45, 0.6, 1.0), 0.2)
    common.camera(scene, (0.4, -3.3, 3.9), (0.0, -0.05, 0.1), lens=52.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
