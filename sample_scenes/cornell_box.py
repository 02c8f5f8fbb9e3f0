"""A Cornell box: only diffuse surfaces and one square lamp, so every correct renderer must agree on it."""

import math

import common
from mathutils import Matrix

WHITE, RED, GREEN = (0.73, 0.73, 0.73), (0.61, 0.055, 0.05), (0.11, 0.42, 0.09)
LAMP_COLOUR, LAMP_STRENGTH = (1.0, 0.86, 0.68), 27.0
HALF_LAMP = 0.26
"""Half the side of the lamp [m]; the box is 2 m wide, deep and high."""


def ceiling(white, lamp):
    """A square with the lamp as the middle of 3 x 3 faces: flush, with no gap, and a material slot of its own."""
    lines = (-1.0, -HALF_LAMP, HALF_LAMP, 1.0)
    vertices = [(x, y, 2.0) for y in lines for x in lines]
    # Seen from below, counter-clockwise.
    faces = [(4 * j + i, 4 * (j + 1) + i, 4 * (j + 1) + i + 1, 4 * j + i + 1) for j in range(3) for i in range(3)]
    return common.mesh("Ceiling", vertices, faces, [white, lamp], material_indices=[0, 0, 0, 0, 1, 0, 0, 0, 0])


def build():
    """The scene."""
    scene = common.new_scene("Cornell box", 512, 512, samples=64, max_depth=8)
    white, red, green = (common.diffuse(n, c) for n, c in (("White", WHITE), ("Red", RED), ("Green", GREEN)))
    lamp = common.emission("Lamp", LAMP_COLOUR, LAMP_STRENGTH)
    for mesh in (
        common.quad("Floor", (-1, -1, 0), (2, 0, 0), (0, 2, 0), white),
        common.quad("Back wall", (-1, 1, 0), (2, 0, 0), (0, 0, 2), white),
        common.quad("Left wall", (-1, -1, 0), (0, 2, 0), (0, 0, 2), red),
        common.quad("Right wall", (1, 1, 0), (0, -2, 0), (0, 0, 2), green),
        ceiling(white, lamp),
    ):
        common.add(scene, mesh.name, mesh)
    turned = Matrix.Translation((-0.36, 0.36, 0.0)) @ Matrix.Rotation(math.radians(19), 4, "Z")
    common.add(scene, "Tall box", common.box("Tall box", (0.58, 0.58, 1.16), white), turned)
    for name, radius, x, y in (("Large sphere", 0.34, 0.43, -0.12), ("Small sphere", 0.17, -0.14, -0.56)):
        made = common.add(scene, name, common.sphere(name, radius, white), Matrix.Translation((x, y, radius)))
        common.exact_shadows(made)
    # The front opening fills the frame to within a percent.
    common.camera(scene, (0.0, -3.74, 1.0), (0.0, 0.0, 1.0), lens=50.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
