"""Stereo: one picture for each eye, from where Blender puts it (catalogue G8)."""

import bpy
import numpy as np
import pytest

from glanz import engine
from glanz.addon.capture import capture
from glanz.addon.render_engine import GlanzRenderEngine
from glanz.tests.addon import blender

PIXELS_PER_TAN, EYES, FOCUS = 1000.0, 0.065, 4.0
"""f = 1000 px, eyes 65 mm apart that converge 4 m away."""
SIDE = 64


@pytest.fixture
def stereo():
    """A camera at the origin that looks along -z; its settings for stereo."""
    # A sensor of 36 mm on 64 px: f = lens / 36 * 64.
    camera = blender.add_camera(location=(0, 0, 0), width=SIDE, height=SIDE, sensor_width=36, lens=PIXELS_PER_TAN * 36 / SIDE)
    bpy.context.scene.render.use_multiview = True
    bpy.context.scene.render.image_settings.views_format = "INDIVIDUAL"
    stereo = camera.data.stereo
    stereo.interocular_distance, stereo.convergence_distance, stereo.pivot = EYES, FOCUS, "CENTER"
    blender.set_world((1, 1, 1))
    return stereo


def rendered(monkeypatch, path):
    """[(scene, settings)] of each render that F12 asks the engine for."""
    asked = []
    original = engine.render

    def render(scene, settings, *ends):
        asked.append((scene, settings))
        return original(scene, settings, *ends)

    monkeypatch.setattr(engine, "render", render)
    blender.render(path / "a.exr")
    return asked


def place(camera, point):
    """Pixel (x, y) of a point in the camera's picture: x = f X / Z, written out."""
    x, y, z = np.linalg.inv(camera.world_from_camera)[:3] @ (*point, 1)
    left, right, bottom, top = camera.window
    return np.array(((x / -z - left) / (right - left) * SIDE, (y / -z - bottom) / (top - bottom) * SIDE))


def disparity(monkeypatch, path, distance):
    left, right = (scene.camera for scene, _ in rendered(monkeypatch, path))
    return place(left, (0, 0, -distance)) - place(right, (0, 0, -distance))


@pytest.mark.parametrize(
    ("mode", "formula"),
    [
        ("OFFAXIS", lambda z: PIXELS_PER_TAN * EYES * (1 / z - 1 / FOCUS)),
        ("PARALLEL", lambda z: PIXELS_PER_TAN * EYES / z),
        # Each eye is turned by atan(b / 2 Z0): the difference of the angles, as tangents.
        (
            "TOE",
            lambda z: 2 * PIXELS_PER_TAN * np.tan(np.arctan(EYES / 2 / z) - np.arctan(EYES / 2 / FOCUS)),
        ),
    ],
)
@pytest.mark.parametrize("distance", [1e-3, 0.5, 2.0, 4.0, 1e3, 1e6])
def test_disparity_follows_the_formula(mode, formula, distance, stereo, monkeypatch, tmp_path):
    """G8: 16.25 px at 2 m off axis, 0 vertically; to 1e-3 px, since Blender's matrices have single precision.

    A millimetre away, where it is 65,000 px, it is right to as much of itself as those leave: 1e-6.
    """
    stereo.convergence_mode = mode
    x, y = disparity(monkeypatch, tmp_path, distance)
    assert abs(x - formula(distance)) < 1e-3 + 1e-6 * abs(formula(distance))
    assert abs(y) < 1e-3
    if (mode, distance) == ("OFFAXIS", 2.0):
        assert abs(x - 16.25) < 1e-3


def test_disparity_catches_a_shift_that_is_left_out(stereo, monkeypatch, tmp_path):
    def unshifted(engine, view):
        engine.active_view_set(view)
        return engine.camera_override, engine.camera_model_matrix(engine.camera_override), 0.0

    monkeypatch.setattr(GlanzRenderEngine, "_camera", unshifted)
    assert abs(disparity(monkeypatch, tmp_path, 2.0)[0] - 16.25) > 1


def test_spherical_stereo_is_named(stereo):
    stereo.use_spherical_stereo = True
    camera = bpy.context.scene.camera.data
    camera.type, camera.panorama_type = "PANO", "EQUIRECTANGULAR"
    assert "spherical stereo is not rendered" in "".join(blender.export()[1])


def test_eyes_at_one_place_see_the_same_with_other_noise(stereo, monkeypatch, tmp_path):
    stereo.interocular_distance = 0
    (left, left_settings), (right, right_settings) = rendered(monkeypatch, tmp_path)
    assert left.camera.window == right.camera.window
    assert (left.camera.world_from_camera == right.camera.world_from_camera).all()
    assert left.objects is right.objects
    assert left_settings.seed != right_settings.seed


def combined(path):
    return blender.read_exr(path)["ViewLayer.Combined"][..., :3].astype(np.float64)


def shown_at(image):
    """Mean column of what is bright."""
    weight = image[..., 0].sum(axis=0)
    return (weight * (np.arange(SIDE) + 0.5)).sum() / weight.sum()


@pytest.mark.parametrize("name", ["GLANZ", "CYCLES"])
def test_each_eye_has_its_picture(name, stereo, tmp_path):
    """A small lamp 2 m away stands 16.25 px apart in the two files; so it does with Cycles."""
    bpy.context.scene.world = None
    lamp = blender.add_plane(size=0.01, location=(0, 0, -2))
    lamp.data.materials.append(blender.new_material("Glow", "ShaderNodeEmission", Color=(1, 1, 1, 1), Strength=1.0))
    bpy.context.scene.glanz.samples = 64
    bpy.context.scene.render.engine = name
    if name == "CYCLES":
        bpy.context.scene.cycles.samples = 64
        bpy.context.scene.cycles.use_denoising = False
    blender.render(tmp_path / "a.exr")
    left, right = combined(tmp_path / "a_L.exr"), combined(tmp_path / "a_R.exr")
    assert left.shape == right.shape == (SIDE, SIDE, 3)
    assert shown_at(left) - shown_at(right) == pytest.approx(16.25, abs=0.3)
    assert shown_at(left) + shown_at(right) == pytest.approx(SIDE, abs=0.3)


def test_a_view_that_is_off_is_not_rendered(stereo, monkeypatch, tmp_path):
    bpy.context.scene.render.views["left"].use = False
    assert len(rendered(monkeypatch, tmp_path)) == 1


def test_without_stereo_there_is_one_picture(stereo, monkeypatch, tmp_path):
    bpy.context.scene.render.use_multiview = False
    ((scene, _),) = rendered(monkeypatch, tmp_path)
    assert scene.camera.position.tolist() == [0, 0, 0]


def test_outside_of_blender_the_first_view_is_rendered_and_the_others_are_named(stereo):
    scene, _, warnings = capture()
    assert warnings == ("only view 'left' is rendered, not: right",)
    assert scene.camera.position[0] == pytest.approx(-EYES / 2)


def test_both_eyes_move_with_the_camera(stereo, monkeypatch, tmp_path):
    """Each has three keys of its own, as far apart as they are at rest."""
    scene = bpy.context.scene
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, 1.0
    for frame in (scene.frame_current - 2, scene.frame_current + 2):
        scene.camera.location.y = frame
        scene.camera.keyframe_insert("location", frame=frame)
    scene.frame_set(scene.frame_current)
    left, right = (shot.camera.motion for shot, _ in rendered(monkeypatch, tmp_path))
    assert left.shape == right.shape == (3, 4, 4)
    assert left[2, 1, 3] - left[0, 1, 3] > 0.9
    np.testing.assert_allclose((right - left)[:, :3, 3], [(EYES, 0, 0)] * 3, atol=1e-5)
