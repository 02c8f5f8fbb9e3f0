"""Dispersion: a bright slit seen through prisms of ever more dispersive glass, each spectrum wider than the one before."""

import math

import common
from mathutils import Matrix

GLASSES = ((0.0, "No dispersion"), (60.0, "Crown"), (30.0, "Flint"), (15.0, "Stronger than any glass"))
"""Abbe number, 0 for none, and name."""
SIDE, HEIGHT, IOR, SPACING = 0.55, 0.42, 1.55, 0.62
DISTANCE, WIDTH = 2.2, 0.05
"""Of the slits [m]."""


def prism(name, material):
    """An upright prism on an equilateral triangle, one edge towards +x."""
    corners = [(SIDE / math.sqrt(3) * math.cos(a), SIDE / math.sqrt(3) * math.sin(a)) for a in (0, 2 * math.pi / 3, 4 * math.pi / 3)]
    vertices = [(x, y, z) for z in (0.0, HEIGHT) for x, y in corners]
    return common.mesh(name, vertices, [(2, 1, 0), (3, 4, 5), (0, 1, 4, 3), (1, 2, 5, 4), (2, 0, 3, 5)], [material])


def build():
    """The scene."""
    scene = common.new_scene("Prism", 480, 360, samples=128, max_depth=8)
    scene.glanz.sampler = "sobol"
    incidence = math.asin(IOR * math.sin(math.radians(30)))
    deviation = 2 * incidence - math.radians(60)
    slit = common.emission("Slit", (1.0, 1.0, 1.0), 4.0)
    wood = common.diffuse("Wood", (0.35, 0.27, 0.2))
    for number, (abbe, name) in enumerate(GLASSES):
        z = SPACING * (len(GLASSES) - 1 - number)
        glass = common.glass(name, (1.0, 1.0, 1.0), IOR)
        glass.glanz.abbe = abbe
        # Light that comes along +y is bent least, towards -x.
        turned = Matrix.Rotation(incidence - math.radians(30), 4, "Z")
        common.add(scene, name, prism(name, glass), Matrix.Translation((0.0, 0.0, z)) @ turned)
        board = common.box(f"Shelf {number}", (1.1, 0.9, 0.06), wood)
        common.add(scene, f"Shelf {number}", board, Matrix.Translation((0.0, 0.0, z - 0.06)))
        x = -DISTANCE * math.tan(deviation)
        strip = common.quad(f"Slit {number}", (x - 0.5 * WIDTH, DISTANCE, z), (WIDTH, 0, 0), (0, 0, HEIGHT), slit)
        common.add(scene, strip.name, strip)
    common.add(scene, "Wall", common.quad("Wall", (-6, 3.5, -2), (12, 0, 0), (0, 0, 8), common.diffuse("Wall", (0.1, 0.1, 0.12))))
    common.light(scene, "Lamp", "AREA", (-2.0, -3.0, 4.0), (0, 0, 0.8), 700.0, shape="DISK", size=2.0)
    scene.world = common.world((0.4, 0.5, 0.7), 0.06)
    # All rays alike, so that every prism bends them by the same angle.
    camera = common.camera(scene, (-0.6, -6.0, 1.1), (-0.6, 0.0, 1.1), lens=50.0)
    camera.data.type, camera.data.ortho_scale = "ORTHO", 3.5
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
