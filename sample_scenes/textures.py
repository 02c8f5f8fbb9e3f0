"""Textures: a picture, a checker, noise, gradients; noise as bumps, and a picture of normals."""

import common
import numpy as np
from mathutils import Matrix

SIDE = 64
"""Pixels of the pictures."""


def tiles():
    """Four coloured tiles with light joints, linear (SIDE, SIDE, 4), row 0 at the bottom."""
    y, x = np.mgrid[0:SIDE, 0:SIDE] / SIDE
    colours = np.array([[(0.7, 0.2, 0.1), (0.75, 0.55, 0.15)], [(0.1, 0.35, 0.5), (0.2, 0.45, 0.2)]])
    picture = colours[(y * 2).astype(int), (x * 2).astype(int)]
    from_middle = np.maximum(np.abs((x * 2) % 1 - 0.5), np.abs((y * 2) % 1 - 0.5))
    picture[from_middle > 0.44] = (0.75, 0.72, 0.66)
    return np.concatenate((picture, np.ones((SIDE, SIDE, 1))), axis=2)


def studs():
    """Tangent-space normals of round studs, 2 x 2 of them, encoded as (n + 1) / 2."""
    y, x = np.mgrid[0:SIDE, 0:SIDE] / SIDE * 2 % 1 * 2 - 1
    r = np.hypot(x, y) / 0.8
    normal = np.stack((x / 0.8, y / 0.8, np.sqrt(np.maximum(1 - r * r, 0.15))), axis=2)
    normal[r >= 1] = (0, 0, 1)
    normal /= np.linalg.norm(normal, axis=2, keepdims=True)
    return np.concatenate((0.5 * normal + 0.5, np.ones((SIDE, SIDE, 1))), axis=2)


def picture_of_tiles():
    made = common.diffuse("Picture", (0.5, 0.5, 0.5))
    (image,) = common.nodes(made, "ShaderNodeTexImage")
    image.image = common.picture("Tiles", SIDE, SIDE, tiles().ravel())
    common.colour_by(made, image.outputs["Color"])
    return made


def checker():
    made = common.diffuse("Checker", (0.5, 0.5, 0.5))
    (node,) = common.nodes(made, "ShaderNodeTexChecker")
    node.inputs["Color1"].default_value, node.inputs["Color2"].default_value = (0.8, 0.75, 0.6, 1), (0.1, 0.03, 0.05, 1)
    node.inputs["Scale"].default_value = 6.0
    common.colour_by(made, node.outputs["Color"])
    return made


def noise():
    made = common.diffuse("Noise", (0.5, 0.5, 0.5))
    (node,) = common.nodes(made, "ShaderNodeTexNoise")
    node.inputs["Scale"].default_value, node.inputs["Detail"].default_value = 4.0, 5.0
    common.colour_by(made, node.outputs["Color"])
    return made


def gradient():
    made = common.diffuse("Gradient", (0.5, 0.5, 0.5))
    (node,) = common.nodes(made, "ShaderNodeTexGradient")
    node.gradient_type = "LINEAR"
    common.colour_by(made, node.outputs["Color"])
    return made


def bumps():
    made = common.diffuse("Bumps", (0.55, 0.35, 0.2))
    noise, bump = common.nodes(made, "ShaderNodeTexNoise", "ShaderNodeBump")
    noise.inputs["Scale"].default_value, noise.inputs["Detail"].default_value = 7.0, 3.0
    bump.inputs["Strength"].default_value, bump.inputs["Distance"].default_value = 1.0, 0.12
    common.connect(made, noise.outputs[0], bump.inputs["Height"])
    common.connect(made, bump.outputs["Normal"], common.shader(made).inputs["Normal"])
    return made


def normals():
    made = common.diffuse("Normals", (0.3, 0.4, 0.55))
    image, normal = common.nodes(made, "ShaderNodeTexImage", "ShaderNodeNormalMap")
    image.image = common.picture("Studs", SIDE, SIDE, studs().ravel(), is_colour=False)
    common.connect(made, image.outputs["Color"], normal.inputs["Color"])
    common.connect(made, normal.outputs["Normal"], common.shader(made).inputs["Normal"])
    return made


def build():
    """The scene."""
    scene = common.new_scene("Textures", 560, 360, samples=64, max_depth=4)
    scene.glanz.sampler = "sobol"
    for number, make in enumerate((picture_of_tiles, checker, noise, gradient, bumps, normals)):
        material = make()
        row, column = divmod(number, 3)
        ball = common.wrapped(common.sphere(material.name, 0.5, material, segments=48, rings=24), around=6.0, up=3.0)
        place = Matrix.Translation((1.25 * (column - 1), 0.0, 1.75 - 1.2 * row)) @ Matrix.Rotation(-0.4, 4, "Z")
        common.add(scene, material.name, ball, place)
    common.add(scene, "Wall", common.quad("Wall", (-6, 1.1, -4), (12, 0, 0), (0, 0, 10), common.diffuse("Wall", (0.32, 0.33, 0.36))))
    common.light(scene, "Key", "AREA", (-2.8, -3.4, 3.6), (0, 0, 1.1), 330.0, shape="SQUARE", size=0.8)
    scene.world = common.world((0.7, 0.8, 1.0), 0.18)
    common.camera(scene, (0.0, -7.2, 1.15), (0.0, 0.0, 1.15), lens=68.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
