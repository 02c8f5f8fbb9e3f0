"""The world is an even radiance and a picture; what is more than that is named."""

import bpy
import numpy as np
import pytest

from glanz.engine import EnvironmentTexture
from glanz.tests.addon import blender
from glanz.tests.addon.sky import new_image, set_sky


def test_background_is_colour_times_strength():
    blender.set_world((0.1, 0.2, 0.4), 5)
    scene, warnings = blender.export()
    assert scene.world.radiance == pytest.approx((0.5, 1, 2))
    assert warnings == ()


def test_no_world_is_black():
    bpy.context.scene.world = None
    assert blender.export()[0].world.radiance == (0, 0, 0)


def test_an_unlinked_output_is_black():
    world = blender.set_world((1, 1, 1))
    world.node_tree.links.clear()
    assert blender.export()[0].world.radiance == (0, 0, 0)


def test_no_output_is_black_and_named():
    world = blender.set_world((1, 1, 1))
    world.node_tree.nodes.clear()
    scene, warnings = blender.export()
    assert scene.world.radiance == (0, 0, 0)
    assert "world 'World'" in warnings[0]


def picture(seed=1):
    return np.random.default_rng(seed).random((4, 8, 3)).astype(np.float32)


def test_a_picture_of_the_sky_is_the_environment():
    set_sky(new_image(picture()), strength=3.0, interpolation="Closest")
    scene, warnings = blender.export()
    world = scene.world
    assert warnings == ()
    assert world.radiance == (0, 0, 0)
    assert world.environment.name == "Sky"
    assert world.environment.strength == (3, 3, 3)
    assert world.environment.interpolation == "closest"
    assert (world.environment.pixels == np.moveaxis(picture(), 2, 0)).all()
    assert (world.environment.world_from_map == np.eye(3)).all()


def test_bytes_are_multiplied_by_alpha_and_decoded():
    """sRGB 128 of 255 is 0.2159 linear; of half alpha only half of the code counts, as in Cycles, unless alpha means something else."""
    for mode, expected in (("STRAIGHT", 0.051269), ("CHANNEL_PACKED", 0.215861), ("NONE", 0.215861)):
        image = new_image(np.full((2, 4, 3), 128 / 255), is_float=False, alpha=128 / 255)
        image.alpha_mode = mode
        set_sky(image)
        np.testing.assert_allclose(blender.export()[0].world.environment.pixels, expected, rtol=1e-5)


def test_one_picture_is_loaded_as_it_is_saved(tmp_path):
    """From a file on disk, which nobody has looked at yet."""
    image = new_image(picture())
    image.file_format, image.filepath_raw = "OPEN_EXR", str(tmp_path / "sky.exr")
    image.save()
    set_sky(bpy.data.images.load(str(tmp_path / "sky.exr")))
    np.testing.assert_allclose(blender.export()[0].world.environment.pixels, np.moveaxis(picture(), 2, 0), rtol=1e-3)


def link_shader(kind, *shaders):
    """The world's output shows a node `kind` over `shaders`."""
    tree = bpy.context.scene.world.node_tree
    node = tree.nodes.new(kind)
    free = [socket for socket in node.inputs if socket.type == "SHADER"]
    for socket, shader in zip(free, shaders):
        tree.links.new(shader.outputs[0], socket)
    tree.links.new(node.outputs[0], next(n for n in tree.nodes if n.type == "OUTPUT_WORLD").inputs["Surface"])
    return node


def test_pictures_and_colours_mix_and_add():
    texture = set_sky(new_image(picture()), strength=2.0)
    tree = texture.id_data
    first = next(node for node in tree.nodes if node.type == "BACKGROUND")
    second = blender.add_node(tree, "ShaderNodeBackground", Color=(0.1, 0.2, 0.4, 1), Strength=5)
    mix = link_shader("ShaderNodeMixShader", first, second)
    blender.node_input(mix, "Fac").default_value = 0.25
    world = blender.export()[0].world
    assert world.environment.strength == pytest.approx((1.5,) * 3)
    assert world.radiance == pytest.approx((0.125, 0.25, 0.5))
    link_shader("ShaderNodeAddShader", first, second)
    world = blender.export()[0].world
    assert world.environment.strength == (2, 2, 2)
    assert world.radiance == pytest.approx((0.5, 1, 2))
    link_shader("ShaderNodeAddShader", first, first)
    world = blender.export()[0].world
    assert world.environment.strength == (4, 4, 4)


@pytest.mark.parametrize(
    ("kind", "inputs"), [("POINT", {"Location": (0, 1, 0)}), ("TEXTURE", {"Scale": (1, 2, 1)}), ("VECTOR", {"Scale": (1, 0, 1)})]
)
def test_a_picture_that_is_not_just_turned_is_a_texture(kind, inputs):
    set_sky(new_image(picture()), vector_type=kind, Rotation=(0, 0, 0.5), **inputs)
    scene, warnings = blender.export()
    assert warnings == ()
    assert scene.world.environment is None
    assert type(scene.world.radiance) is EnvironmentTexture


def test_what_an_environment_texture_cannot_do_is_named():
    set_sky(new_image(picture()), interpolation="Cubic")
    (line,) = blender.export()[1]
    assert line.endswith("interpolation Cubic of Environment Texture is rendered as Linear: node 'Environment Texture' of world 'World'")


def test_a_missing_picture_is_magenta_and_named():
    set_sky(None)
    scene, warnings = blender.export()
    assert scene.world.environment.pixels.ravel().tolist() == [1, 0, 1]
    assert warnings == ("the image is missing and is rendered magenta: node 'Environment Texture' of world 'World'",)
    image = bpy.data.images.new("lost", 4, 4)
    image.source, image.filepath = "FILE", "//nowhere.exr"
    set_sky(image)
    assert blender.export()[1] == ("the image 'lost' is missing and is rendered magenta: node 'Environment Texture' of world 'World.001'",)


@pytest.mark.skipif(bpy.app.version >= (5, 0), reason="from Blender 5.0 on every world has nodes")
def test_without_nodes_the_viewport_colour_counts():
    world = bpy.data.worlds.new("Plain")
    world.color = (0.1, 0.2, 0.3)
    bpy.context.scene.world = world
    assert blender.export()[0].world.radiance == pytest.approx((0.1, 0.2, 0.3))


@pytest.mark.skipif(bpy.app.version < (5, 0), reason="view layers override the world from Blender 5.0 on")
def test_a_view_layers_world_override_counts():
    override = blender.set_world((0, 1, 0))
    blender.set_world((1, 0, 0))
    bpy.context.view_layer.world_override = override
    assert blender.export()[0].world.radiance == (0, 1, 0)


@pytest.mark.parametrize(
    ("setting", "words"),
    [("use_motion_blur", "motion blur"), ("use_freestyle", "freestyle")],
)
def test_render_settings_that_are_not_followed_are_named(setting, words):
    setattr(bpy.context.scene.render, setting, True)
    warnings = blender.export()[1]
    assert len(warnings) == 1
    assert words in warnings[0]
    assert "scene 'Scene'" in warnings[0]


def test_a_film_that_is_clear_behind_glass_is_named_where_it_would_be():
    scene = bpy.context.scene
    scene.cycles.film_transparent_glass = True
    assert blender.export()[1] == ()
    scene.render.film_transparent = True
    assert blender.export()[1] == ("the film is not transparent behind glass, the world is seen through it: scene 'Scene'",)


@pytest.mark.parametrize("kind", ["camera", "distance"])
def test_culling_is_named_where_it_would_be_done(kind):
    scene = bpy.context.scene
    setattr(scene.cycles, f"use_{kind}_cull", True)
    assert blender.export()[1] == ()
    scene.render.use_simplify = True
    (warning,) = blender.export()[1]
    assert "culled" in warning and "scene 'Scene'" in warning


def test_aovs_of_a_world_are_named_where_a_pass_shows_them():
    tree = blender.set_world((1, 1, 1)).node_tree
    tree.nodes.new("ShaderNodeOutputAOV").aov_name = "Heat"
    layer = bpy.context.view_layer
    layer.aovs.add().name = "Other"
    assert blender.export()[1] == ()
    layer.aovs.add().name = "Heat"
    assert blender.export()[1] == ("its AOVs are left out, they are 0 where the world is seen: world 'World'",)
