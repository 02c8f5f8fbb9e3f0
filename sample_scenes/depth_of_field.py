"""A row of balls that runs from near to far, sharp at the third only, and lamps far behind that show the shape of the aperture."""

import math

import common
from mathutils import Matrix

RADIUS, SPACING, IN_FOCUS, BALLS = 0.45, 1.3, 2, 7
COLOURS = ((0.75, 0.16, 0.12), (0.8, 0.42, 0.08), (0.8, 0.72, 0.2), (0.22, 0.55, 0.2), (0.1, 0.45, 0.55), (0.14, 0.2, 0.6), (0.4, 0.1, 0.5))
BLADES = 6


def place(number):
    """Where ball `number` stands: a row that leads away from the camera, to the right."""
    return -1.75 + 0.85 * number, SPACING * number, RADIUS


def tiles(light, dark, half_width=9, near=-4, far=22):
    """A floor of squares of 1 m, light and dark in turn."""
    columns, rows = range(-half_width, half_width + 1), range(near, far + 1)
    vertices = [(x, y, 0.0) for y in rows for x in columns]
    stride = len(columns)
    faces, indices = [], []
    for row in range(len(rows) - 1):
        for column in range(stride - 1):
            first = row * stride + column
            faces.append((first, first + 1, first + 1 + stride, first + stride))
            indices.append((row + column) % 2)
    return common.mesh("Tiles", vertices, faces, [light, dark], material_indices=indices)


def build():
    """The scene."""
    scene = common.new_scene("Depth of field", 640, 400, samples=256, max_depth=4)
    common.add(scene, "Tiles", tiles(common.diffuse("Stone", (0.5, 0.49, 0.46)), common.diffuse("Slate", (0.09, 0.1, 0.11))))
    for number in range(BALLS):
        ball = common.sphere(f"Ball {number}", RADIUS, common.diffuse(f"Paint {number}", COLOURS[number]), segments=64, rings=32)
        common.add(scene, f"Ball {number}", ball, Matrix.Translation(place(number)))
    glow = common.emission("Glow", (1.0, 0.6, 0.22), 30.0)
    bulb = common.sphere("Bulb", 0.08, glow, segments=12, rings=6)
    for number in range(11):
        spot = Matrix.Translation((-6.2 + 1.35 * number, 17.0 + math.sin(2.1 * number), 2.6 + 0.9 * math.sin(1.7 * number)))
        common.add(scene, f"Bulb {number}", bulb, spot)
    common.light(scene, "Key", "AREA", (-4.5, -1.0, 6.5), (1.0, 4.0, 0.0), 650.0, shape="DISK", size=1.5, color=(1.0, 0.95, 0.88))
    scene.world = common.world((0.5, 0.65, 1.0), 0.12)
    made = common.camera(scene, (-0.9, -4.8, 1.7), (0.7, 3.0, 0.95), lens=40.0)
    dof = made.data.dof
    dof.use_dof = True
    dof.focus_object = scene.objects[f"Ball {IN_FOCUS}"]
    dof.aperture_fstop = 0.08
    dof.aperture_blades = BLADES
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
