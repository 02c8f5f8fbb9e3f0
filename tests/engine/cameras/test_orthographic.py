"""The orthographic camera against projection by hand (catalogue G1, G11)."""

import math

import numpy as np
import pytest

from glanz.engine import OrthographicCamera, SceneError, render_image
from glanz.tests import helpers as h

SHAPES = [(640, 360), (1, 1), (1, 7), (16384, 1), (1, 16384)]
WINDOWS = {
    "centred": (-3.0, 3.0, -2.0, 2.0),
    "shifted": (5.0, 9.0, -7.0, -3.0),
    "wide": (-1e6, 1e6, -1e5, 1e5),
    "small": (-1e-6, 1e-6, 0.0, 1e-6),
}


def check_rays(camera, width, height, rays=OrthographicCamera.rays):
    """A ray through a pixel position meets points that project to it, which here do not depend on the distance; to 1e-9 px."""
    k = h.table(camera.row(width, height))
    pixel = h.uniform(1, 10_000) * [[width], [height]]
    o, d = rays(k, *(pixel - [[width / 2], [height / 2]]))
    # Render space is centred on the middle of what is seen, the frame of the camera is not.
    left, right, bottom, top = camera.window
    matrix = np.linalg.inv(camera.world_from_camera[:3, :3])
    size = max(right - left, top - bottom)
    x, y, z = matrix @ (o + size * h.uniform(2, 10_000)[0] * d)
    back = np.stack((x / (right - left) * width + width / 2, height / 2 - y / (top - bottom) * height))
    assert np.abs(back - pixel).max() <= 1e-9 * max(width, height)
    assert (z <= 1e-9 * size).all()
    in_frame = matrix @ (camera.position - camera.world_from_camera[:3, 3])
    np.testing.assert_allclose(in_frame, ((left + right) / 2, (bottom + top) / 2, 0), atol=1e-9 * max(size, abs(left)))


@pytest.mark.parametrize("size", SHAPES, ids=str)
@pytest.mark.parametrize("name", WINDOWS)
def test_rays_pass_through_the_points_that_project_to_their_pixel(name, size):
    check_rays(OrthographicCamera(world_from_camera=h.affine(h.rotation(3), (4, 5, 6)), window=WINDOWS[name]), *size)


def test_projection_catches_a_camera_off_by_a_thousandth_of_a_pixel_and_one_with_perspective():
    camera = OrthographicCamera.look_at((3, -4, 2), (0, 0, 0))

    def shifted(k, x, y):
        return OrthographicCamera.rays(k, x + 1e-3, y)

    def spreading(k, x, y):
        o, d = OrthographicCamera.rays(k, x, y)
        return o, d + 1e-6 * o

    for mutant in (shifted, spreading):
        with pytest.raises(AssertionError):
            check_rays(camera, 640, 360, mutant)


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
@pytest.mark.parametrize("place", [(0, 0), (7, 0), (0, 4), (7, 4), (3, 2)], ids=str)
def test_a_point_appears_in_the_pixel_that_it_projects_to(place, scale):
    """At every scale and distance; the window is shifted."""
    width, height = 8, 5
    matrix = h.affine(h.rotation(5), scale * np.array((3, -4, 2)))
    camera = OrthographicCamera(world_from_camera=matrix, window=(scale, 9 * scale, -scale, 4 * scale))
    u, v, w = camera.world_from_camera[:3, :3].T
    for distance in (1.0, 50.0):
        middle = camera.world_from_camera[:3, 3] + scale * ((1.5 + place[0]) * u + (3.5 - place[1]) * v - distance * w)
        speck = h.quad(middle, 0.4 * scale * u, 0.4 * scale * v, name="speck")
        settings = h.settings(width=width, height=height, samples=1024)
        image = render_image(h.scene([h.thing(speck, h.lambert(0, emission=1.0))], camera=camera), settings)
        seen = image.passes["Combined"][..., 0] > 0
        assert seen[place[1], place[0]]
        assert seen.sum() == 1
        assert image.passes["Combined"][place[1], place[0], 0] == pytest.approx(0.16, abs=0.05)


def test_depth_is_that_from_the_plane_of_the_camera():
    camera = OrthographicCamera.look_at((1, 2, 7.5), (1, 2, 0), up=(0, 1, 0), height=100.0)
    plane = h.thing(h.quad((0, 0, 0), (1e3, 0, 0), (0, 1e3, 0)), h.lambert(0.5))
    depth = render_image(h.scene([plane], camera=camera), h.settings(passes=("Depth",))).passes["Depth"]
    np.testing.assert_allclose(depth, 7.5, rtol=1e-6)


def test_a_camera_that_sees_nothing_is_refused_by_name():
    for window in ((0.5, -0.5, -1, 1), (-1, 1, 1, 1), (-math.inf, 1, -1, 1), (math.nan, 1, -1, 1)):
        with pytest.raises(SceneError, match="camera 'Eye': window is"):
            OrthographicCamera(name="Eye", window=window).check()
    with pytest.raises(SceneError, match="camera 'Eye': no view from"):
        OrthographicCamera.look_at((0, 0, 1), (0, 0, 0), name="Eye")


def test_the_frame_is_as_high_as_asked_for():
    camera = OrthographicCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0), height=3.0, aspect=2.0)
    assert camera.window == pytest.approx((-3, 3, -1.5, 1.5))
