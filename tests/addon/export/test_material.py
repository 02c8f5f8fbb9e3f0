"""Materials become lobes: constants as they are, everything else named."""

import bpy
import pytest

from glanz.addon.export.principled import Layers
from glanz.engine import (
    BumpMap,
    Dielectric,
    Gloss,
    Lambert,
    LambertTransmission,
    Mirror,
    Transparent,
)
from glanz.tests.addon import blender
from glanz.tests.textured import extremes


def _exported(material):
    """(engine material, warnings)."""
    blender.add_plane().data.materials.append(material)
    scene, warnings = blender.export()
    return scene.objects[0].materials[0], warnings


def _tree(name="Mat"):
    """(material, tree, output socket) of an empty node tree with an output."""
    material = bpy.data.materials.new(name)
    tree = blender.new_nodes(material)
    return material, tree, tree.nodes.new("ShaderNodeOutputMaterial").inputs["Surface"]


def test_diffuse():
    material, warnings = _exported(blender.new_material("M", "ShaderNodeBsdfDiffuse", Color=(0.1, 0.2, 0.3, 1)))
    assert warnings == ()
    (lobe,) = material.lobes
    assert type(lobe) is Lambert
    assert lobe.reflectance == pytest.approx((0.1, 0.2, 0.3))


def test_glass_is_a_dielectric_that_tints_both_ways():
    material, warnings = _exported(blender.new_material("Pane", "ShaderNodeBsdfGlass", Color=(0.5, 0.6, 0.7, 1), IOR=1.33, Roughness=0))
    assert warnings == ()
    (lobe,) = material.lobes
    assert type(lobe) is Dielectric
    assert lobe.ior == pytest.approx(1.33)
    assert lobe.reflectance == lobe.transmittance == pytest.approx((0.5, 0.6, 0.7))


def test_translucent_lets_light_through():
    material, warnings = _exported(blender.new_material("Leaf", "ShaderNodeBsdfTranslucent", Color=(0.5, 0.6, 0.7, 1)))
    assert warnings == ()
    (lobe,) = material.lobes
    assert type(lobe) is LambertTransmission
    assert lobe.transmittance == pytest.approx((0.5, 0.6, 0.7))


def test_what_reflects_and_passes_more_than_arrives_is_darkened():
    """Both lobes alike."""
    material, tree, surface = _tree("Leaf")
    add = tree.nodes.new("ShaderNodeAddShader")
    for i, kind in enumerate(("ShaderNodeBsdfDiffuse", "ShaderNodeBsdfTranslucent")):
        tree.links.new(blender.add_node(tree, kind, Color=(0.8, 0.4, 0, 1)).outputs[0], add.inputs[i])
    tree.links.new(add.outputs[0], surface)
    exported, warnings = _exported(material)
    assert exported.lobes[0].reflectance == exported.lobes[1].transmittance == pytest.approx((0.5, 0.25, 0))
    assert warnings == ("the material reflects more than it receives, so it is darkened: material 'Leaf'",)


def test_principled_glass_is_tinted_by_the_root_of_its_colour():
    """Light that goes in and out again carries the base colour once, as in Blender."""
    values = {"Base_Color": (0.25, 0.64, 1, 1), "Transmission_Weight": 1, "Roughness": 0, "IOR": 1.4}
    material, warnings = _exported(blender.new_material("Bottle", "ShaderNodeBsdfPrincipled", **values))
    assert warnings == ()
    (lobe,) = material.lobes
    assert type(lobe) is Dielectric
    assert lobe.transmittance == pytest.approx((0.5, 0.8, 1))
    assert lobe.reflectance == pytest.approx((1, 1, 1))


def test_emission_is_colour_times_strength():
    material, _ = _exported(blender.new_material("M", "ShaderNodeEmission", Color=(1, 0.5, 0.25, 1), Strength=8))
    assert material.emission == pytest.approx((8, 4, 2))
    assert material.lobes == ()


def test_principled_has_both_lobes_and_emission():
    shine = {"Emission_Color": (1, 0, 0, 1), "Emission_Strength": 2}
    material, warnings = _exported(blender.new_material("M", "ShaderNodeBsdfPrincipled", Base_Color=(0.5, 0.5, 0.5, 1), **shine))
    assert warnings == ()
    assert {type(lobe) for lobe in material.lobes} == {Lambert, Gloss}
    assert material.emission == (2, 0, 0)


@pytest.mark.parametrize(
    ("identifier", "value", "word"),
    [
        ("Sheen_Weight", 0.5, "Sheen"),
        ("Subsurface_Weight", 0.5, "Subsurface"),
        ("Anisotropic", 0.5, "Anisotropy"),
    ],
)
def test_what_principled_cannot_do_is_named(identifier, value, word):
    material, warnings = _exported(blender.new_material("Thing", "ShaderNodeBsdfPrincipled", **{identifier: value}))
    assert len(warnings) == 1
    assert warnings[0].startswith(word)
    assert warnings[0].endswith("material 'Thing'")
    assert material.lobes


def test_mix_and_add_weigh_their_shaders():
    material, tree, surface = _tree()
    red = blender.add_node(tree, "ShaderNodeBsdfDiffuse", Color=(1, 0, 0, 1))
    shine = blender.add_node(tree, "ShaderNodeBsdfAnisotropic", Color=(1, 1, 1, 1), Roughness=0)
    glow = blender.add_node(tree, "ShaderNodeEmission", Strength=4)
    mix = blender.add_node(tree, "ShaderNodeMixShader", Fac=0.25)
    add = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(red.outputs[0], mix.inputs[1])
    tree.links.new(shine.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], add.inputs[0])
    tree.links.new(glow.outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], surface)
    exported, warnings = _exported(material)
    assert warnings == ()
    assert exported.lobes == (Lambert((0.75, 0.0, 0.0)), Mirror((0.25, 0.25, 0.25)))
    assert exported.emission == (4, 4, 4)


def test_shaders_that_reflect_too_much_are_darkened_and_named():
    material, tree, surface = _tree("Bright")
    add = tree.nodes.new("ShaderNodeAddShader")
    for i in (0, 1):
        tree.links.new(blender.add_node(tree, "ShaderNodeBsdfDiffuse", Color=(0.8, 0.4, 0, 1)).outputs[0], add.inputs[i])
    tree.links.new(add.outputs[0], surface)
    exported, warnings = _exported(material)
    (lobe,) = exported.lobes
    assert lobe.reflectance == pytest.approx((1, 0.5, 0))
    assert "material 'Bright'" in warnings[0]


def test_transparent_alone_lets_its_colour_pass():
    exported, warnings = _exported(blender.new_material("Filter", "ShaderNodeBsdfTransparent", Color=(0.75, 0.5, 0.25, 1)))
    assert exported.lobes == (Transparent((0.75, 0.5, 0.25)),)
    assert warnings == ()


@pytest.mark.parametrize(
    ("factor", "lobes"),
    [
        (0, (Transparent((1.0, 0.5, 0.0)),)),
        (0.25, (Transparent((0.75, 0.375, 0.0)), Lambert((0.0, 0.25, 0.0)))),
        (1, (Lambert((0.0, 1.0, 0.0)),)),
    ],
)
def test_transparent_in_a_mix_has_its_share(factor, lobes):
    material, tree, surface = _tree("Leaf")
    mix = blender.add_node(tree, "ShaderNodeMixShader", Fac=factor)
    tree.links.new(blender.add_node(tree, "ShaderNodeBsdfTransparent", Color=(1, 0.5, 0, 1)).outputs[0], mix.inputs[1])
    tree.links.new(blender.add_node(tree, "ShaderNodeBsdfDiffuse", Color=(0, 1, 0, 1)).outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], surface)
    exported, warnings = _exported(material)
    assert exported.lobes == lobes
    assert warnings == ()


def test_transparent_added_to_glow_lets_everything_pass():
    material, tree, surface = _tree("Flame")
    add = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(blender.add_node(tree, "ShaderNodeBsdfTransparent", Color=(1, 1, 1, 1)).outputs[0], add.inputs[0])
    tree.links.new(blender.add_node(tree, "ShaderNodeEmission", Strength=3).outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], surface)
    exported, warnings = _exported(material)
    assert exported.lobes == (Transparent(),)
    assert exported.emission == (3, 3, 3)
    assert warnings == ()


def test_transparent_added_to_white_is_darkened_and_named():
    """Together they would send on twice what arrives."""
    material, tree, surface = _tree("Ghost")
    add = tree.nodes.new("ShaderNodeAddShader")
    for i, kind in enumerate(("Transparent", "Diffuse")):
        tree.links.new(blender.add_node(tree, f"ShaderNodeBsdf{kind}", Color=(1, 1, 1, 1)).outputs[0], add.inputs[i])
    tree.links.new(add.outputs[0], surface)
    exported, warnings = _exported(material)
    assert exported.lobes == (Transparent((0.5,) * 3), Lambert((0.5,) * 3))
    assert "material 'Ghost'" in warnings[0]


@pytest.mark.parametrize("alpha", [0, 0.25, 1])
def test_alpha_of_principled_scales_all_and_lets_the_rest_pass(alpha):
    """What glows, too, as in Cycles."""
    values = {"Base_Color": (0.8, 0.4, 0.2, 1), "Emission_Strength": 4, "Emission_Color": (1, 1, 1, 1), "Transmission_Weight": 0.5}
    material, warnings = _exported(blender.new_material("M", "ShaderNodeBsdfPrincipled", Roughness=0, Alpha=alpha, **values))
    assert warnings == ()
    found = {type(lobe): lobe for lobe in material.lobes}
    clear = found.pop(Transparent, Transparent.black())
    assert clear == Transparent((1 - alpha,) * 3)
    solid, _ = Layers(base=(0.8, 0.4, 0.2), roughness=0.0, transmission=0.5).lobes()
    assert set(found) == ({type(lobe) for lobe in solid} if alpha else set())
    if alpha:
        assert found[Dielectric].reflectance == pytest.approx((0.5 * alpha,) * 3)
    assert material.emission == pytest.approx((4 * alpha,) * 3)


def test_shadows_that_should_not_be_transparent_are_named():
    if not hasattr(bpy.types.Material, "use_transparent_shadow"):
        return
    material = blender.new_material("Blind", "ShaderNodeBsdfTransparent")
    material.use_transparent_shadow = False
    (warning,) = _exported(material)[1]
    assert "Transparent Shadows is off" in warning
    assert "material 'Blind'" in warning


@pytest.mark.parametrize(
    ("kind", "label"),
    [
        ("BsdfToon", "Toon BSDF"),
        ("BsdfHair", "Hair BSDF"),
        ("BsdfHairPrincipled", "Principled Hair BSDF"),
        ("BsdfRayPortal", "Ray Portal BSDF"),
        ("SubsurfaceScattering", "Subsurface Scattering"),
    ],
)
def test_unknown_shaders_are_diffuse_in_their_colour_and_named(kind, label):
    exported, warnings = _exported(blender.new_material("Shirt", f"ShaderNode{kind}", Color=(0.5, 0.6, 0.7, 1)))
    assert exported.lobes[0].reflectance == pytest.approx((0.5, 0.6, 0.7))
    assert warnings == (f"{label} is not supported and is rendered as Diffuse of its colour: node '{label}' of material 'Shirt'",)


def test_textures_that_are_not_read_are_named_and_the_sockets_own_value_is_used():
    material = blender.new_material("Wood", "ShaderNodeBsdfDiffuse", Color=(0.1, 0.2, 0.3, 1))
    tree = material.node_tree
    diffuse = next(node for node in tree.nodes if node.type == "BSDF_DIFFUSE")
    tree.links.new(tree.nodes.new("ShaderNodeShaderToRGB").outputs["Color"], diffuse.inputs["Color"])
    exported, warnings = _exported(material)
    assert exported.lobes[0].reflectance == pytest.approx((0.1, 0.2, 0.3))
    assert len(warnings) == 1
    assert "Shader to RGB" in warnings[0]
    assert "material 'Wood'" in warnings[0]


def test_constants_come_through_reroutes_value_nodes_and_muted_nodes():
    material, tree, surface = _tree()
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    tree.links.new(diffuse.outputs[0], surface)
    rgb = tree.nodes.new("ShaderNodeRGB")
    rgb.outputs[0].default_value = (0.2, 0.4, 0.6, 1)
    muted = tree.nodes.new("ShaderNodeGamma")
    muted.mute = True
    reroute = tree.nodes.new("NodeReroute")
    tree.links.new(rgb.outputs[0], muted.inputs["Color"])
    tree.links.new(muted.outputs[0], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], diffuse.inputs["Color"])
    exported, warnings = _exported(material)
    assert exported.lobes[0].reflectance == pytest.approx((0.2, 0.4, 0.6))
    assert warnings == ()


def _group(name):
    """A node group: a diffuse shader whose colour is the group's input."""
    group = bpy.data.node_groups.new(name, "ShaderNodeTree")
    group.interface.new_socket("Paint", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketShader")
    diffuse = group.nodes.new("ShaderNodeBsdfDiffuse")
    group.links.new(group.nodes.new("NodeGroupInput").outputs[0], diffuse.inputs["Color"])
    group.links.new(diffuse.outputs[0], group.nodes.new("NodeGroupOutput").inputs[0])
    return group


def test_node_groups_take_the_values_of_each_use():
    material, tree, surface = _tree()
    group = _group("Paint")
    mix = blender.add_node(tree, "ShaderNodeMixShader", Fac=0.5)
    for i, colour in ((1, (1, 0, 0, 1)), (2, (0, 0, 1, 1))):
        node = tree.nodes.new("ShaderNodeGroup")
        node.node_tree = group
        node.inputs[0].default_value = colour
        tree.links.new(node.outputs[0], mix.inputs[i])
    tree.links.new(mix.outputs[0], surface)
    exported, warnings = _exported(material)
    assert exported.lobes == (Lambert((0.5, 0.0, 0.5)),)
    assert warnings == ()


def test_a_group_may_follow_itself():
    group = bpy.data.node_groups.new("Pass", "ShaderNodeTree")
    group.interface.new_socket("In", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Out", in_out="OUTPUT", socket_type="NodeSocketColor")
    group.links.new(group.nodes.new("NodeGroupInput").outputs[0], group.nodes.new("NodeGroupOutput").inputs[0])
    material, tree, surface = _tree()
    diffuse = tree.nodes.new("ShaderNodeBsdfDiffuse")
    first, second = tree.nodes.new("ShaderNodeGroup"), tree.nodes.new("ShaderNodeGroup")
    first.node_tree = second.node_tree = group
    first.inputs[0].default_value = (0.2, 0.4, 0.6, 1)
    tree.links.new(first.outputs[0], second.inputs[0])
    tree.links.new(second.outputs[0], diffuse.inputs["Color"])
    tree.links.new(diffuse.outputs[0], surface)
    exported, warnings = _exported(material)
    assert exported.lobes[0].reflectance == pytest.approx((0.2, 0.4, 0.6))
    assert warnings == ()


def test_nodes_in_a_circle_are_an_answer_not_a_hang():
    material, tree, surface = _tree("Circle")
    a, b = tree.nodes.new("NodeReroute"), tree.nodes.new("NodeReroute")
    tree.links.new(a.outputs[0], b.inputs[0])
    tree.links.new(b.outputs[0], a.inputs[0])
    tree.links.new(b.outputs[0], surface)
    exported, _ = _exported(material)
    assert exported.lobes == ()


def test_shaders_in_a_circle_are_an_answer_not_a_hang():
    material, tree, surface = _tree("Circle")
    a, b = tree.nodes.new("ShaderNodeAddShader"), tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(a.outputs[0], b.inputs[0])
    tree.links.new(b.outputs[0], a.inputs[0])
    tree.links.new(b.outputs[0], surface)
    exported, warnings = _exported(material)
    assert exported.lobes == ()
    assert "material 'Circle'" in "".join(warnings)


def test_names_of_nodes_do_not_matter():
    material = blender.new_material("M", "ShaderNodeBsdfDiffuse", Color=(0.1, 0.2, 0.3, 1))
    for i, node in enumerate(material.node_tree.nodes):
        node.name = node.label = f"Knoten {i}"
    assert _exported(material)[0].lobes[0].reflectance == pytest.approx((0.1, 0.2, 0.3))


def test_the_active_output_counts():
    material = blender.new_material("M", "ShaderNodeBsdfDiffuse", Color=(0.1, 0.1, 0.1, 1))
    tree = material.node_tree
    other = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(blender.add_node(tree, "ShaderNodeEmission", Strength=1).outputs[0], other.inputs["Surface"])
    other.is_active_output = True
    assert _exported(material)[0].emission == (1, 1, 1)


@pytest.mark.skipif(bpy.app.version >= (5, 0), reason="from Blender 5.0 on every material has nodes")
def test_without_nodes_the_viewport_colour_is_diffuse():
    material = bpy.data.materials.new("Plain")
    material.diffuse_color = (0.1, 0.2, 0.3, 1)
    assert _exported(material)[0].lobes[0].reflectance == pytest.approx((0.1, 0.2, 0.3))


def test_nothing_linked_is_black():
    material, _, _ = _tree()
    assert _exported(material)[0].lobes == ()


def test_impossible_strengths_are_cut_off_and_named():
    exported, warnings = _exported(blender.new_material("Hole", "ShaderNodeEmission", Color=(1, 1, 1, 1), Strength=-2))
    assert exported.emission == (0, 0, 0)
    assert "material 'Hole'" in warnings[0]


def test_displacement_is_a_bump_and_named():
    material = blender.new_material("Rough", "ShaderNodeBsdfDiffuse")
    tree = material.node_tree
    output = tree.get_output_node("CYCLES")
    node = blender.add_node(tree, "ShaderNodeDisplacement", Scale=0.5, Midlevel=0.25)
    tree.links.new(tree.nodes.new("ShaderNodeTexChecker").outputs["Fac"], node.inputs["Height"])
    tree.links.new(node.outputs[0], output.inputs["Displacement"])
    exported, warnings = _exported(material)
    assert any("displacement is rendered as bump" in line and "material 'Rough'" in line for line in warnings)
    (relief,) = exported.relief
    assert type(relief) is BumpMap
    assert relief.distance == 1.0
    low, high = extremes(relief.texture)
    assert (low[0], high[0]) == pytest.approx((0.5 * (0 - 0.25), 0.5 * (1 - 0.25)))
