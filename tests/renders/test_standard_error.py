"""The error that a picture says it has: right for every sampler (catalogue H2), also when it has ended a render."""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, SceneError, render_image
from glanz.engine.registry import SAMPLERS
from glanz.engine.wavefront import camera_rays
from glanz.engine.wavefront.replicates import Replicates
from glanz.tests import helpers as h, scenes
from glanz.tests.polygons import polygon_irradiance

SIDE = 64
PASSES = ("Combined", "Standard Error", "Confidence")


def lamp(height=1.0, size=0.001):
    """A square lamp over a point, half of it behind a wall: (scene, radiance of the point)."""
    place = h.affine(translation=(0, 0, height))
    light = AreaLight(name="lamp", world_from_light=place, size_x=1.0, size_y=1.0, radiance=(1.0, 2.0, 3.0))
    wall = h.thing(h.quad((1.0, 0, 0.5), (2.0, 0, 0), (0, 4.0, 0), name="wall"), h.lambert(0.0))
    corners = [(x, y, height) for x, y in ((-0.5, -0.5), (0, -0.5), (0, 0.5), (-0.5, 0.5))]
    truth = polygon_irradiance(corners, (0, 0, 0), (0, 0, 1)) / math.pi
    return h.receiver([light], [wall], distance=0.1, size=size), truth * np.array((1.0, 2.0, 3.0))


def rendered(scene, **changes):
    settings = {"width": SIDE, "height": SIDE, "samples": 64, "max_depth": 0, "passes": PASSES, "tile_size": 0}
    return render_image(scene, h.settings(**(settings | changes)))


def check_error(sampler, seed=0):
    """4,096 pixels of known radiance: how far they are from it, in standard errors, follows Student's t of 7 degrees.

    Its variance is 7/5, and its fourth moment makes the mean square of so many known to 4 %; what is in the 95 % interval is known
    to 0.34 %. The mean squared error is known to 2.2 %, its estimate to 0.9 %. At false alarms below 1e-5, errors of 11 % and
    intervals that are 0.1 times too wide or narrow are noticed.
    """
    scene, truth = lamp()
    values, error, half = (rendered(scene, sampler=sampler, seed=seed).passes[key][..., :3].astype(float) for key in PASSES)
    away = values[..., 0] - truth[0]
    assert abs(away.mean()) <= h.Z * error[..., 0].mean() / SIDE
    assert np.square(error[..., 0]).mean() == pytest.approx(np.square(away).mean(), rel=0.11)
    inside = (np.abs(away) <= half[..., 0]).mean()
    assert 0.935 <= inside <= 0.965


@pytest.mark.parametrize("sampler", [key for key in SAMPLERS if key != "grid"])
def test_the_standard_error_is_that_of_the_picture(sampler):
    check_error(sampler)


@pytest.mark.parametrize(
    "mutant",
    [
        (Replicates, "standard_error", lambda self, whole=Replicates.standard_error: whole(self) * 1.12),
        # All replicates are one and the same.
        (camera_rays, "seed_of", lambda seed, replicate: seed),
        # Replicates that know of each other.
        (camera_rays, "seed_of", lambda seed, replicate: seed + replicate // 2),
    ],
    ids=["a tenth too large", "always the same", "in pairs"],
)
def test_a_wrong_error_is_noticed(monkeypatch, mutant):
    monkeypatch.setattr(*mutant)
    with pytest.raises(AssertionError):
        check_error("sobol")


def test_samples_of_one_even_set_say_too_much(monkeypatch):
    """Why there are replicates: parts of one set complement each other, and what they differ by is not the error."""
    scene, _ = lamp()
    even = rendered(scene, sampler="sobol", replicates=1, passes=("Combined",)).passes["Combined"][..., 0]
    parts = [rendered(scene, sampler="sobol", replicates=1, passes=("Combined",), sample_range=(8 * i, 8 * i + 8)) for i in range(8)]
    told = np.stack([part.passes["Combined"][..., 0] for part in parts]).std(axis=0, ddof=1) / math.sqrt(8)
    assert np.sqrt(np.square(told).mean()) > 1.5 * even.std()


def test_the_95_percent_of_a_picture_are_95_percent():
    """64 seeds of a picture with shadows, gloss and light of all kinds, against a long one; 93 to 97 % of the pixels are within."""
    scene = scenes.everything()
    settings = {"width": 8, "height": 8, "max_depth": 2, "threads": 1}
    images = [rendered(scene, **settings, seed=seed).passes for seed in range(64)]
    truth = rendered(scene, **settings, samples=16384, seed=100, passes=("Combined",)).passes["Combined"]
    inside = [np.abs(image["Combined"] - truth)[..., :3] <= image["Confidence"] for image in images]
    assert 0.93 <= np.mean(inside) <= 0.97


def test_tiles_threads_and_batches_do_not_change_a_bit():
    images = [rendered(scenes.everything(), width=20, height=14, samples=12, **more) for more in ({}, {"tile_size": 7, "threads": 3})]
    for key in PASSES:
        assert h.same_bits(images[0].passes[key], images[1].passes[key])


def test_one_replicate_is_the_picture_without():
    one, none = (rendered(scenes.everything(), width=16, height=16, samples=16, passes=("Combined",), replicates=n) for n in (1, 0))
    assert h.same_bits(one.passes["Combined"], none.passes["Combined"])


def test_one_replicate_knows_no_error():
    image = rendered(lamp()[0], replicates=1)
    assert np.isinf(image.passes["Standard Error"]).all()
    assert image.metadata["glanz.reached.error"] == "not measured"


def test_divided_pixels_know_their_error():
    """Adaptive supersampling: the error of a pixel is that of the mean of its cells. Here all are divided, so nothing is chosen by luck."""
    scene, truth = lamp()
    image = rendered(scene, adaptive_threshold=1e-9, adaptive_levels=1, samples=16)
    away = image.passes["Combined"][..., 0] - truth[0]
    assert np.square(image.passes["Standard Error"][..., 0]).mean() == pytest.approx(np.square(away).mean(), rel=0.11)


def test_negative_lobes_know_their_error():
    """Mitchell's filter over a picture that is the same everywhere: no error of its own, and that of the lamp."""
    scene, truth = lamp()
    image = rendered(scene, pixel_filter="mitchell", samples=256)
    away = image.passes["Combined"][..., 0] - truth[0]
    assert np.square(image.passes["Standard Error"][..., 0]).mean() == pytest.approx(np.square(away).mean(), rel=0.11)
    even = rendered(h.scene(world=0.5), pixel_filter="mitchell", samples=100)
    np.testing.assert_allclose(even.passes["Standard Error"], 0, atol=1e-7)


def test_infinitely_many_is_refused_by_name():
    with pytest.raises(SceneError, match="setting replicates is -1"):
        h.settings(replicates=-1)
