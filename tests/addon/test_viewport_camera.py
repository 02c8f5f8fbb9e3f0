"""The camera of a 3D view, made of Blender's matrices: points are where Blender projects them."""

import math
from types import SimpleNamespace

import bpy
import numpy as np
import pytest

from glanz.addon.viewport_camera import fractions_in, fractions_of, inside, pixels_of, projected_window, view_of
from glanz.engine import OrthographicCamera, PanoramaCamera, PerspectiveCamera
from glanz.tests.addon import blender

SIZE = (320, 200)
POINTS = np.vstack((np.random.default_rng(1).uniform(-1.5, 1.5, (3, 40)), np.ones(40)))


@pytest.fixture
def camera():
    camera = blender.add_camera(location=(1, -6, 3), width=100, height=80)
    camera.rotation_euler = (math.radians(65), 0.1, 0.2)
    bpy.context.view_layer.update()
    return camera


def region_data(camera, perspective="CAMERA", size=SIZE):
    """What Blender has for a region of this size that looks just as the camera does: its own projection matrix."""
    depsgraph = bpy.context.evaluated_depsgraph_get()
    projection = camera.calc_matrix_camera(depsgraph, x=size[0], y=size[1])
    is_perspective = camera.data.type != "ORTHO"
    return SimpleNamespace(
        view_perspective=perspective,
        is_perspective=is_perspective,
        window_matrix=projection,
        view_matrix=camera.matrix_world.inverted(),
        perspective_matrix=projection @ camera.matrix_world.inverted(),
    )


def space(camera=None, **others):
    border = {f"render_border_{end}_{axis}": float(end == "max") for end in ("min", "max") for axis in "xy"}
    return SimpleNamespace(**{"camera": camera, "clip_start": 0.01, "clip_end": 100.0, "use_render_border": False, **border, **others})


def view(data, space_, size=SIZE):
    region = SimpleNamespace(width=size[0], height=size[1])
    return view_of(region, data, space_, bpy.context.evaluated_depsgraph_get())


def places(view_):
    """Where a view's engine camera has POINTS, (2, N) [px] of the region."""
    camera = view_.camera()
    seen = np.linalg.inv(camera.world_from_camera) @ POINTS * [[1], [1], [-1], [1]]
    x, y, width, height = view_.rectangle
    return np.array(camera.in_window(seen[:3])) * [[width], [height]] + [[x], [y]]


def projected(data, size=SIZE):
    """Where Blender's matrix has them."""
    p = np.array(data.perspective_matrix) @ POINTS
    return (0.5 + 0.5 * p[:2] / p[3]) * np.array(size)[:, None]


@pytest.mark.parametrize("perspective", ["CAMERA", "PERSP"])
@pytest.mark.parametrize("shape", [(320, 200), (200, 320)])
@pytest.mark.parametrize(
    "settings", [{}, {"shift_x": 0.3, "shift_y": -0.2}, {"sensor_fit": "VERTICAL"}, {"type": "ORTHO", "ortho_scale": 5, "shift_x": 0.1}]
)
def test_points_are_where_blender_projects_them(camera, settings, shape, perspective):
    for name, value in settings.items():
        setattr(camera.data, name, value)
    data = region_data(camera, perspective, shape)
    found = view(data, space(camera), shape)
    assert found.kind is (OrthographicCamera if "type" in settings else PerspectiveCamera)
    np.testing.assert_allclose(places(found), projected(data, shape), atol=2e-3)


def test_a_border_moves_no_point(camera):
    data = region_data(camera, "PERSP")
    found = view(data, space(use_render_border=True, render_border_min_x=0.3, render_border_max_x=0.5, render_border_min_y=0.25))
    assert found.rectangle == (96, 50, 64, 150)
    assert view(data, space(render_border_max_x=0.5)).rectangle == (0, 0, *SIZE)
    np.testing.assert_allclose(places(found), projected(data), atol=2e-3)


def test_the_border_of_a_camera_is_a_part_of_its_frame(camera):
    """A frame of 100 x 80 in a region as high as it: its left half, 40 to 160 of 320 px, from a quarter of the height up."""
    render = bpy.context.scene.render
    render.use_border = True
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0, 0.5, 0.25, 1
    data = region_data(camera)
    camera.data.sensor_fit = "VERTICAL"
    camera.data.sensor_height = 20
    data = region_data(camera)
    found = view(data, space(camera))
    assert found.rectangle == (35, 50, 125, 150)
    np.testing.assert_allclose(places(found), projected(data), atol=2e-3)


def test_nothing_of_an_empty_border_is_rendered(camera):
    assert view(region_data(camera, "PERSP"), space(use_render_border=True, render_border_max_x=0.0)) is None


def test_a_panorama_fills_the_frame_of_its_camera(camera):
    """And where the frame is cut off by the region, it is a part of the panorama."""
    camera.data.type = "PANO"
    if hasattr(camera.data, "panorama_type"):
        camera.data.panorama_type = "EQUIRECTANGULAR"
    camera.data.sensor_fit, camera.data.sensor_height = "VERTICAL", 20
    render = bpy.context.scene.render
    data = region_data(camera)
    data.is_perspective = True
    found = view(data, space(camera))
    assert found.kind is PanoramaCamera
    assert found.rectangle == (35, 0, 250, 200)
    whole = found.camera()
    render.resolution_x = 200
    found = view(data, space(camera))
    assert found.rectangle == (0, 0, 320, 200)
    part = found.camera()
    np.testing.assert_allclose(part.longitude, np.multiply(whole.longitude, 320 / 500), rtol=1e-5)
    np.testing.assert_allclose(part.latitude, whole.latitude, rtol=1e-5)


def test_ranges_are_those_of_the_view_or_of_the_camera(camera):
    camera.data.clip_start, camera.data.clip_end = 0.5, 50
    assert view(region_data(camera), space(camera)).clip == (0.5, 50)
    assert view(region_data(camera, "PERSP"), space(camera)).clip == (0.01, 100)
    camera.data.type = "ORTHO"
    assert view(region_data(camera, "ORTHO"), space(camera)).clip == (-50, 50)


def test_the_lens_is_open_in_the_view_of_the_camera_alone(camera):
    camera.data.dof.use_dof = True
    assert view(region_data(camera), space(camera)).lens.is_open
    assert not view(region_data(camera, "PERSP"), space(camera)).lens.is_open


def test_any_object_may_be_looked_through(camera):
    """As Blender lets lights be; there is nothing that they say about lenses."""
    empty = blender.link("Empty", None, (0, 0, 3))
    data = region_data(camera)
    found = view(data, space(empty))
    assert found.name == "Empty"
    np.testing.assert_allclose(places(found), projected(data), atol=2e-3)


def test_equal_views_are_equal(camera):
    one, same = (view(region_data(camera), space(camera)) for _ in range(2))
    assert one == same
    camera.data.lens += 1
    assert view(region_data(camera), space(camera)) != one


def test_rectangles_and_fractions_are_inverse():
    outer, inner = (-1.0, 3.0, 2.0, 4.0), (0.0, 1.0, 2.5, 3.0)
    assert inside(outer, fractions_in(inner, outer)) == pytest.approx(inner)
    assert pixels_of(fractions_of((3, 4, 50, 60), 100, 90), 100, 90) == (3, 4, 50, 60)
    assert pixels_of((-0.5, 0.5, 0.2, 9.0), 10, 10) == (0, 2, 5, 8)


def test_a_projection_shows_what_its_matrix_says():
    """Of a pinhole: 2 n / (r - l) and (r + l) / (r - l) for what is seen at distance n."""
    left, r, b, t, n = -0.2, 0.4, -0.1, 0.3, 2.0
    x = [2 * n / (r - left), 0, (r + left) / (r - left), 0]
    y = [0, 2 * n / (t - b), (t + b) / (t - b), 0]
    assert projected_window([x, y, [0, 0, -1, -1], [0, 0, -1, 0]]) == pytest.approx([edge / n for edge in (left, r, b, t)])
