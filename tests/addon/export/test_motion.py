"""What moves in Blender while the shutter is open has the same keys in the engine; what does not stands still."""

import bpy
import numpy as np
import pytest

from glanz.addon import capture, checks
from glanz.addon.export.mesh import export_mesh, triangle_corners
from glanz.addon.export.motion import _Shapes
from glanz.engine import MemoryShortage, SceneError, memory
from glanz.tests.addon import blender


def open_shutter(shutter=1.0, position="CENTER", frame=10):
    """A scene at `frame`, with motion blur, and a camera."""
    blender.add_camera()
    scene = bpy.context.scene
    scene.frame_set(frame)
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter = shutter
    owner = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
    owner.motion_blur_position = position


def animate(owner, path, keys, index=-1):
    """Straight lines between `keys` {frame: value}."""
    for frame, value in keys.items():
        if index < 0:
            setattr(owner, path, value)
        else:
            getattr(owner, path)[index] = value
        owner.keyframe_insert(path, index=index, frame=frame)
    action = owner.id_data.animation_data.action
    curves = action.fcurves if hasattr(action, "fcurves") else action.layers[0].strips[0].channelbags[0].fcurves
    for curve in curves:
        for key in curve.keyframe_points:
            key.interpolation = "LINEAR"


def slide(ob, speed=2.0):
    """Let an object move along x, `speed` a frame, so that x is that of the frame."""
    animate(ob, "location", {0: 0.0, 100: 100 * speed}, index=0)
    return ob


def moved(name="Plane"):
    """(the engine's object called `name`, warnings) of what the command line would render."""
    scene, _, warnings = capture.capture()
    (o,) = (o for o in scene.objects if o.name == name)
    return o, warnings


@pytest.mark.parametrize(("position", "places"), [("START", (20, 20.5, 21)), ("CENTER", (19.5, 20, 20.5)), ("END", (19, 19.5, 20))])
def test_the_shutter_is_open_when_blender_says(position, places):
    """Half a frame of an object at 2 m per frame, at frame 10; the rest of the scene is that of the middle."""
    open_shutter(0.5, position)
    slide(blender.add_plane())
    o, warnings = moved()
    np.testing.assert_allclose(o.motion[:, 0, 3], places, atol=1e-5)
    np.testing.assert_allclose(o.world_from_object[0, 3], places[1], atol=1e-5)
    assert warnings == ()
    assert bpy.context.scene.frame_current == 10
    assert bpy.context.scene.frame_subframe == 0


def test_frames_may_have_fractions_and_be_negative():
    open_shutter(1.0, "CENTER")
    slide(blender.add_plane())
    bpy.context.scene.frame_set(0, subframe=0.25)
    np.testing.assert_allclose(moved()[0].motion[:, 0, 3], (0, 0.5, 1.5), atol=1e-5)
    assert bpy.context.scene.frame_subframe == 0.25


@pytest.mark.parametrize("shutter", [1e30, 3e6])
def test_frames_that_blender_does_not_have_are_refused(shutter):
    open_shutter(shutter)
    slide(blender.add_plane())
    with pytest.raises(SceneError, match="allowed: -1048574 to 1048574; look at the frame and the shutter"):
        capture.capture()


def test_motion_blur_that_is_off_moves_nothing():
    open_shutter()
    slide(blender.add_plane())
    bpy.context.scene.render.use_motion_blur = False
    assert moved()[0].is_still


def test_what_stands_still_is_still():
    open_shutter()
    slide(blender.add_plane("Moving"))
    blender.add_plane()
    assert moved()[0].is_still
    scene, _, _ = capture.capture()
    assert not len(scene.camera.motion)


def test_objects_have_the_keys_that_they_ask_for():
    """2^n + 1, as in Cycles; none where motion blur is switched off."""
    open_shutter()
    for steps in (1, 2, 3):
        slide(blender.add_plane(f"{steps}")).cycles.motion_steps = steps
    slide(blender.add_plane("off")).cycles.use_motion_blur = False
    for steps in (1, 2, 3):
        motion = moved(f"{steps}")[0].motion
        np.testing.assert_allclose(motion[:, 0, 3], np.linspace(19, 21, 2**steps + 1), atol=1e-5)
    assert moved("off")[0].is_still


def test_children_and_instances_move_with_what_carries_them():
    open_shutter()
    parent = slide(blender.link("Parent", None))
    blender.add_plane("Child").parent = parent
    collection = bpy.data.collections.new("Flock")
    bird = blender.add_plane("Bird")
    bpy.context.scene.collection.objects.unlink(bird)
    collection.objects.link(bird)
    carrier = slide(blender.link("Carrier", None), 3.0)
    carrier.instance_type, carrier.instance_collection = "COLLECTION", collection
    for name, places in (("Child", (19, 20, 21)), ("Bird", (28.5, 30, 31.5))):
        np.testing.assert_allclose(moved(name)[0].motion[:, 0, 3], places, atol=1e-5)


def shape_key(ob, keys):
    """A shape key that lifts the mesh by 1, with the values `keys` {frame: value}."""
    ob.shape_key_add(name="Basis")
    lifted = ob.shape_key_add(name="Lifted")
    for point in lifted.data:
        point.co.z += 1
    animate(lifted, "value", keys)


def test_a_mesh_that_deforms_has_its_shapes_and_its_normals():
    open_shutter()
    ob = blender.add_tetrahedron("Plane")
    for polygon in ob.data.polygons:
        polygon.use_smooth = True
    shape_key(ob, {9: 0.0, 11: 1.0})
    o, warnings = moved()
    assert warnings == ()
    assert o.mesh.shapes.shape == (3, 3, 4)
    np.testing.assert_allclose(o.mesh.shapes[:, 2] - o.mesh.shapes[0, 2], [[z] * 4 for z in (0, 0.25, 0.5)], atol=1e-5)
    assert o.mesh.shape_normals.shape == (3, *o.mesh.normals.shape)
    assert not o.moves


@pytest.mark.parametrize("middle", [False, True])
@pytest.mark.parametrize("ends", [False, True])
def test_edges_that_are_sharp_for_a_while_split_normals_for_as_long(middle, ends):
    ob = blender.add_tetrahedron()
    ob.data.shade_smooth()
    corner_normals = []
    for number, is_sharp in ((1, middle), (0, ends), (2, ends)):
        ob.data.vertices[3].co.z = 1 + 0.1 * number
        ob.data.edges[0].use_edge_sharp = is_sharp
        ob.data.update()
        if number == 1:
            shapes = _Shapes(export_mesh(ob.data, "Plane"), ob.data, 3)
        else:
            shapes.look(number, ob.data)
        loops = triangle_corners(ob.data)
        corner_normals.insert(number, [tuple(ob.data.corner_normals[i].vector) for i in loops.ravel()])
    mesh = shapes.changed(3, lambda keys, count: np.stack(keys))
    of_corners = mesh.shape_normals[:, :, mesh.normal_indices.ravel()].transpose(0, 2, 1)
    np.testing.assert_array_equal(of_corners, np.array(corner_normals, np.float32))


def test_deformation_can_be_switched_off():
    open_shutter()
    ob = blender.add_plane()
    shape_key(ob, {9: 0.0, 11: 1.0})
    ob.cycles.use_deform_motion = False
    assert moved()[0].is_still


def test_shapes_that_would_not_fit_into_memory_are_refused_by_mesh(monkeypatch):
    """Three of four vertices, twice."""
    open_shutter()
    ob = blender.add_plane()
    shape_key(ob, {9: 0.0, 11: 1.0})
    needed = 2 * 3 * 4 * 12
    monkeypatch.setattr(memory, "free", lambda: (needed - 1) / memory.SHARE)
    with pytest.raises(MemoryShortage, match=r"the 3 shapes of mesh 'Plane', with 4 vertices each, need about .*: take fewer motion steps"):
        capture.capture()


def test_instances_of_a_mesh_share_its_shapes():
    open_shutter()
    ob = blender.add_plane()
    shape_key(ob, {9: 0.0, 11: 1.0})
    blender.link("Other", ob.data, (5, 0, 0))
    scene, _, _ = capture.capture()
    a, b = scene.objects
    assert a.mesh.deforms and b.mesh.deforms
    np.testing.assert_array_equal(a.mesh.shapes, b.mesh.shapes)


def test_another_topology_keeps_its_shape_and_is_told():
    open_shutter()
    ob = slide(blender.add_plane())
    array = ob.modifiers.new("Array", "ARRAY")
    array.use_constant_offset = True
    animate(array, "count", {9: 1, 10: 2, 11: 3})
    o, warnings = moved()
    assert not o.mesh.deforms
    assert o.moves
    assert any("topology changes" in line and "'Plane'" in line for line in warnings)


def test_what_is_not_there_all_the_time_stands_still_and_is_told():
    open_shutter(2.0)
    ob = slide(blender.add_plane())
    animate(ob, "hide_render", {9: True, 10: False})
    o, warnings = moved()
    assert o.is_still
    assert any("not there all the time" in line and "'Plane'" in line for line in warnings)


def test_lights_that_move_and_shutters_with_a_curve_are_told():
    open_shutter()
    light = slide(blender.link("Lamp", bpy.data.lights.new("Lamp", "POINT")))
    bpy.context.scene.render.motion_blur_shutter_curve.curves[0].points[0].location.y = 0.2
    bpy.context.scene.render.motion_blur_shutter_curve.update()
    scene, _, warnings = capture.capture()
    assert scene.lights[0].position[0] == pytest.approx(20)
    assert any("light 'Lamp'" in line and "moves" in line for line in warnings)
    assert any("curve is ignored" in line for line in warnings)
    assert light.location.x == pytest.approx(20)


def test_a_camera_moves_as_an_object_does_and_its_lens_is_told():
    open_shutter()
    camera = slide(bpy.context.scene.camera)
    scene, _, warnings = capture.capture()
    np.testing.assert_allclose(scene.camera.motion[:, 0, 3], (19, 20, 21), atol=1e-5)
    assert warnings == ()
    animate(camera.data, "lens", {9: 30.0, 11: 60.0})
    scene, _, warnings = capture.capture()
    assert any("the lens changes" in line for line in warnings)
    camera.cycles.use_motion_blur = False
    assert not len(capture.capture()[0].camera.motion)


def pixels(path):
    return blender.read_exr(blender.render(path))["ViewLayer.Combined"]


def glowing(name="Plane"):
    ob = blender.add_plane(name)
    ob.data.materials.append(blender.new_material("Glow", "ShaderNodeEmission", Strength=1.0))
    return ob


def test_a_still_scene_with_motion_blur_is_that_without_to_the_bit(tmp_path):
    """G6."""
    open_shutter()
    glowing()
    on = pixels(tmp_path / "on.exr")
    bpy.context.scene.render.use_motion_blur = False
    assert np.array_equal(on, pixels(tmp_path / "off.exr"))
    assert on.max() > 0


def test_a_picture_is_blurred_and_the_next_frame_is_another(tmp_path):
    """A plane that passes by leaves a ramp; the file's frame stays, and so do pictures that are rendered again."""
    open_shutter()
    slide(glowing(), 0.5)
    bpy.context.scene.frame_set(0)
    bpy.context.scene.glanz.samples = 64
    first = pixels(tmp_path / "a.exr")
    assert bpy.context.scene.frame_current == 0
    row = first[32, :, 0]
    assert np.count_nonzero((row > 0.1) & (row < 0.9)) >= 6
    assert np.array_equal(first, pixels(tmp_path / "b.exr"))
    bpy.context.scene.frame_set(2)
    assert not np.array_equal(first, pixels(tmp_path / "c.exr"))


def test_what_is_edited_deforms_all_the_same(tmp_path):
    """A wave, whose shape is worked out anew for each time, also where the mesh is in Edit Mode."""
    open_shutter()
    plane = blender.add_plane()
    plane.modifiers.new("Wave", "WAVE")
    bpy.context.view_layer.objects.active = plane
    try:
        bpy.ops.object.mode_set(mode="EDIT")
        blender.render(tmp_path / "a.exr")
        notes = checks.check_of(bpy.context.scene, bpy.context.view_layer.name).notes
    finally:
        bpy.ops.object.mode_set(mode="OBJECT")
    assert not any("topology" in note.what for note in notes)
