"""The pinhole camera against projection by hand (catalogue G1, G11)."""

import math

import numpy as np
import pytest

from glanz.engine import PerspectiveCamera, SceneError
from glanz.tests import helpers as h

SHAPES = [(640, 360), (1, 1), (1, 7), (16384, 1), (1, 16384)]
WINDOWS = {
    "centred": (-0.36, 0.36, -0.2, 0.2),
    "shifted": (-0.1, 0.62, -0.5, -0.1),
    "wide": (-50.0, 50.0, -30.0, 30.0),
    "long": (-1e-9, 1e-9, -2e-9, 2e-9),
    "not square": (-0.1, 0.9, -0.2, 0.1),
}


def projected(camera, width, height, p):
    """Pixel coordinates (2, N) from the top left of world points p (3, N): x = f X / Z, written out."""
    matrix = np.linalg.inv(camera.world_from_camera)
    x, y, z = matrix[:3, :3] @ p + matrix[:3, 3:]
    left, right, bottom, top = camera.window
    return np.stack(((x / -z - left) / (right - left) * width, (top - y / -z) / (top - bottom) * height))


def check_rays(camera, width, height, rays=PerspectiveCamera.rays, dtype=np.float64, tolerance=1e-9):
    """A ray through a pixel position meets points that project to it; 1e4 positions, distances from 1e-3 to 1e6."""
    k = h.table(camera.row(width, height), dtype)
    rng = np.random.default_rng(1)
    pixel = rng.random((2, 10_000)) * [[width], [height]]
    x, y = (pixel - [[width / 2], [height / 2]]).astype(dtype)
    o, d = rays(k, x, y)
    assert o.dtype == d.dtype == dtype
    assert np.abs(h.dots(d, d) - 1).max() <= 4 * np.finfo(dtype).eps
    # Points are kept relative to the pinhole, or its coordinates would eat their digits.
    still = PerspectiveCamera(world_from_camera=h.affine(camera.world_from_camera[:3, :3]), window=camera.window)
    distance = 10.0 ** rng.uniform(-3, 6, 10_000)
    back = projected(still, width, height, o + distance * d.astype(np.float64))
    assert np.abs(back - pixel).max() <= tolerance * max(width, height, 1)


@pytest.mark.parametrize("size", SHAPES, ids=str)
@pytest.mark.parametrize("name", WINDOWS)
def test_rays_pass_through_the_points_that_project_to_their_pixel(name, size):
    """G1, G11: to 1e-9 of the frame in float64, for every shape of frame and window."""
    camera = PerspectiveCamera(world_from_camera=h.affine(h.rotation(3), (4, 5, 6)), window=WINDOWS[name])
    # A lens of 1e9 leaves of 1e-16 only 1e-7 of its window.
    check_rays(camera, *size, tolerance=1e-6 if name == "long" else 1e-9)


def test_rays_in_float32_are_right_to_a_thousandth_of_a_pixel():
    camera = PerspectiveCamera.look_at((3, -4, 2), (0, 0, 0), fov=math.radians(60), aspect=16 / 9)
    check_rays(camera, 1920, 1080, dtype=np.float32, tolerance=1e-3 / 1920)


def test_projection_catches_a_camera_off_by_a_thousandth_of_a_pixel():
    camera = PerspectiveCamera.look_at((3, -4, 2), (0, 0, 0))

    def shifted(k, x, y):
        return PerspectiveCamera.rays(k, x + 1e-3, y)

    def mirrored(k, x, y):
        return PerspectiveCamera.rays(k, x, -y)

    for mutant in (shifted, mirrored):
        with pytest.raises(AssertionError):
            check_rays(camera, 640, 360, mutant)


@pytest.mark.parametrize("place", [(0, 0), (7, 0), (0, 4), (7, 4), (3, 2)], ids=str)
def test_a_point_appears_in_the_pixel_that_it_projects_to(place):
    """A small lamp-like triangle in the middle of a pixel lights that pixel and no other; rows count from the top."""
    width, height = 8, 5
    camera = PerspectiveCamera.look_at((3, -4, 2), (0.1, 0.2, 0.3), aspect=width / height)
    left, right, bottom, top = camera.window
    x = left + (place[0] + 0.5) / width * (right - left)
    y = top - (place[1] + 0.5) / height * (top - bottom)
    u, v, w = camera.world_from_camera[:3, :3].T
    middle = camera.position + 3 * (x * u + y * v - w)
    assert np.floor(projected(camera, width, height, middle[:, None])).ravel().tolist() == list(place)
    speck = h.quad(middle, 0.2 * u, 0.2 * v, name="speck")
    image = h.pixels(
        h.scene([h.thing(speck, h.lambert(0, emission=1.0))], camera=camera), h.settings(width=width, height=height, samples=64)
    )
    assert image[0, place[1], place[0]] > 0
    image[0, place[1], place[0]] = 0
    assert (image[0] == 0).all()


def test_the_field_of_view_is_vertical():
    camera = PerspectiveCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0), fov=math.radians(90), aspect=2.0)
    assert camera.window == pytest.approx((-2, 2, -1, 1))


def test_a_camera_that_sees_nothing_is_refused_by_name():
    for window in ((0.5, -0.5, -1, 1), (-1, 1, 1, 1), (-math.inf, 1, -1, 1), (math.nan, 1, -1, 1)):
        with pytest.raises(SceneError, match="camera 'Eye': window is"):
            PerspectiveCamera(name="Eye", window=window).check()
    with pytest.raises(SceneError, match="camera 'Eye': no view from"):
        PerspectiveCamera.look_at((0, 0, 1), (0, 0, 0), name="Eye")
