"""Of many lamps those are found that rays run into: no more are asked than need be, and none is missed."""

import numpy as np
import pytest

from glanz.engine import AreaLight, PointLight, SpotLight, SunLight
from glanz.engine.world import lamp_search
from glanz.engine.world.lamp_search import MOST_ASKED, EachLamp, LampTree
from glanz.tests import helpers as h

N = 5_000


def lamps(count, seed=1):
    rng = np.random.default_rng(seed)
    made = []
    for i in range(count):
        place, size = rng.uniform(-2, 2, 3), 10.0 ** rng.uniform(-3, -0.3)
        made.append(
            (
                lambda i, place, size: PointLight(name=f"{i}", position=tuple(place), radius=size),
                lambda i, place, size: PointLight(name=f"{i}", position=tuple(place), radius=size, soft_falloff=False),
                lambda i, place, size: SpotLight(name=f"{i}", world_from_light=h.affine(translation=place), radius=size, angle=3.0),
                lambda i, place, size: AreaLight(name=f"{i}", world_from_light=h.affine(h.rotation(i), place), size_x=size),
            )[i % 4](i, place, size)
        )
    return made


def found(search, o, d):
    """{(lamp, lane)} of all that are met."""
    pairs = set()
    asked = 0
    for lamp, lanes in search.along(o, d, None):
        lanes = np.arange(o.shape[1]) if lanes is None else lanes
        asked += lanes.size
        t = lamp.light.hit(lamp.k, o.take(lanes, axis=1), d.take(lanes, axis=1))[0]
        pairs |= {(lamp.index, int(lane)) for lane in lanes[np.isfinite(np.broadcast_to(t, lanes.shape))]}
    return pairs, asked


def searches(lights):
    hittable = h.plan_of(h.scene(lights=lights), h.settings()).world.lights.hittable
    assert isinstance(hittable, LampTree)
    return hittable, EachLamp((*hittable.everywhere.lamps, *hittable.lamps))


def check_nothing_is_missed(count, suns=0):
    lights = [*lamps(count), *(SunLight(name=f"sun {i}", angle=0.5 + i, towards=tuple(h.directions(i, 1)[:, 0])) for i in range(suns))]
    tree, each = searches(lights)
    rng = np.random.default_rng(2)
    scale = np.abs(tree.centre).max()
    o, d = rng.uniform(-scale, scale, (3, N)).astype(np.float32), h.directions(3, N, np.float32)
    # Towards the rim of lamps too, from near and far, from inside of them, and along the axes.
    lamp = rng.integers(0, len(tree.lamps), N)
    centre = np.array([x.centre for x in tree.lamps]).T[:, lamp]
    aimed = np.arange(N) % 3 == 0
    rim = centre + 0.999 * np.array([x.radius for x in tree.lamps])[lamp] * h.directions(4, N)
    d[:, aimed] = ((rim - o) / np.linalg.norm(rim - o, axis=0))[:, aimed]
    d[:, :6] = np.concatenate((np.eye(3), -np.eye(3)), axis=1)
    o[:, 6:500] = centre[:, 6:500]
    met, asked = found(tree, o, d)
    truth, every = found(each, o, d)
    assert len(truth) > 100
    assert met == truth
    assert asked < 0.2 * every
    return asked / every


@pytest.mark.parametrize("count", [MOST_ASKED + 1, 300])
@pytest.mark.parametrize("suns", [0, 2])
def test_all_that_are_met_are_found(count, suns):
    check_nothing_is_missed(count, suns)


def test_lamps_at_one_place_are_all_found():
    tree, each = searches([PointLight(name=f"{i}", position=(0, 0, 1), radius=0.5) for i in range(50)])
    o, d = tree.centre[:1].T - np.float32([[0], [0], [1]]), h.unit(0, 0, 1, dtype=np.float32)
    assert found(tree, o, d)[0] == found(each, o, d)[0]
    assert len(found(tree, o, d)[0]) == 50


def test_finding_catches_spheres_that_are_too_small(monkeypatch):
    passes = LampTree._passes
    monkeypatch.setattr(LampTree, "_passes", lambda self, node, o, d: passes(h.replaced(self, radius=0.9 * self.radius), node, o, d))
    with pytest.raises(AssertionError):
        check_nothing_is_missed(300)


def test_few_are_all_asked_and_many_suns_too():
    assert isinstance(lamp_search.search_of(()), EachLamp)
    few = h.plan_of(h.scene(lights=lamps(MOST_ASKED)), h.settings()).world.lights
    assert isinstance(few.hittable, EachLamp)
    assert not few.few_sharp
    suns = [SunLight(name=f"{i}", angle=0.1) for i in range(40)]
    assert isinstance(h.plan_of(h.scene(lights=suns), h.settings()).world.lights.hittable, EachLamp)


def test_lamps_that_the_camera_does_not_see_are_met_by_others_only():
    lights = [h.replaced(lamp, is_visible=i < 3) for i, lamp in enumerate(lamps(40))]
    compiled = h.plan_of(h.scene(lights=lights), h.settings()).world.lights
    assert len(compiled.visible.lamps) == 3
    assert len(compiled.hittable.lamps) == 40
