"""Every instance arrives once, in its place, with its own materials; what cannot be rendered is named."""

import math

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender


def _names(scene):
    return sorted(o.name for o in scene.objects)


@pytest.mark.parametrize("kind", ["FONT", "CURVE", "META", "SURFACE"])
def test_text_curves_and_metaballs_come_once_as_meshes(kind):
    if kind == "FONT":
        ob = blender.link("Text", bpy.data.curves.new("Text", "FONT"))
        ob.data.body = "I"
    elif kind == "CURVE":
        ob = blender.link("Curve", bpy.data.curves.new("Curve", "CURVE"))
        spline = ob.data.splines.new("POLY")
        spline.points.add(2)
        for point, co in zip(spline.points, [(0, 0, 0, 1), (1, 0, 0, 1), (0, 1, 0, 1)], strict=True):
            point.co = co
        spline.use_cyclic_u = True
        ob.data.dimensions, ob.data.fill_mode = "2D", "BOTH"
    elif kind == "META":
        ob = blender.link("Meta", bpy.data.metaballs.new("Meta"))
        ob.data.elements.new().radius = 1
    else:
        bpy.ops.surface.primitive_nurbs_surface_sphere_add()
        ob = bpy.context.object
    scene, warnings = blender.export()
    assert len(scene.objects) == 1
    assert scene.objects[0].mesh.triangles.shape[1] > 0
    assert warnings == ()


def test_collection_instances_are_placed_and_share_their_mesh():
    collection = bpy.data.collections.new("Hidden")
    blade = bpy.data.objects.new("Blade", blender.new_mesh("Blade", [(0, 0, 0), (1, 0, 0), (0, 1, 0)], [(0, 1, 2)]))
    collection.objects.link(blade)
    for i in range(3):
        empty = blender.link(f"Empty{i}", None, (10 * i, 0, 0))
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
    scene, _ = blender.export()
    assert _names(scene) == ["Blade"] * 3
    assert len({id(o.mesh) for o in scene.objects}) == 1
    assert sorted(o.world_from_object[0, 3] for o in scene.objects) == [0, 10, 20]


def _geometry_nodes_grid(instance, count):
    """A geometry node tree that puts `instance` on a count x count grid."""
    tree = bpy.data.node_groups.new("Scatter", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
    grid = tree.nodes.new("GeometryNodeMeshGrid")
    grid.inputs["Vertices X"].default_value = grid.inputs["Vertices Y"].default_value = count
    info = tree.nodes.new("GeometryNodeObjectInfo")
    info.inputs["Object"].default_value = instance
    info.inputs["As Instance"].default_value = True
    scatter = tree.nodes.new("GeometryNodeInstanceOnPoints")
    output = tree.nodes.new("NodeGroupOutput")
    tree.links.new(grid.outputs["Mesh"], scatter.inputs["Points"])
    tree.links.new(info.outputs["Geometry"], scatter.inputs["Instance"])
    tree.links.new(scatter.outputs["Instances"], output.inputs[0])
    return tree


def test_instances_from_geometry_nodes_share_one_mesh():
    seed = blender.add_tetrahedron("Seed")
    seed.hide_render = True
    host = blender.add_plane("Host")
    host.modifiers.new("Scatter", "NODES").node_group = _geometry_nodes_grid(seed, 7)
    scene, _ = blender.export()
    instances = [o for o in scene.objects if o.mesh.triangles.shape[1] == 4]
    assert len(instances) >= 49
    assert len({id(o.mesh) for o in instances}) == 1


def test_particles_place_their_object():
    seed = blender.add_tetrahedron("Seed", (100, 0, 0))
    emitter = blender.add_plane("Emitter")
    emitter.modifiers.new("Particles", "PARTICLE_SYSTEM")
    settings = emitter.particle_systems[0].settings
    settings.count, settings.frame_start, settings.frame_end, settings.lifetime = 5, 0, 0, 100
    settings.render_type, settings.instance_object = "OBJECT", seed
    emitter.show_instancer_for_render = False
    bpy.context.scene.frame_set(1)
    # What is shown in the viewport differs from the render, so ask for the render.
    from glanz.addon.capture import capture

    blender.add_camera()
    scene, _, _ = capture()
    seeds = [o for o in scene.objects if o.world_from_object[0, 3] < 50]
    assert len(seeds) == 5
    assert "Emitter" not in _names(scene)
    assert len({id(o.mesh) for o in scene.objects}) == 1


def test_object_linked_materials_win_over_the_meshs_own():
    ob = blender.add_plane("Own")
    ob.data.materials.append(bpy.data.materials.new("Of Mesh"))
    other = blender.add_plane("Other", mesh=ob.data)
    other.material_slots[0].link = "OBJECT"
    other.material_slots[0].material = bpy.data.materials.new("Of Object")
    assert blender.export_object("Own").materials[0].name == "Of Mesh"
    assert blender.export_object("Other").materials[0].name == "Of Object"
    assert blender.export_object("Own").mesh.name == blender.export_object("Other").mesh.name


def test_empty_slots_and_no_slots_wear_the_default():
    blender.add_plane("None")
    ob = blender.add_plane("Empty")
    ob.data.materials.append(None)
    assert blender.export_object("None").materials == blender.export_object("Empty").materials
    assert blender.export_object("None").materials[0].lobes


def test_negative_scales_and_parents_keep_their_place():
    parent = blender.link("Parent", None, (0, 0, 1))
    parent.rotation_euler.z = math.pi / 2
    ob = blender.add_tetrahedron()
    ob.parent, ob.scale = parent, (-2, 1, 1)
    bpy.context.view_layer.update()
    expected = [ob.matrix_world @ v.co for v in ob.data.vertices]
    np.testing.assert_allclose(blender.world_vertices(blender.export_object("Tetrahedron")), expected, atol=1e-6)


def test_hidden_objects_are_left_out():
    blender.add_tetrahedron("Shown")
    blender.add_tetrahedron("Hidden").hide_render = True
    blender.add_tetrahedron("Excluded")
    collection = bpy.data.collections.new("Off")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(bpy.data.objects["Excluded"])
    bpy.context.scene.collection.objects.unlink(bpy.data.objects["Excluded"])
    collection.hide_render = True
    blender.add_camera()
    from glanz.addon.capture import capture

    assert _names(capture()[0]) == ["Shown"]


@pytest.mark.parametrize("scale", [(0, 0, 0), (1, 0, 0)])
def test_objects_without_a_surface_are_named_and_left_out(scale):
    blender.add_tetrahedron().scale = scale
    scene, warnings = blender.export()
    assert scene.objects == ()
    assert warnings == ("the scale leaves no surface, so it is left out: object 'Tetrahedron'",)


def test_objects_squashed_flat_are_kept():
    blender.add_tetrahedron().scale = (1, 1, 0)
    scene, warnings = blender.export()
    assert len(scene.objects) == 1
    assert warnings == ()


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
def test_objects_nowhere_are_named_and_left_out(value):
    blender.add_tetrahedron("Good")
    blender.add_tetrahedron("Bad").location.x = value
    scene, warnings = blender.export()
    assert _names(scene) == ["Good"]
    assert warnings == ("the transform is not finite, so it is left out: object 'Bad'",)


def test_what_cannot_be_rendered_is_named():
    blender.link("Fur", bpy.data.hair_curves.new("Fur"))
    blender.link("Smoke", bpy.data.volumes.new("Smoke"))
    scene, warnings = blender.export()
    assert scene.objects == ()
    assert set(warnings) == {"hair curves are not rendered: object 'Fur'", "volumes are not rendered: object 'Smoke'"}


def test_an_object_that_is_only_a_volume_does_not_block_the_view():
    material = blender.new_material("Fog", "ShaderNodeVolumePrincipled")
    tree = material.node_tree
    tree.links.new(tree.links[0].from_socket, tree.get_output_node("CYCLES").inputs["Volume"])
    tree.links.remove(tree.links[0])
    assert [link.to_socket.identifier for link in tree.links] == ["Volume"]
    blender.add_tetrahedron("Domain").data.materials.append(material)
    scene, warnings = blender.export()
    assert scene.objects == ()
    assert warnings == ("volumes are not rendered: object 'Domain'",)


def test_ignored_flags_are_named():
    ob = blender.add_plane()
    ob.is_shadow_catcher = True
    assert blender.export()[1] == ("shadow catchers are rendered as ordinary objects: object 'Plane'",)
    ob.is_shadow_catcher = False
    setattr(*((ob, "shadow_terminator_shading_offset") if bpy.app.version >= (4, 5) else (ob.cycles, "shadow_terminator_offset")), 0.5)
    assert blender.export()[1] == ("the Shading Offset of its Shadow Terminator is ignored: object 'Plane'",)


def test_a_material_override_replaces_all_materials():
    ob = blender.add_plane()
    ob.data.materials.append(bpy.data.materials.new("Own"))
    bpy.context.view_layer.material_override = bpy.data.materials.new("Clay")
    assert [m.name for m in blender.export_object("Plane").materials] == ["Clay"]
