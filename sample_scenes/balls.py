"""The pyramid of balls that several sample scenes share; not a scene itself."""

import math

import common
from mathutils import Matrix

RADIUS = 0.5


def places():
    """The middles of ten balls that lie in a pyramid: six on the floor, three on these, one on top."""
    height = 2 * RADIUS * math.sqrt(2 / 3)
    for layer in range(3):
        side = 3 - layer
        # Each layer sits in the hollows of the one below.
        x0, y0 = layer * RADIUS, layer * RADIUS / math.sqrt(3)
        for row in range(side):
            for column in range(side - row):
                x = x0 + (2 * column + row) * RADIUS - 2 * RADIUS
                y = y0 + row * RADIUS * math.sqrt(3) - 2 * RADIUS / math.sqrt(3)
                yield x, y, RADIUS + layer * height


def tiles(dark, light, count=24, size=0.5):
    """A square of tiles about the origin, dark and light in turn."""
    half = 0.5 * count * size
    vertices = [(x * size - half, y * size - half, 0.0) for y in range(count + 1) for x in range(count + 1)]
    row = count + 1
    faces = [(y * row + x, y * row + x + 1, (y + 1) * row + x + 1, (y + 1) * row + x) for y in range(count) for x in range(count)]
    return common.mesh("Floor", vertices, faces, [dark, light], material_indices=[(x + y) % 2 for y in range(count) for x in range(count)])


def build(name, make_materials, max_depth):
    """A scene with the pyramid on a tiled floor, of balls of the materials of `make_materials`() in turn. Whitted's ray tracing."""
    scene = common.new_scene(name, 480, 360, samples=16, max_depth=max_depth)
    scene.glanz.integrator = "whitted"
    floor = tiles(common.diffuse("Slate", (0.05, 0.09, 0.16)), common.diffuse("Ivory", (0.75, 0.7, 0.58)))
    common.add(scene, "Floor", floor)
    balls = [common.sphere(material.name, RADIUS, material, segments=64, rings=32) for material in make_materials()]
    for i, place in enumerate(places()):
        common.add(scene, f"Ball {i}", balls[i % len(balls)], Matrix.Translation(place))
    common.light(scene, "Lamp", "POINT", (-2.5, -3.0, 4.5), (0, 0, 0), 1500.0, shadow_soft_size=0.0)
    common.light(scene, "Fill", "POINT", (3.5, -1.5, 3.5), (0, 0, 0), 600.0, shadow_soft_size=0.0, color=(1.0, 0.75, 0.5))
    scene.world = common.world((0.25, 0.45, 0.9), 0.35)
    common.camera(scene, (0.7, -5.6, 2.5), (0.0, 0.0, 0.92), lens=50.0)
    return scene
