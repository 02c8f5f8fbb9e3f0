"""One of many lights, with the probability that is told (catalogue B9)."""

import numpy as np
import pytest

from glanz.engine import AreaLight, PointLight, SunLight
from glanz.engine.world.light_choice import ByPlace, ByPower, OnlyLight
from glanz.tests import helpers as h


def bulbs(count, power=lambda i: 1.0 + i):
    rng = np.random.default_rng(4)
    return [PointLight(name=f"{i}", position=tuple(rng.uniform(-2, 2, 3).tolist()), intensity=(power(i),) * 3) for i in range(count)]


def panels(count):
    return [h.thing(h.icosphere(0, 0.3, (i, i % 3, 1.0), name=f"{i}"), h.lambert(0, f"{i}", 1.0 + i)) for i in range(count)]


CHOICES = {
    "two bulbs": (bulbs(2), [], ByPlace),
    "many kinds": ([*bulbs(3), SunLight(), AreaLight(size_x=0.5)], panels(3), ByPlace),
    "one mesh": ([], panels(1), ByPower),
    "more than can be weighed": (bulbs(50), panels(2), ByPower),
    "very different powers": (bulbs(4, lambda i: 10.0 ** (4 * i - 8)), [], ByPlace),
}


def choice_of(lights, objects):
    floor = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0), name="floor"))
    world = h.plan_of(h.scene([floor, *objects], lights), h.settings()).world
    return world, world.lights.choice, sum(group.count for group in world.lights.groups)


@pytest.mark.parametrize("name", CHOICES)
def test_lights_are_chosen_with_the_probability_that_is_told(name):
    """chi2 of 2e5 choices at each of 3 points; detects 3 % of a light with a tenth of the probability."""
    lights, objects, kind = CHOICES[name]
    world, choice, count = choice_of(lights, objects)
    assert isinstance(choice, kind)
    n = 200_000
    for seed, place in enumerate(((0.1, 0.2, 0.0), (-1.5, 1.0, 0.3), (0.5, -1.9, 1.5))):
        p = np.repeat(world.frame.points(np.array(place)[:, None]).astype(np.float32), n, 1)
        index, probability, u2 = choice.choose(p, h.uniform(seed, n, np.float32))
        told = np.array([choice.probability(np.full(1, i), p[:, :1])[0] for i in range(count)], np.float64)
        assert told.sum() == pytest.approx(1, abs=1e-5)
        np.testing.assert_allclose(probability, told[index], rtol=1e-4)
        assert h.chi2_p(np.bincount(index, minlength=count), n * told) > h.ALPHA
        # What is left of the numbers is uniform, and does not know which light was chosen.
        likely = index == np.bincount(index).argmax()
        for part in (u2[:, likely], u2[:, ~likely]):
            assert part.min() >= 0
            assert part.max() < 1
            if part.shape[1] > 2_000:
                cells = np.histogram2d(*part, bins=8, range=((0, 1), (0, 1)))[0]
                assert h.chi2_p(cells, np.full(64, part.shape[1] / 64)) > h.ALPHA


def test_telling_catches_a_probability_that_is_not_the_chosen_one(monkeypatch):
    tell = ByPlace.probability
    monkeypatch.setattr(ByPlace, "probability", lambda self, index, p: tell(self, index, p * np.float32(1.05)))
    with pytest.raises(AssertionError):
        test_lights_are_chosen_with_the_probability_that_is_told("two bulbs")


def test_nearer_lights_are_chosen_more_often():
    lights = [PointLight(name=n, position=(x, 0.0, 1.0)) for n, x in (("left", -1.5), ("right", 1.5))]
    world, choice, _ = choice_of(lights, [])
    p = world.frame.points(np.array([[-1.5, 1.5], [0, 0], [0, 0]])).astype(np.float32)
    left = choice.probability(np.zeros(2, np.intp), p)
    assert left[0] == pytest.approx(10 / 11, rel=1e-3)
    assert left[1] == pytest.approx(1 / 11, rel=1e-3)


def test_one_light_is_no_choice_and_spends_no_number():
    world, choice, _ = choice_of(bulbs(1), [])
    assert isinstance(choice, OnlyLight)
    u2 = h.uniform(1, 5, np.float32)
    index, probability, left = choice.choose(np.zeros((3, 5), np.float32), u2.copy())
    assert index is None
    assert probability == 1
    assert h.same_bits(left, u2)
    assert world.lights.sample(None, np.zeros((3, 5), np.float32), u2)[1].shape == (5,)


def test_lights_without_power_are_never_chosen():
    dark = PointLight(name="dark", intensity=(0.0,) * 3)
    _, choice, count = choice_of([dark, *bulbs(2), h.replaced(dark, name="dark 2")], [])
    assert count == 2
    assert isinstance(choice, ByPlace)


def test_a_weak_light_is_found_beside_one_that_outshines_it():
    """1e-4 m from a bulb, hidden or not, a lamp of a 1e-10 of its weight there still gets 1 of 1,100 shadow rays."""
    lights = (PointLight(position=(0, 0, 1e-4), intensity=(1, 1, 1)), PointLight(position=(0, 0, 10), intensity=(1, 1, 1)))
    choice = h.plan_of(h.scene([h.thing(h.quad(), h.lambert(0.5))], lights), h.settings()).world.lights.choice
    n = 100_000
    index, probability, _ = choice.choose(np.zeros((3, n), np.float32) + choice.table.centre[:, 0], h.uniform(1, n, np.float32))
    assert np.isfinite(probability).all()
    weak = index == np.argmin(np.bincount(index, minlength=2))
    assert h.mean_is(weak, 2.0**-10 / (1 + 2.0**-10), floor=1e-6)
    np.testing.assert_allclose(probability[weak], 2.0**-10 / (1 + 2.0**-10), rtol=1e-5)
