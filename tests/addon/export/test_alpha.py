"""Leaves on cards: what an image's alpha cuts out of a shader arrives as the alpha of the material."""

import bpy
import numpy as np
import pytest

from glanz.engine import ImageTexture, Lambert, LinearTexture, Transparent
from glanz.tests.addon import blender
from glanz.tests.addon.export.test_textures import PIXELS, exported, new_image

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


@pytest.mark.parametrize("is_principled", [False, True])
def test_the_alpha_of_an_image_cuts_the_leaf_out_of_its_card(is_principled):
    o, warnings = exported(leaf(is_principled)[0])
    assert warnings == ()
    material = o.materials[0]
    (lobe,) = material.lobes
    assert type(lobe) is Lambert
    assert type(material.alpha) is type(lobe.reflectance) is ImageTexture
    assert not material.alpha.bitmap.is_srgb
    np.testing.assert_allclose(material.alpha.bitmap.pixels / 255, np.broadcast_to(ALPHA, (3, *ALPHA.shape)), atol=0.003)


def test_what_is_not_there_has_the_average_colour_of_what_is():
    """So that filters do not darken edges; what is there keeps its own, which alpha does not darken."""
    (lobe,) = exported(leaf()[0])[0].materials[0].lobes
    pixels = np.moveaxis(lobe.reflectance.bitmap.pixels / 255, 0, 2)
    there = ALPHA > 0
    np.testing.assert_allclose(pixels[there], LEAF[..., :3][there], atol=0.005)
    average = (LEAF[..., :3] * ALPHA[..., None]).sum(axis=(0, 1)) / ALPHA.sum()
    np.testing.assert_allclose(pixels[~there], np.broadcast_to(average, (np.count_nonzero(~there), 3)), atol=0.01)


def test_a_leaf_in_floating_point_is_uncut_too():
    """Blender hands it out multiplied by alpha."""
    premultiplied = np.dstack((LEAF[..., :3] * ALPHA[..., None], ALPHA))
    material = exported(leaf(pixels=premultiplied, is_float=True)[0])[0].materials[0]
    there = ALPHA > 0
    np.testing.assert_allclose(np.moveaxis(material.lobes[0].reflectance.bitmap.pixels, 0, 2)[there], LEAF[..., :3][there], rtol=1e-5)
    np.testing.assert_allclose(material.alpha.bitmap.pixels[0], ALPHA, rtol=1e-6)


def test_a_leaf_may_be_the_first_of_a_mix():
    o, warnings = exported(leaf(swapped=True)[0])
    assert warnings == ()
    alpha = o.materials[0].alpha
    assert type(alpha) is LinearTexture
    assert (alpha.factors, alpha.offset) == (((-1.0,) * 3,), (1.0,) * 3)


def test_a_tinted_veil_around_a_leaf_is_mixed_by_the_average_and_named():
    o, warnings = exported(leaf(clear=(1, 0.5, 0, 1))[0])
    assert any("counts with its average" in line and "material 'Leaf'" in line for line in warnings)
    (clear,) = (lobe for lobe in o.materials[0].lobes if type(lobe) is Transparent)
    assert clear.transmittance == pytest.approx((1 - ALPHA.mean()) * np.array((1, 0.5, 0)), abs=0.005)
    assert o.materials[0].alpha == 1


def test_an_image_without_alpha_cuts_nothing_out():
    material, picture = leaf()
    picture.image.alpha_mode = "NONE"
    o, _ = exported(material)
    assert (o.materials[0].alpha.bitmap.pixels == 255).all()


def test_what_glows_through_a_leaf_is_named():
    material, _ = leaf(shader="ShaderNodeEmission")
    o, warnings = exported(material)
    assert any("not cut out" in line for line in warnings)
    assert max(o.materials[0].emission.bounds()[1]) > 0
