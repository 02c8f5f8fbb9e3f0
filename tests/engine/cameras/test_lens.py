"""The thin lens against optics by hand (catalogue G2)."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from glanz.engine import Lens, PerspectiveCamera
from glanz.engine.wavefront.camera_rays import round_aperture, through_the_lens
from glanz.tests import chance, helpers as h

FOCAL_LENGTH, STOP, FOCUS, OBJECT = 0.05, 2.0, 2.0, 4.0
"""50 mm at f/2, focused at 2 m; a point at 4 m."""
APERTURE = FOCAL_LENGTH / STOP
CIRCLE = APERTURE * abs(OBJECT - FOCUS) / OBJECT * FOCAL_LENGTH / (FOCUS - FOCAL_LENGTH)
"""Diameter of the circle of confusion on the sensor: 0.320513 mm."""
IMAGE_DISTANCE = 1 / (1 / FOCAL_LENGTH - 1 / FOCUS)
"""Where the sensor is behind the lens when it is focused: 51.282 mm."""


def on_the_sensor(lens_rays=PerspectiveCamera.lens_rays, n=400_000, aperture=APERTURE):
    """The cone of rays of one film position, sharp at FOCUS, where it meets the plane at OBJECT: (2, n) [m], as large as its image.

    By reciprocity a point of that plane is imaged to a circle of the same size.
    """
    lens = Lens(radius=aperture / 2, focus_distance=FOCUS)
    k = h.table(PerspectiveCamera(lens=lens).row(1, 1))
    points = round_aperture(k, h.uniform(5, n)) * np.array([k.lens_width, k.lens_height])
    o, d = lens_rays(k, np.zeros(n), np.zeros(n), points)
    at = o + (OBJECT - h.dots(o, k.axis)) / h.dots(d, k.axis) * d
    return at[:2] * IMAGE_DISTANCE / OBJECT


def check_circle(lens_rays=PerspectiveCamera.lens_rays, aperture=APERTURE):
    """E[r^2] = (c / 2)^2 / 2 at level ALPHA (detects 0.4 %), the largest r = c / 2, and uniform over the disk."""
    x, y = on_the_sensor(lens_rays, aperture=aperture)
    radius = CIRCLE / 2 * aperture / APERTURE
    share = (x * x + y * y) / radius**2
    assert h.mean_is(share, 0.5)
    assert 1 - 1e-4 <= share.max() <= 1 + 1e-9
    turn = np.arctan2(y, x)
    counts = np.histogram2d(share, turn, bins=16, range=((0, 1 + 1e-9), (-math.pi, math.pi)))[0]
    assert h.chi2_p(counts, np.full(256, x.size / 256)) > h.ALPHA


@chance.fresh
def test_the_circle_of_confusion_has_its_closed_form():
    """G2."""
    assert abs(CIRCLE / 0.320513e-3 - 1) < 1e-5
    check_circle()


@pytest.mark.parametrize("aperture", [1e-6, 1e-3, 1.0])
@chance.fresh
def test_the_circle_grows_with_the_aperture(aperture):
    """G2 from a thousandth of a millimetre to a metre; none at 0, see the contracts of cameras."""
    check_circle(aperture=aperture)


@pytest.mark.parametrize("k", [-40, 40])
def test_a_power_of_two_as_scale_changes_no_bit_of_what_is_out_of_focus(k):
    """A2, G3 with an open lens, a thing in focus and one behind it."""

    def picture(scale):
        camera = PerspectiveCamera(
            world_from_camera=h.affine(translation=(0, 0, 4 * scale)), lens=Lens(radius=0.25 * scale, focus_distance=4.0 * scale)
        )
        things = [
            h.thing(h.quad((0, 0, z * scale), (scale, 0, 0), (0, scale, 0), name=f"{z}"), h.lambert(0, emission=1.0 + z)) for z in (0, 2)
        ]
        return h.pixels(h.scene(things, camera=camera, world=0.5), h.settings())

    assert h.same_bits(picture(2.0**k), picture(1.0))


def test_the_circle_catches_a_focus_off_by_one_percent_and_a_lens_without_its_middle():
    def other_focus(k, x, y, lens):
        k.per_focus = k.per_focus / 1.01
        return PerspectiveCamera.lens_rays(k, x, y, lens)

    def crowded(k, x, y, lens):
        return PerspectiveCamera.lens_rays(k, x, y, lens * np.hypot(*lens) / (APERTURE / 2))

    for mutant in (other_focus, crowded):
        with pytest.raises(AssertionError):
            check_circle(mutant)


def test_a_picture_shows_the_circle():
    """A distant speck through the lens lights pixels up to the radius of the circle and none beyond, evenly."""
    side = 64
    lens = Lens(radius=0.5, focus_distance=4.0)
    camera = PerspectiveCamera(window=(-0.2, 0.2, -0.2, 0.2), lens=lens)
    speck = h.thing(h.quad((0, 0, -8), (0.02, 0, 0), (0, 0.02, 0), name="speck"), h.lambert(0, emission=1e4))
    image = h.pixels(h.scene([speck], camera=camera), h.settings(width=side, height=side, samples=256))[0]
    # At distance 8 rays through the sharp point at distance 4 s spread as far as the lens; in units of the window: 0.5 / 8.
    radius = lens.radius * (1 / 4 - 1 / 8) / 0.4 * side
    y, x = np.indices((side, side)) - (side - 1) / 2
    r = np.hypot(x, y)
    assert (image[r > radius + 1.5] == 0).all()
    inner, outer = image[r < radius / 2], image[(r > radius / 2) & (r < radius - 1.5)]
    assert min(inner.size, outer.size) > 50
    assert h.means_agree(inner, outer)
    expected = 1e4 * (0.02 / 8) ** 2 / (math.pi * (lens.radius * (1 / 4 - 1 / 8)) ** 2)
    assert h.mean_is(np.concatenate((inner, outer)), expected, floor=0.02)


@pytest.mark.parametrize(("blades", "ratio"), [(0, 1.0), (0, 2.0), (3, 1.0), (6, 0.5)])
def test_the_aperture_is_as_high_and_as_wide_as_it_says(blades, ratio):
    """The stage itself, in render space: the largest coordinates over many rays, in units of the radius."""
    lens = Lens(radius=0.5, focus_distance=4.0, blades=blades, ratio=ratio)
    scene = h.scene([h.thing(h.box())], camera=PerspectiveCamera(world_from_camera=h.affine(translation=(0, 0, 40)), lens=lens))
    plan = h.plan_of(scene, h.settings(samples=4096))
    rays = np.arange(50_000, dtype=np.uint32)
    rays = SimpleNamespace(key=rays, sample=rays % 4096, depth=0, split=1, stream=0)
    o, _ = through_the_lens(plan, rays, np.zeros(50_000, np.float32), np.zeros(50_000, np.float32))
    x, y = o[:2] / (0.5 * plan.world.frame.scale)
    corners = 2 * np.pi * (np.arange(blades) + 0.5) / blades if blades else np.linspace(0, 2 * np.pi, 361)
    assert x.max() == pytest.approx(np.cos(corners).max() / ratio, rel=0.02)
    assert x.min() == pytest.approx(np.cos(corners).min() / ratio, rel=0.02)
    assert y.max() == pytest.approx(np.sin(corners).max(), rel=0.02)
