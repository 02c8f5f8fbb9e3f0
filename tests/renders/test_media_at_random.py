"""Heaps of overlapping bodies: whatever they are, even light stays even, and no bit depends on how the work is cut."""

import numpy as np
import pytest

from glanz.engine import Dielectric, Material, Medium, PerspectiveCamera, rendering
from glanz.engine.wavefront import media
from glanz.tests import chance, helpers as h

OUTSIDE = PerspectiveCamera.look_at((0.1, -4, 0.3), (0, 0, 0), fov=0.5)


def heap(seed, count=7, absorption=0.0, abbe=float("inf")):
    """(objects, [(contains, priority, volume, ior)]): balls and boxes of random media across each other."""
    rng = np.random.default_rng(seed)
    things, bodies = [], []
    for i in range(count):
        ior, priority = float(rng.choice([1.0, 1.2, 1.33, 1.5, 1.8])), int(rng.integers(-1, 2))
        material = Material(
            name=f"{i}", lobes=(Dielectric(ior, abbe=abbe),), medium=Medium(priority=priority, absorption=h.grey(absorption * i))
        )
        centre, half = rng.uniform(-0.5, 0.5, 3), rng.uniform(0.3, 0.8, 3)
        low, high = centre - half, centre + half
        things.append(h.thing(h.box(low, high, name=f"{i}"), material))
        bodies.append((lambda p, low=low, high=high: ((p > low) & (p < high)).all(), priority, np.prod(high - low), ior))
    return things, bodies


def index_at(p, bodies):
    """The index of refraction at p, by looking into every box: the highest priority, of equal ones the smallest."""
    found = [(-priority, volume, ior) for contains, priority, volume, ior in bodies if contains(np.array(p))]
    return min(found)[2] if found else 1.0


def even_light(seed, camera, expected, **settings):
    things, _ = heap(seed)
    settings = h.settings(**{"width": 32, "height": 32, "samples": 64, "max_depth": 400} | settings)
    # Total reflection keeps one path of a thousand between parallel faces for all bounces.
    return h.mean_is(h.pixels(h.scene(things, camera=camera, world=1.0), settings)[1].ravel(), expected, floor=2e-3)


@pytest.mark.parametrize("seed", range(6))
@chance.fresh
def test_any_heap_of_bodies_is_as_bright_as_what_surrounds_it(seed):
    """D18 with media in media; detects 1.5 %. What comes from outside leaves again, whatever the boxes."""
    assert even_light(chance.seeded(seed), OUTSIDE, 1.0)


@pytest.mark.parametrize("seed", range(6))
@chance.fresh
def test_from_inside_of_a_medium_the_same_light_is_brighter_by_its_index_squared(seed):
    """Wherever the camera is in the heap: it has to know its medium, and paths have to come out of all of them.

    These heaps and views are chosen: of an index above the root of 2 a box keeps some of the directions in it for ever.
    """
    eye = np.random.default_rng(seed + 100).uniform(-0.4, 0.4, 3)
    camera = PerspectiveCamera.look_at(eye, eye + np.array((0.3, 1.0, 0.2)), fov=1.5)
    assert even_light(seed, camera, index_at(eye, heap(seed)[1]) ** 2)


def test_even_light_catches_boundaries_that_are_counted_wrongly(monkeypatch):
    """A mutant that forgets which bodies it has left: something of it is seen in most heaps."""
    cross = media._cross

    def forgetful(inside, lanes, row, is_front):
        cross(inside, lanes, row, is_front | True)

    monkeypatch.setattr(media, "_cross", forgetful)
    assert not all(even_light(seed, OUTSIDE, 1.0) for seed in range(4))


def test_how_the_work_is_cut_changes_no_bit(monkeypatch):
    """H3 with absorption, media in media and dispersion: threads, tiles and batches."""
    scene = h.scene(heap(3, 5, absorption=0.2, abbe=20.0)[0], camera=OUTSIDE, world=1.0)
    settings = h.settings(width=16, height=12, samples=4, max_depth=12)
    reference = h.pixels(scene, settings)
    assert h.same_bits(h.pixels(scene, h.replaced(settings, threads=2, tile_size=5)), reference)
    monkeypatch.setattr(rendering, "LANES", 37)
    assert h.same_bits(h.pixels(scene, settings), reference)
