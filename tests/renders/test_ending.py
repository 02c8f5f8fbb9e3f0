"""What ends a render: all samples, an error or a time, and what it says of that."""

import math
import threading

import numpy as np
import pytest

from glanz.engine import SceneError, ending, render, render_image
from glanz.engine.ending import Ending, Reached
from glanz.engine.measured import Found, picture_error, scatter
from glanz.engine.rendering import render_plan
from glanz.tests import helpers as h, scenes

from .test_standard_error import lamp

SMALL = {"width": 32, "height": 32, "max_depth": 0, "samples": 4096, "tile_size": 16}


class Clock:
    """A time [s] that passes by `step` whenever somebody looks."""

    def __init__(self, step):
        self.now, self.step = 0.0, step

    def monotonic(self):
        self.now += self.step
        return self.now


def relative_rmse(image, truth):
    return math.sqrt(np.square(image.passes["Combined"][..., :3] - truth).mean()) / truth.mean()


@pytest.mark.parametrize("target", [0.1, 0.025])
@pytest.mark.parametrize("sampler", ["sobol", "stratified", "random"])
def test_an_error_that_was_asked_for_is_reached_and_not_by_much_more(target, sampler):
    """Of a picture whose truth is known, by 3072 values, of which the RMSE is known to 2.2 %; a third more samples may be all there are."""
    scene, truth = lamp()
    image = render_image(scene, h.settings(**SMALL, error_target=target, sampler=sampler))
    reached = float(image.metadata["glanz.reached.error"])
    samples = int(image.metadata["glanz.reached.samples"])
    assert image.metadata["glanz.reached.ended_by"] == "error"
    assert reached <= target
    assert samples <= 48 or reached >= 0.85 * target
    assert relative_rmse(image, truth) == pytest.approx(reached, rel=0.12)


def check_luck():
    """Of 24 pictures of 64 pixels, whose errors luck has off by a twelfth, at most 2 miss the target by a twentieth: 1 in 100 should."""
    scene, truth = lamp()
    changes = {"width": 8, "height": 8, "error_target": 0.05, "sampler": "random"}
    pictures = [render_image(scene, h.settings(**SMALL | changes, seed=seed)) for seed in range(24)]
    assert sum(relative_rmse(picture, truth) > 1.05 * 0.05 for picture in pictures) <= 2


def test_the_error_that_was_asked_for_is_that_of_the_picture_not_of_many():
    check_luck()


def test_a_target_that_trusts_to_luck_is_noticed(monkeypatch):
    monkeypatch.setattr(ending, "LUCK", 0.0)
    monkeypatch.setattr(ending, "MISSED", 1.0)
    monkeypatch.setattr(ending, "LOWEST_AIM", 1.0)
    with pytest.raises(AssertionError):
        check_luck()


def test_the_scatter_is_that_of_pictures_with_such_errors():
    """10,000 pictures of 500 pixels with errors as unlike as a few bright ones make them: known to 1 %, 4 % would be noticed."""
    random = np.random.default_rng(3)
    squares = random.exponential(size=500) ** 3
    away = random.standard_normal((10_000, 500)) * np.sqrt(squares)
    errors = np.sqrt(np.square(away).mean(axis=1) / squares.mean())
    parts = [Found(np.ones(250, int), part, 1.0) for part in np.split(squares, 2)]
    assert errors.std() == pytest.approx(scatter(parts), rel=0.04)
    assert scatter([Found(np.ones(500, int), np.ones(500), 1.0)]) == pytest.approx(1000**-0.5)
    assert 0.5 * errors.std() > 1000**-0.5
    assert scatter([Found(np.ones(2, int), np.array((math.inf, 1.0)), 1.0)]) == scatter([Found(np.ones(2, int), np.zeros(2), 1.0)]) == 0


def test_what_has_ended_early_is_the_picture_of_so_many_samples():
    scene, _ = lamp()
    settings = h.settings(**SMALL, error_target=0.02, replicates=256)
    image = render_image(scene, settings)
    samples = int(image.metadata["glanz.reached.samples"])
    assert 32 <= samples < 4096
    again = render_image(scene, h.replaced(settings, error_target=0.0, sample_range=(0, samples)))
    assert h.same_bits(image.passes["Combined"], again.passes["Combined"])


def test_an_error_out_of_reach_takes_all_samples():
    image = render_image(lamp()[0], h.settings(**SMALL | {"samples": 64}, error_target=1e-9))
    assert image.metadata["glanz.reached.ended_by"] == "samples"
    assert image.metadata["glanz.reached.samples"] == "64"
    assert float(image.metadata["glanz.reached.error"]) > 1e-9


def test_a_black_picture_is_without_error():
    image = render_image(h.scene(), h.settings(**SMALL, error_target=0.01))
    assert (image.metadata["glanz.reached.ended_by"], image.metadata["glanz.reached.error"]) == ("error", "0")


def test_every_tile_is_final_once_and_progress_ends_at_one():
    for more in ({"error_target": 0.05}, {"samples": 64}):
        progress = list(render(lamp()[0], h.settings(**SMALL | more)))
        final = [(tile.x, tile.y) for step in progress for tile in step.tiles if tile.is_final]
        assert sorted(final) == [(0, 0), (0, 16), (16, 0), (16, 16)]
        assert progress[-1].done == 1.0
        assert progress[-1].reached.ended_by == ("error" if "error_target" in more else "samples")
        assert all(0 <= step.done <= 1 for step in progress)


@pytest.mark.parametrize("step", [0.05, 0.5, 50.0])
def test_a_time_limit_ends_it_with_a_sample_of_every_pixel(monkeypatch, step):
    monkeypatch.setattr(ending, "time", Clock(step))
    image = render_image(scenes.everything(), h.settings(**SMALL | {"samples": 2**20}, time_limit=5.0, passes=("Combined", "Sample Count")))
    count = image.passes["Sample Count"]
    assert image.metadata["glanz.reached.ended_by"] == "time"
    assert 1 <= count.min() <= count.max() < 2**20
    assert int(image.metadata["glanz.reached.samples"]) == count.min()
    assert np.isfinite(image.passes["Combined"]).all()


def test_what_is_cancelled_has_the_samples_that_every_pixel_has():
    """Not those of the round that it was in."""
    cancelled = threading.Event()
    plan = h.plan_of(scenes.everything(), h.settings(**SMALL | {"samples": 64}))
    steps = []
    for step in render_plan(plan, (16,), cancelled):
        steps.append(step)
        if step.reached.samples == 16:
            cancelled.set()
    assert (steps[-1].reached.samples, steps[-1].reached.ended_by) == (16, "")
    assert not any(tile.is_final for tile in steps[-1].tiles)


def test_time_is_not_what_ends_a_picture_that_is_done(monkeypatch):
    monkeypatch.setattr(ending, "time", Clock(1e-6))
    image = render_image(scenes.everything(), h.settings(samples=4, time_limit=5.0))
    assert image.metadata["glanz.reached.ended_by"] == "samples"


def test_a_picture_that_time_has_cut_is_unbiased(monkeypatch):
    """Where a tile has more samples than the next both are means of their own: the time is over at the eighth tile of the second round."""
    scene, truth = lamp()
    looks = iter(range(10**6))
    monkeypatch.setattr(Ending, "is_late", lambda self: next(looks) > 8)
    settings = SMALL | {"samples": 2**20, "tile_size": 8, "passes": ("Combined", "Sample Count")}
    image = render_image(scene, h.settings(**settings, time_limit=1e6))
    assert image.passes["Sample Count"].min() < image.passes["Sample Count"].max()
    assert h.mean_is(image.passes["Combined"][..., 0].reshape(-1).astype(float), truth[0], floor=1e-4)


def test_progress_follows_the_forecast():
    """A quarter of the samples that the target will take is a quarter of the work; none is known before the first error is."""
    way = Ending(h.settings(samples=2**20, error_target=0.01))
    assert way.share(64 / 2**20, Reached(64)) == 64 / 2**20
    assert way.share(256 / 2**20, Reached(256, 0.02)) == pytest.approx(0.25)
    assert way.share(384 / 2**20, Reached(256, 0.02)) == pytest.approx(0.375)
    assert way.share(256 / 2**20, Reached(256, 0.0)) == 1.0
    assert Ending(h.settings(samples=64)).share(0.5, Reached(0)) == 0.5


def test_a_picture_whose_light_adds_up_to_nothing_has_no_relative_error():
    """Filters with negative lobes may leave as much below as above 0."""

    def error(squares, radiance):
        return picture_error([Found(np.ones(3, int), np.array(squares), radiance)], "relative")

    assert error((1.0, 0.0, 0.0), 0.0) == math.inf
    assert error((1.0, 1.0, 1.0), 6.0) == 0.5
    assert error((0.0, 0.0, 0.0), 0.0) == 0.0


@pytest.mark.parametrize(
    ("spreads", "slope", "learned"),
    [(False, 0.3, 0.5), (False, 0.5, 0.5), (False, 0.75, 0.75), (False, 2.0, 1.0), (True, 0.3, 0.5), (True, 2.0, 2.0), (True, 9.0, 4.0)],
)
def test_the_forecast_follows_the_measured_convergence(spreads, slope, learned):
    """Even samples beat 1 / sqrt(N), spread ones more so; what is measured is believed within reason."""
    way = Ending(h.settings(samples=2**20, error_target=0.05 * 2**-slope, adaptive_sampling=spreads))
    for samples in (128, 256):
        error = 0.1 * samples**-slope * 128**slope
        way.following(samples, error)
    assert way.share(256 / 2**20, Reached(256, error)) == pytest.approx(0.5 ** (1 / learned))


@pytest.mark.parametrize("spreads", [False, True])
def test_rounds_look_seldom_while_the_end_is_far_and_often_when_it_is_near(spreads):
    """A picture whose error is that of independent samples, for a target at 5,000: less than 25 looks, no further than one replicate."""
    way = Ending(h.settings(samples=2**20, error_target=0.01, adaptive_sampling=spreads))
    samples, looks, error = 0, 0, math.inf
    while not way.ended_by(samples, error):
        following = way.following(samples, error)
        assert following > samples and (spreads or following % 16 == 0)
        samples, looks = following, looks + 1
        error = 0.01 * math.sqrt(5000 / samples)
    assert 5000 <= samples <= 5330
    assert looks < 25


@pytest.mark.parametrize(
    ("changes", "match"),
    [
        ({"error_target": -0.1}, "setting error_target is -0.1"),
        ({"error_target": math.nan}, "setting error_target is nan"),
        ({"time_limit": math.inf}, "setting time_limit is inf s"),
        ({"time_limit": 1.0, "adaptive_threshold": 0.1}, "need an adaptive_threshold of 0"),
    ],
    ids=str,
)
def test_what_cannot_be_is_refused_by_name(changes, match):
    with pytest.raises(SceneError, match=match):
        h.settings(**changes)
