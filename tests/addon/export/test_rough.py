"""Rough shaders become lobes as wide as GGX's, whose share of light depends on the angle."""

import bpy
import numpy as np
import pytest

from glanz.addon.export import closure, inside, principled
from glanz.engine import (
    CheckerTexture,
    Coordinates,
    GgxAlbedo,
    Gloss,
    Mirror,
    OrenNayar,
    OrthographicCamera,
    RoughRefraction,
    SheenAlbedo,
    is_texture,
)
from glanz.engine.scene.points import Probes
from glanz.tests import helpers as h
from glanz.tests.addon import blender


def _exported(material):
    """(engine material, warnings)."""
    blender.add_plane().data.materials.append(material)
    scene, warnings = blender.export()
    return scene.objects[0].materials[0], warnings


@pytest.mark.parametrize("roughness", [1, 0.5, 0.25, 0.04])
def test_glossy_roughness_becomes_the_exponent(roughness):
    """Half of the light is in the same cone as GGX's; what is reflected depends on the angle."""
    material, warnings = _exported(blender.new_material("M", "ShaderNodeBsdfAnisotropic", Color=(0.9, 0.5, 0.1, 1), Roughness=roughness))
    assert warnings == ()
    (lobe,) = material.lobes
    assert type(lobe) is Gloss
    assert is_texture(lobe.reflectance)
    a2 = roughness**4
    assert lobe.exponent == pytest.approx(np.log(2) / np.log((1 + 3 * a2) / (1 + a2)) - 1, rel=1e-3, abs=1e-6)


@pytest.mark.parametrize("roughness", [0.02, 0])
def test_what_is_sharper_than_the_sharpest_lobe_is_a_mirror(roughness):
    material, warnings = _exported(blender.new_material("M", "ShaderNodeBsdfAnisotropic", Color=(0.9, 0.5, 0.1, 1), Roughness=roughness))
    assert warnings == ()
    (lobe,) = material.lobes
    assert type(lobe) is Mirror
    assert lobe.reflectance == pytest.approx((0.9, 0.5, 0.1))


def test_rough_glass_reflects_and_refracts():
    material, warnings = _exported(blender.new_material("Pane", "ShaderNodeBsdfGlass", Roughness=0.3))
    assert warnings == ()
    assert [type(lobe) for lobe in material.lobes] == [Gloss, RoughRefraction]


def test_rough_refraction_only_refracts():
    material, warnings = _exported(blender.new_material("Pane", "ShaderNodeBsdfRefraction", Color=(0.5, 0.6, 0.7, 1), Roughness=0.3))
    assert warnings == ()
    (lobe,) = material.lobes
    assert type(lobe) is RoughRefraction
    assert lobe.transmittance == pytest.approx((0.5, 0.6, 0.7))


@pytest.mark.skipif(not hasattr(bpy.types, "ShaderNodeBsdfMetallic"), reason="since Blender 4.3")
def test_metal_has_the_colour_of_its_base_and_that_of_its_edge():
    values = {"Base_Color": (0.5, 0.6, 0.7, 1), "Edge_Tint": (0.25, 0.5, 1, 1), "Roughness": 0.5}
    material, _ = _exported(blender.new_material("Brass", "ShaderNodeBsdfMetallic", **values))
    (lobe,) = material.lobes
    assert type(lobe.reflectance) is GgxAlbedo
    assert lobe.reflectance.f0 == pytest.approx((0.5, 0.6, 0.7))
    assert lobe.reflectance.tint == pytest.approx((0.25, 0.5, 1))


def test_holdout_is_black_and_held_out():
    exported, warnings = _exported(blender.new_material("Hole", "ShaderNodeHoldout"))
    assert (exported.lobes, exported.holdout, warnings) == ((), (1.0, 1.0, 1.0), ())


@pytest.mark.parametrize("kind", ["MICROFIBER", "ASHIKHMIN"])
def test_sheen_is_a_diffuse_rim_of_its_roughness_and_says_so(kind):
    velvet = blender.new_material("Velvet", "ShaderNodeBsdfSheen", Color=(1, 0.5, 0, 1), Roughness=0.3)
    velvet.node_tree.nodes["Sheen BSDF"].distribution = kind
    material, (warning,) = _exported(velvet)
    assert "rim" in warning
    assert "material 'Velvet'" in warning
    (lobe,) = material.lobes
    probes = Probes()
    albedo = probes.value(SheenAlbedo(0.3, kind.lower()))
    assert probes.value(lobe.reflectance) == pytest.approx(np.outer((1, 0.5, 0), albedo), abs=1e-6)


def test_sheen_of_principled_has_its_roughness():
    values = {"Sheen_Weight": 1, "Sheen_Roughness": 0.25, "Base_Color": (0, 0, 0, 1), "Specular_IOR_Level": 0}
    material, _ = _exported(blender.new_material("Velvet", "ShaderNodeBsdfPrincipled", **values))
    probes = Probes()
    albedo = probes.value(SheenAlbedo(0.25))
    assert np.abs(probes.value(material.lobes[0].reflectance) - albedo).max() <= 1e-6


@pytest.mark.skipif(not hasattr(bpy.types, "ShaderNodeBsdfMetallic"), reason="since Blender 4.3")
def test_metal_by_extinction_has_the_complex_index():
    copper = blender.new_material("Copper", "ShaderNodeBsdfMetallic", Roughness=0.5, IOR=(0.2, 0.92, 1.1), Extinction=(3.9, 2.4, 2.1))
    copper.node_tree.nodes["Metallic BSDF"].fresnel_type = "PHYSICAL_CONDUCTOR"
    material, warnings = _exported(copper)
    assert warnings == ()
    albedo = material.lobes[0].reflectance
    assert albedo.kind == "conductor"
    assert albedo.ior == pytest.approx((0.2, 0.92, 1.1))
    assert albedo.extinction == pytest.approx((3.9, 2.4, 2.1))


AGAIN = (0.0, 0.0, 0.0) if bpy.app.version < (4, 3) else (0.8, 0.4, 0.2)
"""Rough diffuse surfaces of Blender 4.2 reflect but once."""


def test_a_rough_diffuse_surface_is_oren_nayar():
    material, warnings = _exported(blender.new_material("Clay", "ShaderNodeBsdfDiffuse", Color=(0.8, 0.4, 0.2, 1), Roughness=0.7))
    assert warnings == ()
    (lobe,) = material.lobes
    assert type(lobe) is OrenNayar
    assert lobe.roughness == pytest.approx(0.7)
    assert lobe.reflectance == pytest.approx((0.8, 0.4, 0.2))
    assert lobe.again == pytest.approx(AGAIN)


def test_half_of_a_rough_diffuse_surface_reflects_again_as_the_whole_does():
    clay = blender.new_material("Clay", "ShaderNodeBsdfDiffuse", Color=(0.8, 0.4, 0.2, 1), Roughness=0.7)
    tree = clay.node_tree
    mix = blender.add_node(tree, "ShaderNodeMixShader", Fac=0.5)
    tree.links.new(tree.nodes["Diffuse BSDF"].outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], tree.nodes["Material Output"].inputs["Surface"])
    (lobe,) = _exported(clay)[0].lobes
    assert lobe.reflectance == pytest.approx((0.4, 0.2, 0.1))
    assert lobe.again == pytest.approx(AGAIN)


def test_roughness_of_diffuse_may_be_a_texture():
    clay = blender.new_material("Clay", "ShaderNodeBsdfDiffuse")
    tree = clay.node_tree
    tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], tree.nodes["Diffuse BSDF"].inputs["Roughness"])
    material, warnings = _exported(clay)
    assert warnings == ()
    assert is_texture(material.lobes[0].roughness)


@pytest.mark.skipif(bpy.app.version < (4, 5), reason="Blender 4.2 has no Diffuse Roughness")
def test_roughness_of_the_base_of_principled_is_that_of_oren_nayar():
    node = {"Base_Color": (0.8, 0.4, 0.2, 1), "Specular_IOR_Level": 0, "Diffuse_Roughness": 0.4}
    exported, warnings = _exported(blender.new_material("Clay", "ShaderNodeBsdfPrincipled", **node))
    assert warnings == ()
    (lobe,) = exported.lobes
    assert type(lobe) is OrenNayar
    assert lobe.roughness == pytest.approx(0.4)
    assert lobe.reflectance == pytest.approx((0.8, 0.4, 0.2))
    assert lobe.again == pytest.approx((0.8, 0.4, 0.2))


def even_light(roughness):
    """Whether a ball of clear glass with an index of 1.2 and of 2 in turn looks as bright as a white world; detects 3 %."""
    octants = CheckerTexture((1.2,) * 3, (2.0,) * 3, Coordinates(source="object"))
    white = (1.0, 1.0, 1.0)
    lobes = inside.with_one_index(principled.boundary(white, white, roughness, octants))
    ball = h.thing(h.icosphere(3), h.Material(name="glass", lobes=lobes))
    camera = OrthographicCamera(world_from_camera=h.affine(translation=(0, 0, 5)), window=(-0.7, 0.7, -0.7, 0.7))
    image = h.pixels(h.scene([ball], camera=camera, world=1.0), h.settings(width=16, height=16, samples=32, max_depth=200))[1]
    return h.mean_is(image, 1.0, floor=2e-3)


@pytest.mark.parametrize("roughness", [0.0, 0.25])
def test_glass_whose_index_varies_keeps_its_light(roughness):
    """Light comes in where the index is high and leaves where it is low, and the other way round."""
    assert even_light(roughness)


@pytest.mark.parametrize("roughness", [0.0, 0.25])
def test_even_light_catches_radiance_that_is_scaled_by_the_index_of_the_place(roughness, monkeypatch):
    monkeypatch.setattr(inside, "_etendue", lambda ior, inside: 1.0)
    assert not even_light(roughness)


@pytest.mark.parametrize("roughness", [0.0, 0.3])
def test_a_mix_of_two_kinds_of_glass_keeps_its_light(roughness):
    """Light that enters by one index leaves by the other as often; a tenth was won."""
    lobes = closure.mix(0.5, closure.glass((1.0,) * 3, 1.2, roughness), closure.glass((1.0,) * 3, 2.0, roughness)).lobes
    camera = OrthographicCamera(world_from_camera=h.affine(translation=(0, 0, 5)), window=(-0.7, 0.7, -0.7, 0.7))

    def is_even(lobes):
        ball = h.thing(h.icosphere(3), h.Material(name="glass", lobes=lobes))
        image = h.pixels(h.scene([ball], camera=camera, world=1.0), h.settings(width=16, height=16, samples=32, max_depth=200))[1]
        return h.mean_is(image, 1.0, floor=2e-3)

    assert is_even(inside.with_one_index(lobes))
    assert not is_even(lobes)
