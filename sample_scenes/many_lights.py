"""A thousand lights: lamps of every colour over a plain of blocks; every shadow ray chooses one of them."""

import colorsys
import math
import random

import bpy
import common
from mathutils import Matrix

ROWS, SPACING = 32, 0.5
"""32 x 32 lamps [m]."""


def build():
    """The scene."""
    scene = common.new_scene("Many lights", 512, 288, samples=128, max_depth=3)
    scene.glanz.sampler = "sobol"
    rng = random.Random(5)
    half = 0.5 * ROWS * SPACING
    plain = common.quad("Plain", (-half, -half, 0), (2 * half, 0, 0), (0, 2 * half, 0), common.diffuse("Plaster", (0.6, 0.6, 0.6)))
    common.add(scene, "Plain", plain)
    block = common.box("Block", (0.22, 0.22, 1.0), common.diffuse("Stone", (0.5, 0.48, 0.45)))
    colours = 12
    lamps = [lamp(f"Lamp {number}", colorsys.hsv_to_rgb(number / colours, 0.75, 1.0)) for number in range(colours)]
    for row in range(ROWS):
        for column in range(ROWS):
            x, y = (column + 0.5) * SPACING - half, (row + 0.5) * SPACING - half
            jitter = rng.uniform(-0.1, 0.1), rng.uniform(-0.1, 0.1)
            place = Matrix.Translation((x + jitter[0], y + jitter[1], rng.uniform(0.4, 0.75)))
            common.add(scene, f"Lamp {row} {column}", rng.choice(lamps), place)
            if (row + column) % 3 == 0:
                tall = Matrix.Diagonal((1, 1, rng.uniform(0.15, 0.6), 1))
                turned = Matrix.Rotation(rng.uniform(0, math.pi), 4, "Z")
                common.add(scene, f"Block {row} {column}", block, Matrix.Translation((x + 0.25, y + 0.25, 0)) @ turned @ tall)
    common.camera(scene, (1.0, -8.6, 2.6), (0.0, -2.0, 0.2), lens=38.0)
    return scene


def lamp(name, colour):
    """A point lamp with a radius of 2 cm, 1 W."""
    data = bpy.data.lights.new(name, "POINT")
    data.energy, data.color, data.shadow_soft_size = 1.0, colour, 0.02
    return data


if __name__ == "__main__":
    common.save(build(), __file__)
