"""The camera shows what Blender's shows."""

import math
import random
from types import SimpleNamespace

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

from glanz.addon.export.camera import fitted_window, panorama_setting, window
from glanz.engine import OrthographicCamera, PanoramaCamera, SceneError
from glanz.tests.addon import blender

MOST_PIXELS = 1e-4


def _random_camera(rng):
    render = bpy.context.scene.render
    camera = blender.add_camera(
        # At the origin: elsewhere Blender's single precision is coarser than what is tested.
        location=(0, 0, 0),
        width=rng.randint(16, 256),
        height=rng.randint(16, 256),
        lens=rng.uniform(10, 100),
        sensor_fit=rng.choice(("AUTO", "HORIZONTAL", "VERTICAL")),
        sensor_width=rng.uniform(20, 70),
        sensor_height=rng.uniform(20, 70),
        shift_x=rng.uniform(-1, 1),
        shift_y=rng.uniform(-1, 1),
    )
    camera.rotation_euler = [rng.uniform(-math.pi, math.pi) for _ in range(3)]
    camera.scale = [rng.uniform(0.1, 10) for _ in range(3)]
    render.pixel_aspect_x = rng.choice((1, rng.uniform(1, 3)))
    render.pixel_aspect_y = rng.choice((1, rng.uniform(1, 3)))
    return camera


def _pixel(camera, width, height, point):
    """Where the engine's camera sees a point of world space [px], from the bottom left."""
    x, y, z = np.linalg.inv(camera.world_from_camera)[:3] @ (*point, 1)
    left, right, bottom, top = camera.window
    return (x / -z - left) / (right - left) * width, (y / -z - bottom) / (top - bottom) * height


@pytest.mark.parametrize("seed", range(50))
def test_points_land_on_blenders_pixels(seed):
    rng = random.Random(seed)
    ob = _random_camera(rng)
    render = bpy.context.scene.render
    size = render.resolution_x, render.resolution_y
    exported, _ = blender.export()
    for _ in range(10):
        depth = rng.uniform(1, 20)
        left, right, bottom, top = exported.camera.window
        local = (rng.uniform(left, right) * depth, rng.uniform(bottom, top) * depth, -depth)
        point = ob.rotation_euler.to_matrix() @ Vector(local)
        expected = world_to_camera_view(bpy.context.scene, ob, point)
        x, y = _pixel(exported.camera, *size, point)
        assert abs(x - expected.x * size[0]) < MOST_PIXELS
        assert abs(y - expected.y * size[1]) < MOST_PIXELS


def test_the_window_follows_the_formula():
    # 36 mm over 50 mm across the longer side, shifted by a tenth of that side.
    left, right, bottom, top = window(200, 100, 50, 36, 24, "AUTO", 0.1, 0.0)
    assert (left, right, bottom, top) == pytest.approx((-0.36 + 0.072, 0.36 + 0.072, -0.18, 0.18))
    assert window(100, 200, 50, 36, 24, "AUTO", 0, 0) == pytest.approx((-0.18, 0.18, -0.36, 0.36))
    assert window(200, 100, 50, 36, 24, "VERTICAL", 0, 0) == pytest.approx((-0.48, 0.48, -0.24, 0.24))


@pytest.mark.parametrize("seed", range(50))
def test_points_land_on_blenders_pixels_without_perspective(seed):
    rng = random.Random(seed)
    ob = _random_camera(rng)
    ob.data.type = "ORTHO"
    ob.data.ortho_scale = rng.uniform(0.1, 20)
    render = bpy.context.scene.render
    size = render.resolution_x, render.resolution_y
    camera = blender.export()[0].camera
    assert isinstance(camera, OrthographicCamera)
    left, right, bottom, top = camera.window
    for _ in range(10):
        # Not far away for the width of the view: Blender's single precision again.
        local = (rng.uniform(left, right), rng.uniform(bottom, top), -rng.uniform(0.1, 3) * ob.data.ortho_scale)
        point = ob.rotation_euler.to_matrix() @ Vector(local)
        expected = world_to_camera_view(bpy.context.scene, ob, point)
        x, y, _ = np.linalg.inv(camera.world_from_camera)[:3] @ (*point, 1)
        assert abs((x - left) / (right - left) - expected.x) * size[0] < MOST_PIXELS
        assert abs((y - bottom) / (top - bottom) - expected.y) * size[1] < MOST_PIXELS


def test_the_window_without_perspective_follows_the_formula():
    assert fitted_window(200, 100, 3, "AUTO", 0.1, 0) == pytest.approx((-3 + 0.6, 3 + 0.6, -1.5, 1.5))
    assert fitted_window(200, 100, 3, "VERTICAL", 0, 0) == pytest.approx((-6, 6, -3, 3))


@pytest.mark.parametrize("kind", ["FISHEYE_EQUISOLID", "FISHEYE_EQUIDISTANT", "MIRRORBALL", "EQUIANGULAR_CUBEMAP_FACE"])
def test_other_panoramas_are_refused_by_name(kind):
    blender.add_camera(type="PANO").data.panorama_type = kind
    with pytest.raises(SceneError, match=f"camera 'Camera' has panorama type {kind}"):
        blender.export()


@pytest.mark.skipif(bpy.app.version < (4, 5), reason="cameras of one's own came with Blender 4.5")
def test_other_types_are_refused_by_name():
    blender.add_camera(type="CUSTOM")
    with pytest.raises(SceneError, match="camera 'Camera' has type CUSTOM"):
        blender.export()


def test_a_panorama_covers_its_range_shifted_by_shares_of_the_frame():
    data = blender.add_camera(type="PANO", shift_x=0.25, shift_y=-0.5).data
    data.panorama_type = "EQUIRECTANGULAR"
    camera = blender.export()[0].camera
    assert isinstance(camera, PanoramaCamera)
    assert camera.longitude == pytest.approx((-math.pi / 2, 3 * math.pi / 2))
    assert camera.latitude == pytest.approx((-math.pi, 0))
    data.shift_x = data.shift_y = 0
    data.longitude_min, data.longitude_max, data.latitude_min, data.latitude_max = -1, 2, -0.5, 0.25
    camera = blender.export()[0].camera
    assert camera.longitude == pytest.approx((-1, 2))
    assert camera.latitude == pytest.approx((-0.5, 0.25))


def test_settings_of_a_panorama_are_found_where_a_version_of_blender_keeps_them():
    of_blender = SimpleNamespace(latitude_min=1, cycles=SimpleNamespace(latitude_min=2))
    of_cycles = SimpleNamespace(cycles=SimpleNamespace(latitude_min=2))
    assert panorama_setting(of_blender, "latitude_min", 3) == 1
    assert panorama_setting(of_cycles, "latitude_min", 3) == 2
    assert panorama_setting(SimpleNamespace(), "latitude_min", 3) == 3


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO", "PANO"])
def test_the_clip_range_is_that_of_blender(kind):
    data = blender.add_camera(type=kind, clip_start=0.25, clip_end=64).data
    data.panorama_type = "EQUIRECTANGULAR"
    camera = blender.export()[0].camera
    assert (camera.clip_start, camera.clip_end) == (0.25, 64)
    assert not camera.lens.is_open
    data.clip_end = 0.125
    assert blender.export()[0].camera.clip_end == 0.125


def test_parents_and_their_scale_move_the_camera():
    parent = blender.link("Parent", None, (1, 2, 3))
    parent.scale = (2, 2, 2)
    blender.add_camera(location=(0, 0, 1)).parent = parent
    exported, _ = blender.export()
    np.testing.assert_allclose(exported.camera.world_from_camera[:3, 3], (1, 2, 5))
    np.testing.assert_allclose(exported.camera.world_from_camera[:3, :3], np.eye(3), atol=1e-6)


def _lens(kind="PERSP", **attributes):
    data = blender.add_camera(type=kind, lens=80).data
    data.panorama_type = "EQUIRECTANGULAR"
    data.dof.use_dof = True
    for name, value in attributes.items():
        setattr(data.dof, name, value)
    scene, warnings = blender.export()
    assert warnings == ()
    return scene.camera.lens


def test_the_aperture_follows_the_f_stop():
    """Radius f / (2 N); without a focal length f is 1 m."""
    assert _lens(aperture_fstop=2).radius == pytest.approx(0.02)
    assert _lens("ORTHO", aperture_fstop=2).radius == pytest.approx(0.25)
    assert _lens("PANO", aperture_fstop=2).radius == pytest.approx(0.02)
    assert _lens(aperture_fstop=0).radius == pytest.approx(0.04 / 1e-5)


def test_the_shape_of_the_aperture_is_that_of_blender():
    shape = _lens(aperture_blades=5, aperture_rotation=0.5, aperture_ratio=2, focus_distance=3)
    assert (shape.blades, shape.rotation, shape.ratio, shape.focus_distance) == (5, 0.5, 2, 3)
    assert _lens(aperture_blades=0).blades == 0


def test_focus_is_on_the_plane_of_the_object_or_its_bone():
    target = blender.link("Target", None, (7, -3, -2))
    assert _lens(focus_object=target).focus_distance == pytest.approx(7)  # the camera is at z = 5
    armature = blender.link("Armature", bpy.data.armatures.new("Armature"), (0, 0, 1))
    bpy.context.view_layer.objects.active = armature
    bpy.ops.object.mode_set(mode="EDIT")
    bone = armature.data.edit_bones.new("Bone")
    bone.head, bone.tail = (0, 0, 1), (0, 0, 2)
    bpy.ops.object.mode_set(mode="OBJECT")
    assert _lens(focus_object=armature).focus_distance == pytest.approx(4)
    assert _lens(focus_object=armature, focus_subtarget="Bone").focus_distance == pytest.approx(3)
