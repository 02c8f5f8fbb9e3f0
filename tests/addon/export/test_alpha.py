"""Leaves on cards: where an image's alpha cuts a shader out, light goes straight on."""

import bpy
import numpy as np
import pytest

from glanz.engine import ImageTexture, Lambert, Transparent
from glanz.engine.maths.lookup import places
from glanz.engine.scene.graphs import with_inner
from glanz.tests.addon import blender
from glanz.tests.addon.export.test_textures import PIXELS, exported, new_image
from glanz.tests.textured import Anywhere, extremes

ALPHA = np.where(PIXELS[..., 3] > 0.5, PIXELS[..., 3], 0).astype(np.float32)
LEAF = np.dstack((PIXELS[..., :3], ALPHA))


def leaf(is_principled=False, clear=(1, 1, 1, 1), swapped=False, shader="ShaderNodeBsdfDiffuse", pixels=LEAF, **image):
    """(material, image node) of a card with a leaf: Principled, or a shader mixed with Transparent."""
    material = bpy.data.materials.new("Leaf")
    tree = blender.new_nodes(material)
    surface = tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"]
    picture = blender.add_node(tree, "ShaderNodeTexImage")
    picture.image = new_image(pixels=pixels, alpha=True, **image)
    picture.interpolation = "Closest"
    if is_principled:
        shown = blender.add_node(tree, "ShaderNodeBsdfPrincipled", Specular_IOR_Level=0, Roughness=1)
        tree.links.new(picture.outputs["Color"], blender.node_input(shown, "Base Color"))
        tree.links.new(picture.outputs["Alpha"], blender.node_input(shown, "Alpha"))
        tree.links.new(shown.outputs[0], surface)
        return material, picture
    shown = tree.nodes.new(shader)
    tree.links.new(picture.outputs["Color"], shown.inputs["Color"])
    nothing = blender.add_node(tree, "ShaderNodeBsdfTransparent", Color=clear)
    mix = tree.nodes.new("ShaderNodeMixShader")
    tree.links.new(picture.outputs["Alpha"], mix.inputs[0])
    tree.links.new((shown if swapped else nothing).outputs[0], mix.inputs[1])
    tree.links.new((nothing if swapped else shown).outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], surface)
    return material, picture


def parts(material):
    """(what is reflected, what goes straight on) at points all over the card, (3, N) each, and the images that they show."""
    lobes = {type(lobe): lobe for lobe in material.lobes}
    assert set(lobes) == {Lambert, Transparent}
    textures = lobes[Lambert].reflectance, lobes[Transparent].transmittance
    images = [t for texture in textures for t in with_inner(texture) if isinstance(t, ImageTexture)]
    return *(np.broadcast_to(Anywhere().value(texture), (3, Anywhere.count)) for texture in textures), images


def shown(channel):
    """A channel (H, W) at the same points."""
    x, y, _ = Anywhere().attribute(None)[0]
    height, width = channel.shape
    return channel[(y * height).astype(int), (x * width).astype(int)]


@pytest.mark.parametrize("is_principled", [False, True])
def test_the_alpha_of_an_image_cuts_the_leaf_out_of_its_card(is_principled):
    o, warnings = exported(leaf(is_principled)[0])
    assert warnings == ()
    reflected, passed, images = parts(o.materials[0])
    np.testing.assert_allclose(passed, np.broadcast_to(1 - shown(ALPHA), passed.shape), atol=0.003)
    assert (reflected[:, shown(ALPHA) == 0] == 0).all()
    assert (reflected[:, shown(ALPHA) > 0] > 0).any()
    assert {image.output for image in images} == {"uncut", "alpha"}
    # Loaded once for both.
    assert len({image.bitmap for image in images}) == 1


def colours_of(material):
    """The colour (H, W, 3) in the middle of each texel."""
    pyramid = next(image.bitmap for image in parts(material)[2] if image.output == "uncut").uncut
    height, width = ALPHA.shape
    x, y = np.meshgrid((np.arange(width, dtype=np.float32) + 0.5) / width, (np.arange(height, dtype=np.float32) + 0.5) / height)
    where = places(pyramid.layout, x.ravel(), y.ravel(), None, "extend", "linear")
    return pyramid.colours(where).T.reshape(height, width, 3)


def test_what_is_there_keeps_its_colour_which_alpha_does_not_darken():
    """To the rounding of bytes that were multiplied by alpha."""
    there = ALPHA > 0
    codes = LEAF[..., :3][there]
    linear = np.where(codes <= 0.04045, codes / 12.92, ((codes + 0.055) / 1.055) ** 2.4)
    np.testing.assert_allclose(colours_of(exported(leaf()[0])[0].materials[0])[there], linear, atol=0.02)


def test_a_leaf_in_floating_point_is_uncut_too():
    """Blender hands it out multiplied by alpha."""
    premultiplied = np.dstack((LEAF[..., :3] * ALPHA[..., None], ALPHA))
    material = exported(leaf(pixels=premultiplied, is_float=True)[0])[0].materials[0]
    there = ALPHA > 0
    np.testing.assert_allclose(colours_of(material)[there], LEAF[..., :3][there], rtol=1e-5)
    np.testing.assert_allclose(parts(material)[1][0], 1 - shown(ALPHA), atol=1e-6)


def test_a_leaf_may_be_the_first_of_a_mix():
    o, warnings = exported(leaf(swapped=True)[0])
    assert warnings == ()
    reflected, passed, _ = parts(o.materials[0])
    np.testing.assert_allclose(passed, np.broadcast_to(shown(ALPHA), passed.shape), atol=0.003)
    # Where nothing of the leaf is there it has no colour either, as in Cycles.
    part = (shown(ALPHA) > 0) & (shown(ALPHA) < 1)
    assert (reflected[:, part] > 0).any()
    assert (reflected[:, shown(ALPHA) == 0] == 0).all()


def test_a_veil_around_a_leaf_may_have_a_colour():
    o, warnings = exported(leaf(clear=(1, 0.5, 0, 1))[0])
    assert warnings == ()
    np.testing.assert_allclose(parts(o.materials[0])[1], (1 - shown(ALPHA)) * np.array([[1], [0.5], [0]]), atol=0.003)


def test_an_image_without_alpha_cuts_nothing_out():
    material, picture = leaf()
    picture.image.alpha_mode = "NONE"
    o, _ = exported(material)
    assert (parts(o.materials[0])[1] == 0).all()


def test_what_glows_through_a_leaf_is_cut_out_with_it():
    material, _ = leaf(shader="ShaderNodeEmission")
    o, warnings = exported(material)
    assert warnings == ()
    found = np.broadcast_to(Anywhere().value(o.materials[0].emission), (3, Anywhere.count))
    assert (found[:, shown(ALPHA) == 0] == 0).all()
    assert max(extremes(o.materials[0].emission)[1]) > 0
