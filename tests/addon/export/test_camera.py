"""The camera shows what Blender's shows."""

import math
import random

import bpy
import numpy as np
import pytest
from bpy_extras.object_utils import world_to_camera_view
from mathutils import Vector

from glanz.addon.export.camera import window
from glanz.engine import SceneError
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


@pytest.mark.parametrize("kind", ["ORTHO", "PANO"])
def test_other_types_are_refused_by_name(kind):
    blender.add_camera(type=kind)
    with pytest.raises(SceneError, match=f"camera 'Camera' has type {kind}"):
        blender.export()


def test_parents_and_their_scale_move_the_camera():
    parent = blender.link("Parent", None, (1, 2, 3))
    parent.scale = (2, 2, 2)
    blender.add_camera(location=(0, 0, 1)).parent = parent
    exported, _ = blender.export()
    np.testing.assert_allclose(exported.camera.world_from_camera[:3, 3], (1, 2, 5))
    np.testing.assert_allclose(exported.camera.world_from_camera[:3, :3], np.eye(3), atol=1e-6)


def test_depth_of_field_is_named():
    blender.add_camera().data.dof.use_dof = True
    assert "camera 'Camera'" in "".join(blender.export()[1])
