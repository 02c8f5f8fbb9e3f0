"""Metal and glass balls on a tiled floor: what is reflected, what is bent, and how many bounces that takes."""

import common
from mathutils import Matrix

TILES, TILE = 14, 0.5
METALS = (
    ("Silver", (0.95, 0.94, 0.91), (-1.35, 0.75, 0.75), 0.75),
    ("Gold", (1.0, 0.72, 0.3), (0.15, 1.35, 0.6), 0.6),
    ("Copper", (0.95, 0.6, 0.48), (1.55, 0.7, 0.7), 0.7),
)
GLASSES = (("Glass", 1.5, (-0.45, -0.55, 0.55), 0.55), ("Diamond", 2.42, (0.75, -0.45, 0.38), 0.38))


def floor(dark, light):
    """A square of tiles of two materials about the origin, one of them at the even places."""
    half = 0.5 * TILES * TILE
    vertices = [(x * TILE - half, y * TILE - half, 0.0) for y in range(TILES + 1) for x in range(TILES + 1)]
    row = TILES + 1
    faces = [(y * row + x, y * row + x + 1, (y + 1) * row + x + 1, (y + 1) * row + x) for y in range(TILES) for x in range(TILES)]
    return common.mesh("Floor", vertices, faces, [dark, light], material_indices=[(x + y) % 2 for y in range(TILES) for x in range(TILES)])


def build():
    """The scene."""
    scene = common.new_scene("Mirror and glass", 768, 432, samples=256, max_depth=12)
    common.add(scene, "Floor", floor(common.diffuse("Slate", (0.06, 0.09, 0.12)), common.diffuse("Ivory", (0.7, 0.66, 0.58))))
    for name, colour, place, radius in METALS:
        ball = common.sphere(name, radius, common.glossy(name, colour, 0.0))
        common.add(scene, name, ball, Matrix.Translation(place))
    for name, ior, place, radius in GLASSES:
        ball = common.sphere(name, radius, common.glass(name, (1.0, 1.0, 1.0), ior))
        common.add(scene, name, ball, Matrix.Translation(place))
    # Darker than the sky, or the silver ball would not stand out from it.
    wall = common.quad("Wall", (-8.0, 3.2, 0.0), (16.0, 0.0, 0.0), (0.0, 0.0, 7.0), common.diffuse("Plaster", (0.13, 0.07, 0.05)))
    common.add(scene, "Wall", wall)
    common.light(scene, "Window", "AREA", (-3.5, -2.5, 4.5), (0.0, 0.3, 0.4), 320.0, shape="RECTANGLE", size=2.5, size_y=2.5)
    scene.world = common.world((0.5, 0.62, 0.8), 0.7)
    common.camera(scene, (0.3, -5.6, 2.3), (0.1, 0.2, 0.45), lens=48.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
