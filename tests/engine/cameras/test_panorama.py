"""The panorama: which direction is where on the map, exactly."""

import math

import numpy as np
import pytest

from glanz.engine import PanoramaCamera, SceneError, render_image
from glanz.tests import helpers as h

MARKS = {
    "ahead": ((0.5, 0.5), (0, 0, -1)),
    "right": ((0.75, 0.5), (1, 0, 0)),
    "left": ((0.25, 0.5), (-1, 0, 0)),
    "behind": ((0.0, 0.5), (0, 0, 1)),
    "behind, from the right": ((1.0, 0.5), (0, 0, 1)),
    "up": ((0.3, 0.0), (0, 1, 0)),
    "down": ((0.9, 1.0), (0, -1, 0)),
    "up ahead": ((0.5, 0.25), (0, math.sqrt(0.5), -math.sqrt(0.5))),
}


def direction(camera, x, y, rays=PanoramaCamera.rays):
    """In the camera's frame (3,), seen at the share x of the frame from the left and y from the top."""
    _, d = rays(h.table(camera.row(200, 100)), np.array([200 * (x - 0.5)]), np.array([100 * (y - 0.5)]))
    return np.linalg.inv(camera.world_from_camera[:3, :3]) @ d[:, 0]


def check_marks(rays=PanoramaCamera.rays):
    camera = PanoramaCamera(world_from_camera=h.affine(h.rotation(2), (1, 2, 3)))
    for place, expected in MARKS.values():
        np.testing.assert_allclose(direction(camera, *place, rays), expected, atol=1e-14)


def test_the_six_directions_are_where_they_belong():
    check_marks()


def test_marks_catch_a_mirrored_map_and_one_upside_down():
    for mutant in (lambda k, x, y: PanoramaCamera.rays(k, -x, y), lambda k, x, y: PanoramaCamera.rays(k, x, -y)):
        with pytest.raises(AssertionError):
            check_marks(mutant)


def test_longitude_and_latitude_are_linear_over_their_ranges():
    camera = PanoramaCamera(longitude=(-0.5, 2.0), latitude=(-0.2, 1.1))
    for x, y in h.uniform(4, 200).T:
        dx, dy, dz = direction(camera, x, y)
        assert math.atan2(dx, -dz) == pytest.approx(-0.5 + 2.5 * x, abs=1e-12)
        assert math.asin(dy) == pytest.approx(1.1 - 1.3 * y, abs=1e-12)


def test_a_lamp_appears_where_its_direction_is():
    """A small square in each of 8 x 4 fields lights that pixel and no other."""
    camera = PanoramaCamera(world_from_camera=h.affine(h.rotation(6), (10, -3, 2)))
    for column in range(8):
        for row in range(4):
            d = camera.world_from_camera[:3, :3] @ direction(PanoramaCamera(), (column + 0.5) / 8, (row + 0.5) / 4)
            frame = h.frame_towards(d)
            speck = h.quad(camera.position + 5 * d, 0.5 * frame[:, 0], 0.5 * frame[:, 1], name="speck")
            settings = h.settings(width=8, height=4, samples=256)
            image = h.pixels(h.scene([h.thing(speck, h.lambert(0, emission=1.0))], camera=camera), settings)[0]
            assert image[row, column] > 0
            assert np.count_nonzero(image) == 1


def test_depth_is_measured_along_the_ray():
    ball = h.icosphere(5, 3.0, (1, 2, 3))
    camera = PanoramaCamera(world_from_camera=h.affine(h.rotation(6), (1, 2, 3)))
    depth = render_image(h.scene([h.thing(ball)], camera=camera), h.settings(passes=("Depth",))).passes["Depth"]
    np.testing.assert_allclose(depth, 3.0, rtol=1e-3)


def test_a_map_of_nothing_is_refused_by_name():
    for name in ("longitude", "latitude"):
        for bad in ((1.0, 1.0), (2.0, 1.0), (math.nan, 1.0), (0.0, math.inf)):
            with pytest.raises(SceneError, match=f"camera 'Eye': {name} is {bad[0]} to"):
                PanoramaCamera(name="Eye", **{name: bad}).check()
