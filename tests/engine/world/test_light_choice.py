"""One of many lights, with the probability that is told (catalogue B9)."""

import dataclasses
import math

import numpy as np
import pytest

from glanz.engine import AreaLight, PointLight, SpotLight, SunLight
from glanz.engine.arrays import Columns
from glanz.engine.world import light_tree_choice
from glanz.engine.world.light_choice import ByPlace, ByPower, OnlyLight
from glanz.engine.world.light_tree_choice import ByTree
from glanz.tests import chance, helpers as h


def bulbs(count, power=lambda i: 1.0 + i):
    rng = np.random.default_rng(4)
    return [PointLight(name=f"{i}", position=tuple(rng.uniform(-2, 2, 3).tolist()), intensity=(power(i),) * 3) for i in range(count)]


def panels(count):
    return [h.thing(h.icosphere(0, 0.3, (i, i % 3, 1.0), name=f"{i}"), h.lambert(0, f"{i}", 1.0 + i)) for i in range(count)]


def beams(count):
    """Area lights and spots that shine to all sides, close to each other, so that groups have cones."""
    rng = np.random.default_rng(5)
    axes = [0.3 * rng.standard_normal(3) + np.array((i % 2, 0, 1)) for i in range(count)]
    places = [h.affine(h.frame_towards(axis), rng.uniform(-2, 3, 3)) for axis in axes]
    return [
        AreaLight(name=f"{i}", world_from_light=m, size_x=0.1, size_y=0.1, radiance=(9.0,) * 3)
        if i % 3
        else SpotLight(name=f"{i}", world_from_light=m, angle=0.6)
        for i, m in enumerate(places)
    ]


CHOICES = {
    "two bulbs": (bulbs(2), [], ByPlace),
    "many kinds": ([*bulbs(3), SunLight(), AreaLight(size_x=0.5)], [h.thing(h.quad((1, 1, 1)), h.lambert(0, "a", 2.0))], ByPlace),
    "one mesh": ([], panels(1), ByPlace),
    "very different powers": (bulbs(4, lambda i: 10.0 ** (4 * i - 8)), [], ByPlace),
    "beams": (beams(20), [], ByPlace),
    "50 bulbs and meshes": (bulbs(50), panels(2), ByTree),
    "1000 bulbs": (bulbs(1000, lambda i: 1.0 + i % 7), [], ByTree),
    "500 beams": (beams(500), [], ByTree),
    "a large mesh": ([], [h.thing(h.icosphere(3, 1.5, (0, 0, 1)), h.lambert(0, "a", 2.0))], ByTree),
    "a crowd with suns": ([*bulbs(100), SunLight(), SunLight(name="b", irradiance=(9.0,) * 3)], panels(3), ByTree),
    "a crowd at one place": ([h.replaced(bulb, position=(0.5, 0.5, 1.0)) for bulb in bulbs(100)], [], ByTree),
    "a crowd that gathers": ([h.replaced(bulb, position=(2.0**-i, 0, 1)) for i, bulb in enumerate(bulbs(200))], [], ByTree),
    "a crowd of very different powers": (bulbs(100, lambda i: 10.0 ** (0.6 * i - 30)), [], ByTree),
}
PLACES = ((0.1, 0.2, 0.0), (-1.5, 1.0, 0.3), (0.5, -1.9, 1.5), (30.0, 20.0, 9.0))


def choice_of(lights, objects):
    floor = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0), name="floor"))
    world = h.plan_of(h.scene([floor, *objects], lights), h.settings()).world
    return world, world.lights.choice, sum(group.count for group in world.lights.groups)


def check_choice(name, normal=None):
    lights, objects, kind = CHOICES[name]
    world, choice, count = choice_of(lights, objects)
    assert isinstance(choice, kind)
    n = chance.times(100_000)
    for seed, place in enumerate(PLACES):
        p = np.repeat(world.frame.points(np.array(place)[:, None]).astype(np.float32), n, 1)
        facing = None if normal is None else np.repeat(normal, n, 1)
        index, probability, u2 = choice.choose(p, h.uniform(seed, n, np.float32), facing)
        told = choice.probability(np.arange(count), p[:, :count], None if normal is None else facing[:, :count])
        assert told.min() > 0
        assert told.astype(float).sum() == pytest.approx(1, abs=1e-5)
        assert h.same_bits(probability, told[index])
        assert h.chi2_p(np.bincount(index, minlength=count), n * told.astype(float)) > h.ALPHA
        # What is left of the numbers is uniform, and does not know which light was chosen.
        likely = index == np.bincount(index).argmax()
        for part in (u2[:, likely], u2[:, ~likely]):
            assert part.min(initial=0) >= 0
            assert part.max(initial=0) < 1
            if part.shape[1] > 2_000:
                cells = np.histogram2d(*part, bins=8, range=((0, 1), (0, 1)))[0]
                assert h.chi2_p(cells, np.full(64, part.shape[1] / 64)) > h.ALPHA


@pytest.mark.parametrize("name", CHOICES)
@chance.fresh
def test_lights_are_chosen_with_the_probability_that_is_told(name):
    """B9: chi2 of 1e5 choices at each of 4 points; detects 4 % of a light with a tenth of the probability. Told bit for bit."""
    check_choice(name)


@pytest.mark.parametrize("name", [name for name, (_, _, kind) in CHOICES.items() if kind is ByTree])
@chance.fresh
def test_lights_are_chosen_for_surfaces_that_face_one_side(name):
    """B9 once more; lights below the horizon weigh little, but something."""
    check_choice(name, h.unit(0.3, -0.5, 0.6, dtype=np.float32))


def test_a_side_without_light_is_left_to_others():
    """Of bulbs above and below a point, those above are chosen 50 times as often, and suns are chosen on every side."""
    _, choice, count = choice_of([*bulbs(200, lambda i: 1.0), SunLight(irradiance=(50.0,) * 3)], [])
    p = np.repeat(choice.top.centre[:, :1, 0], count, 1)
    p[2] = 0
    up, down = (choice.probability(np.arange(count), p, np.repeat(h.unit(0, 0, z, dtype=np.float32), count, 1)) for z in (1, -1))
    # The last of all is the sun, for bulbs come first.
    assert up[-1] > 0.01
    assert down[-1] > 0.01
    assert up.astype(float).sum() == pytest.approx(1, abs=1e-5)
    ratio = np.sort(up[:-1] / down[:-1])
    assert ratio[0] < 1 / 4
    assert ratio[-1] > 4


def _told(cls, change):
    tell = cls.probability
    return cls, "probability", lambda self, index, p, n=None: tell(self, index, change(p), n)


def _leaf_by_index(self, p, u1, n, choose=ByTree._choose):
    index, probability, u = choose(self, p, u1, n)
    return self.rank.take(index), probability, u


MUTANTS = {
    "told for another place": ("two bulbs", _told(ByPlace, lambda p: p * np.float32(1.05))),
    "told for another place, of many": ("1000 bulbs", _told(ByTree, lambda p: p * np.float32(1.05))),
    "the order of the tree": ("1000 bulbs", (ByTree, "_choose", _leaf_by_index)),
    "always down to the end": ("a large mesh", (light_tree_choice, "_follow", lambda weights, u, place, way: (way, u * 0 + 0.25, u))),
}


@pytest.mark.parametrize("mutant", MUTANTS)
def test_telling_catches_a_probability_that_is_not_the_chosen_one(monkeypatch, mutant):
    name, patch = MUTANTS[mutant]
    monkeypatch.setattr(*patch)
    with pytest.raises(AssertionError):
        check_choice(name)


@pytest.mark.parametrize("name", ["50 bulbs and meshes", "500 beams", "a large mesh"])
def test_lanes_are_chosen_for_independently(name):
    """Batches of any size choose alike, bit for bit."""
    _, choice, _ = choice_of(*CHOICES[name][:2])
    n = 12_345
    p = np.random.default_rng(1).uniform(-2, 2, (3, n)).astype(np.float32)
    u2 = h.uniform(2, n, np.float32)
    index, probability, rest = choice.choose(p, u2.copy())
    told = choice.probability(index, p)
    for lanes in (slice(0, 1), slice(777, 778), slice(5_000, 5_003), slice(n - 1, n)):
        alone = choice.choose(np.ascontiguousarray(p[:, lanes]), u2[:, lanes].copy())
        for a, b in zip(alone, (index, probability, rest)):
            assert h.same_bits(a, b[..., lanes])
        assert h.same_bits(choice.probability(index[lanes], np.ascontiguousarray(p[:, lanes])), told[lanes])


@pytest.mark.parametrize("name", ["1000 bulbs", "500 beams", "a large mesh"])
def test_a_choice_by_tree_is_never_much_worse_than_one_by_power(name):
    """Every light keeps an eighth of its share of all power, whatever is near: the error cannot blow up."""
    world, choice, count = choice_of(*CHOICES[name][:2])
    for place in PLACES:
        p = np.repeat(world.frame.points(np.array(place)[:, None]).astype(np.float32), count, 1)
        told = choice.probability(choice.order, p)
        assert (told >= choice.by_power.share / 8).all()


def relative_error(world, choice, place):
    """Standard deviation of one shadow ray towards a middle, over the mean, on a floor without anything in the way."""
    count = world.lights.count
    p = np.repeat(world.frame.points(np.array(place)[:, None]).astype(np.float32), count, 1)
    wi, _, E, _ = world.lights.sample_middle(np.arange(count), p, np.zeros((2, count), np.float32))
    f = E[0].astype(float) * np.maximum(wi[2], 0)
    return math.sqrt((f**2 / choice.probability(np.arange(count), p)).sum() / f.sum() ** 2 - 1)


def test_a_thousand_lights_are_chosen_nearly_as_well_as_by_weighing_all():
    """Bulbs close above a floor: a third of the error of a choice by power, on average over 50 places, at most twice the best."""
    rng = np.random.default_rng(6)
    lights = [PointLight(name=f"{i}", position=(*rng.uniform(-2, 2, 2), rng.uniform(0.1, 1))) for i in range(1000)]
    world, choice, _ = choice_of(lights, [])
    every = ByPlace.of(Columns(**{n: np.array([x.weight(world.frame)[n] for x in lights], float).T for n in lights[0].weight(world.frame)}))
    every = h.replaced(every, table=Columns(**{**vars(every.table), "power": every.table.power[0]}))
    errors = {}
    for name, way in (("tree", choice), ("power", ByPower.of(np.ones(1000))), ("all", every)):
        errors[name] = np.mean([relative_error(world, way, (*rng.uniform(-1.9, 1.9, 2), 0.0)) for _ in range(50)])
    assert errors["tree"] < errors["power"] / 3
    assert errors["tree"] < 2 * errors["all"]


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


@pytest.mark.parametrize(("count", "kind"), [(2, ByPlace), (100, ByTree)])
def test_lights_without_power_are_never_chosen(count, kind):
    dark = PointLight(name="dark", intensity=(0.0,) * 3)
    _, choice, kept = choice_of([dark, *bulbs(count), h.replaced(dark, name="dark 2")], [])
    assert kept == count
    assert isinstance(choice, kind)


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


def test_a_lamp_beyond_all_numbers_leaves_the_others_a_choice():
    """Found by chance: a patch that moves away further than numbers go has an infinite power, and beside it none had any."""
    world, _, _ = choice_of([], panels(3))
    emitters = world.emitters
    for beyond in (np.inf, np.nan):
        k = dataclasses.replace(emitters, k=Columns(**{name: np.array(column) for name, column in vars(emitters.k).items()}))
        k.k.area[5] = beyond
        choice = ByTree.of(k.power(), k.weights())
        p = np.zeros((3, 10_000), np.float32)
        index, probability, u2 = choice.choose(p, h.uniform(1, 10_000, np.float32))
        assert np.isfinite(probability).all()
        assert np.isfinite(u2).all()
        assert len(np.unique(index)) > emitters.count // 2
        assert (index == 5).mean() < 1e-2
