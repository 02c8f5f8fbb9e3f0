"""A checkerboard to the horizon: what textures are filtered for, even with one sample per pixel."""

import common


def build():
    """The scene: on the left the checker as a formula, on the right as a picture of 32 x 32 pixels."""
    scene = common.new_scene("Checkerboard", 512, 288, samples=64, max_depth=1)
    for x, material in ((-400.0, by_formula()), (0.0, by_picture())):
        ground = common.quad(material.name, (x, -10.0, 0.0), (400.0, 0, 0), (0, 800.0, 0), material)
        layer = ground.uv_layers.new(name="UVMap")
        # In metres.
        layer.uv.foreach_set("vector", [0.0, 0.0, 400.0, 0.0, 400.0, 800.0, 0.0, 800.0])
        common.add(scene, material.name, ground)
    common.light(scene, "Sun", "SUN", (1.0, -2.0, 3.0), (0, 0, 0), 2.6)
    scene.world = common.world((0.3, 0.5, 0.9), 0.6)
    common.camera(scene, (0.02, -4.0, 1.6), (0.0, 4.0, 0.9), lens=26.0)
    return scene


def by_formula():
    """A Checker Texture with squares of half a metre."""
    made = common.diffuse("Formula", (0.5, 0.5, 0.5))
    checker, coordinates = common.nodes(made, "ShaderNodeTexChecker", "ShaderNodeTexCoord")
    for identifier, colour in (("Color1", (0.8, 0.78, 0.7)), ("Color2", (0.06, 0.05, 0.08))):
        checker.inputs[identifier].default_value = (*colour, 1.0)
    checker.inputs["Scale"].default_value = 2.0
    common.connect(made, coordinates.outputs["UV"], checker.inputs["Vector"])
    common.colour_by(made, checker.outputs["Color"])
    return made


def by_picture():
    """The same as a picture."""
    made = common.diffuse("Picture", (0.5, 0.5, 0.5))
    dark, light = (0.06, 0.05, 0.08, 1.0), (0.8, 0.78, 0.7, 1.0)
    side = range(32)
    picture = common.picture("Squares", 32, 32, [c for y in side for x in side for c in ((light, dark)[(x // 16 + y // 16) % 2])])
    image, coordinates = common.nodes(made, "ShaderNodeTexImage", "ShaderNodeTexCoord")
    image.image = picture
    common.connect(made, coordinates.outputs["UV"], image.inputs["Vector"])
    common.colour_by(made, image.outputs["Color"])
    return made


if __name__ == "__main__":
    common.save(build(), __file__)
