"""A compiled scene seen by other cameras, and compiled again after changes: the pictures are those of a fresh start."""

import numpy as np
import pytest

from glanz.engine import (
    CameraData,
    Lambert,
    Lens,
    LinearTexture,
    OrthographicCamera,
    PanoramaCamera,
    PerspectiveCamera,
    SceneError,
    plan as planning,
    prepare,
    render_plan,
)
from glanz.tests import helpers as h, moving, scenes

SETTINGS = h.settings(width=40, height=32, samples=4, max_depth=2, threads=2, passes=("Combined", "Depth"))
FAR = (-5.0, -3.0, 4.0)
CAMERAS = {
    "perspective": PerspectiveCamera.look_at(FAR, (0, 0, 0.5), fov=0.6),
    "lens and clip range": PerspectiveCamera.look_at(
        FAR, (0, 0, 0.5), lens=Lens(radius=0.1, focus_distance=6.0), clip_start=4.0, clip_end=8.0
    ),
    "orthographic": OrthographicCamera.look_at(FAR, (0, 0, 0.5), height=4.0),
    "orthographic from behind": OrthographicCamera.look_at((0, 0, 0.5), FAR, height=4.0, clip_start=-20.0, clip_end=20.0),
    "panorama": PanoramaCamera(world_from_camera=PerspectiveCamera.look_at((-2, -3, 2), (0, 0, 0.5)).world_from_camera),
}


def seen_by_the_way(scene):
    """`scene` with a floor that shows where the camera has it, and a lamp that shines by that."""
    floor, lamp = scene.objects[0], scene.objects[4]
    far = LinearTexture((CameraData(output="distance"),), (0.1,))
    grey = h.replaced(h.lambert(), lobes=(Lambert(far),))
    glowing = h.replaced(scenes.GLOWING, emission=LinearTexture((CameraData(output="window"),), (2.0,)))
    changed = {floor.name: grey, lamp.name: glowing}
    return h.replaced(scene, objects=tuple(h.replaced(o, materials=(changed.get(o.name, o.materials[0]),)) for o in scene.objects))


def picture(plan):
    """All passes (5, H, W) of a plan."""
    settings = plan.settings
    result = np.full((5, settings.height, settings.width), np.nan, np.float32)
    for progress in render_plan(plan):
        for tile in progress.tiles:
            values = np.concatenate([tile.passes[key] for key in settings.passes], axis=2)
            result[:, tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = np.moveaxis(values, 2, 0)
    return result


def assert_same(a, b):
    """But for rounding: at edges it decides what is seen, so one pixel in fifty may be another."""
    close = np.isclose(a, b, rtol=1e-3, atol=1e-5).all(axis=0)
    assert close.mean() >= 0.98
    np.testing.assert_allclose(a[:4].mean(axis=(1, 2)), b[:4].mean(axis=(1, 2)), rtol=0.02)


@pytest.mark.parametrize("name", CAMERAS)
def test_another_camera_on_a_compiled_world_sees_what_a_fresh_start_does(name):
    scene, camera = seen_by_the_way(scenes.everything()), CAMERAS[name]
    plan, _ = prepare(scene, SETTINGS)
    again = plan.seen_from(camera, SETTINGS)
    assert again.world.accel is plan.world.accel
    fresh, _ = prepare(h.replaced(scene, camera=camera), SETTINGS)
    assert set(again.requirements.needs) == set(fresh.requirements.needs)
    assert again.requirements.needs == fresh.requirements.needs
    assert_same(picture(again), picture(fresh))


def test_the_way_back_gives_the_same_bits():
    scene = scenes.everything()
    plan, _ = prepare(scene, SETTINGS)
    away = plan.seen_from(CAMERAS["lens and clip range"], h.replaced(SETTINGS, width=12, height=9))
    assert h.same_bits(picture(away.seen_from(scene.camera, SETTINGS)), picture(plan))


def test_a_camera_that_moves_is_followed_from_where_it_is():
    camera = CAMERAS["perspective"]
    keys = np.stack([camera.world_from_camera] * 3)
    keys[:, :3, 3] += np.array([[-0.4, 0.0, 0.4]]).T
    camera = h.replaced(camera, motion=keys)
    plan, _ = prepare(scenes.everything(), SETTINGS)
    fresh, _ = prepare(h.replaced(scenes.everything(), camera=camera), SETTINGS)
    assert_same(picture(plan.seen_from(camera, SETTINGS)), picture(fresh))


@pytest.mark.parametrize("mutant", ["start_at", "seen_from"])
def test_the_comparison_notices_a_camera_that_stays_behind(monkeypatch, mutant):
    monkeypatch.setattr(planning, mutant, lambda place: planning.seen_at_rest if mutant == "seen_from" else lambda plan, rays: None)
    with pytest.raises(AssertionError):
        test_another_camera_on_a_compiled_world_sees_what_a_fresh_start_does("perspective")


def test_a_film_may_become_transparent_and_opaque_again():
    """Without another look at the scene: only the world disappears from sight."""
    scene = scenes.everything()
    plan, _ = prepare(scene, SETTINGS)
    clear = plan.seen_from(scene.camera, h.replaced(SETTINGS, film_transparent=True))
    assert picture(clear)[3].min() == 0
    assert h.same_bits(picture(clear), picture(prepare(scene, clear.settings)[0]))
    assert h.same_bits(picture(clear.seen_from(scene.camera, SETTINGS)), picture(plan))


def test_cameras_that_see_nothing_are_refused():
    plan, _ = prepare(scenes.everything(), SETTINGS)
    with pytest.raises(SceneError, match="clip range"):
        plan.seen_from(h.replaced(CAMERAS["perspective"], clip_start=-1.0), SETTINGS)


def test_what_is_looked_at_closely_and_far_from_the_middle_is_not_exact():
    """At 1000 m from the middle 1e-3 m is not to be seen to a pixel; at 10 m, or from 1000 m, all is well."""
    scene = h.scene([h.thing(h.quad((0, 0, 0), (4000, 0, 0), (0, 4000, 0)))])
    plan, _ = prepare(scene, SETTINGS)

    def is_exact(x, height):
        return plan.seen_from(PerspectiveCamera.look_at((x, 0, height), (x, 0.1 * height, 0)), SETTINGS).is_exact()

    assert plan.is_exact()
    assert is_exact(10, 1)
    assert is_exact(1000, 1000)
    assert not is_exact(1000, 1e-3)


def changed(scene, **changes):
    """`scene` with changes to its first object."""
    return h.replaced(scene, objects=(h.replaced(scene.objects[0], **changes), *scene.objects[1:]))


def test_after_a_change_of_materials_the_tree_stays():
    scene = scenes.everything()
    plan, _ = prepare(scene, SETTINGS)
    other = changed(h.replaced(scene, lights=scene.lights[:2], camera=CAMERAS["perspective"]), materials=(h.lambert((0.1, 0.9, 0.1)),))
    again, _ = prepare(other, SETTINGS, before=plan)
    assert again.world.accel is plan.world.accel
    assert_same(picture(again), picture(prepare(other, SETTINGS)[0]))


@pytest.mark.parametrize("mutant", [False, True])
def test_after_a_change_of_shape_it_does_not(monkeypatch, mutant):
    scene = scenes.everything()
    plan, _ = prepare(scene, SETTINGS)
    other = changed(scene, world_from_object=h.affine(translation=(0, 0, 0.25)))
    if mutant:
        monkeypatch.setattr("glanz.engine.world.accel.Accel.is_of", lambda *_: True)
    again, _ = prepare(other, SETTINGS, before=plan)
    assert (again.world.accel is plan.world.accel) == mutant
    same = np.isclose(picture(again), picture(prepare(other, SETTINGS)[0]), rtol=1e-3, atol=1e-5)
    assert (same.mean() > 0.98) != mutant


def test_what_moves_is_compiled_again_as_well():
    settings = h.replaced(SETTINGS, motion_steps=2)
    scene = scenes.everything()
    turning = moving.moving(scene.objects[2], moving.turned((0.0, 0.5, 1.0)))
    scene = h.replaced(scene, objects=(*scene.objects[:2], turning, *scene.objects[3:]))
    plan, _ = prepare(scene, settings)
    again, _ = prepare(scene, settings, before=plan)
    assert h.same_bits(picture(again), picture(plan))
