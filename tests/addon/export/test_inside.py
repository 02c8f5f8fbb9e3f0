"""What is inside of materials: volumes that absorb, and Glanz's own settings."""

import bpy
import pytest

from glanz.engine import Medium, Transparent
from glanz.tests.addon import blender


def glass(volume=None, **inputs):
    """(material, tree) of smooth glass with a volume node of this type behind it."""
    material = blender.new_material("Wine", "ShaderNodeBsdfGlass", IOR=1.4, Roughness=0)
    tree = material.node_tree
    if volume:
        node = blender.add_node(tree, volume, **inputs)
        tree.links.new(node.outputs[0], tree.get_output_node("CYCLES").inputs["Volume"])
    return material, tree


def exported(material):
    """(engine material, warnings)."""
    blender.add_plane().data.materials.append(material)
    scene, warnings = blender.export()
    return scene.objects[0].materials[0], warnings


def test_a_volume_absorbs_what_its_colour_lacks():
    material, warnings = exported(glass("ShaderNodeVolumeAbsorption", Color=(0.9, 0.5, 0.25, 1), Density=2.0)[0])
    assert warnings == ()
    assert material.medium.absorption == pytest.approx((0.2, 1.0, 1.5))
    assert material.medium.priority == 0


def test_volumes_can_be_added_and_mixed():
    material, tree = glass()
    first, second = (
        blender.add_node(tree, "ShaderNodeVolumeAbsorption", Color=(*colour, 1), Density=1.0) for colour in ((1, 0, 1), (1, 1, 0))
    )
    add, mix = tree.nodes.new("ShaderNodeAddShader"), blender.add_node(tree, "ShaderNodeMixShader", Fac=0.25)
    for i, node in enumerate((first, second)):
        tree.links.new(node.outputs[0], add.inputs[i])
        tree.links.new((add if i else first).outputs[0], mix.inputs[1 + i])
    tree.links.new(mix.outputs[0], tree.get_output_node("CYCLES").inputs["Volume"])
    assert exported(material)[0].medium.absorption == pytest.approx((0, 1, 0.25))


@pytest.mark.parametrize("label", ["Principled Volume", "Volume Scatter"])
def test_other_volumes_are_left_out_and_named(label):
    material, warnings = exported(glass("ShaderNode" + "".join(sorted(label.split(), reverse=True)))[0])
    assert material.medium is None
    assert warnings == (f"the volume is left out: {label} is not supported: node '{label}' of material 'Wine'",)


@pytest.mark.parametrize(("values", "expected"), [({"Density": -1.0}, None), ({"Color": (2, 1, 0, 1), "Density": 3.0}, (0, 0, 3))])
def test_a_volume_that_would_add_light_is_cut_off(values, expected):
    node = {"Color": (0, 0, 0, 1)} | values
    material, warnings = exported(glass("ShaderNodeVolumeAbsorption", **node)[0])
    assert (material.medium and material.medium.absorption) == expected
    assert "cut off: material 'Wine'" in warnings[0]


def test_a_volume_without_a_surface_has_a_boundary_that_is_not_seen():
    material, tree = glass("ShaderNodeVolumeAbsorption", Color=(1, 0, 0.5, 1), Density=2.0)
    output = tree.get_output_node("CYCLES")
    tree.links.remove(output.inputs["Surface"].links[0])
    found, warnings = exported(material)
    assert warnings == ()
    assert found.lobes == (Transparent((1.0, 1.0, 1.0)),)
    assert found.medium.absorption == pytest.approx((0, 2, 1))


def test_a_priority_alone_is_no_volume():
    material, tree = glass()
    tree.links.remove(tree.links[0])
    material.glanz.priority = 3
    assert exported(material)[0].lobes == ()


def test_priority_and_dispersion_are_glanzs_own():
    for name, values in (("Plain", {}), ("Strong", {"priority": -3}), ("Flint", {"abbe": 30}), ("Beyond", {"abbe": 0.5})):
        material, _ = glass()
        for key, value in values.items():
            setattr(material.glanz, key, value)
        blender.add_plane(name).data.materials.append(material)
    dull = blender.new_material("Dull", "ShaderNodeBsdfDiffuse")
    dull.glanz.abbe = 30
    blender.add_plane("Dull").data.materials.append(dull)
    scene, warnings = blender.export()
    found = {o.name: o.materials[0] for o in scene.objects}
    assert warnings == ()
    assert {name for name, material in found.items() if material.medium} == {"Strong"}
    assert found["Strong"].medium == Medium(priority=-3)
    assert [found[name].lobes[0].abbe for name in ("Plain", "Strong", "Flint", "Beyond")] == [float("inf"), float("inf"), 30, 1]


def test_glass_that_absorbs_renders_darker_from_blender(tmp_path):
    """F12: a thick pane of clear index before a bright world, exp(-2) of it left."""
    pane = blender.new_material("Pane", "ShaderNodeBsdfGlass", IOR=1.0001, Roughness=0)
    node = blender.add_node(pane.node_tree, "ShaderNodeVolumeAbsorption", Color=(0, 0.5, 1, 1), Density=1.0)
    pane.node_tree.links.new(node.outputs[0], pane.node_tree.get_output_node("CYCLES").inputs["Volume"])
    bpy.ops.mesh.primitive_cube_add(size=2)
    bpy.context.object.data.materials.append(pane)
    blender.set_world((1, 1, 1))
    blender.add_camera(location=(0, 0, 9), width=8, height=8, lens=900)
    bpy.context.scene.render.engine = "GLANZ"
    bpy.context.scene.glanz.max_depth = 8
    bpy.context.scene.glanz.samples = 64
    (combined,) = (v for k, v in blender.read_exr(blender.render(tmp_path / "a.exr")).items() if k.endswith("Combined"))
    assert combined[..., :3].mean(axis=(0, 1)) == pytest.approx((0.1353, 0.3679, 1), rel=0.08)
