"""What every integrator promises (`interfaces.Integrator`), checked for every class in the registry."""

import inspect

import numpy as np
import pytest

from glanz.engine import PerspectiveCamera, PointLight
from glanz.engine.integrators.path import Path
from glanz.engine.interfaces import Integrator
from glanz.engine.registry import INTEGRATORS
from glanz.tests import helpers as h, scenes

each = pytest.mark.parametrize("integrator", INTEGRATORS.values(), ids=lambda i: i.key)
INSIDE = PerspectiveCamera.look_at((0.3, 0.4, 0.5), (0.9, 0.8, 0.2))


def furnace(r, emission=1.0):
    return h.scene([h.thing(h.box(), h.lambert(r, emission=emission))], camera=INSIDE)


def check_furnace(integrator):
    """A closed mesh that emits 1 and reflects 0.6: 1 + 0.6 + ... after as many bounces as asked for."""
    for depth in (0, 1, 3):
        image = h.pixels(furnace(0.6), h.settings(width=16, height=16, samples=49, max_depth=depth, integrator=integrator.key))
        assert h.mean_is(image[0], sum(0.6**k for k in range(depth + 2)), floor=1e-5), depth


@each
def test_an_integrator_offers_the_interface(integrator):
    assert isinstance(integrator, Integrator)
    assert INTEGRATORS[integrator.key] is integrator
    assert inspect.getdoc(integrator)


@each
def test_an_integrator_fills_the_furnace(integrator):
    """Detects 1 %."""
    check_furnace(integrator)


@each
def test_direct_light_of_a_point_is_exact(integrator):
    """With depth 0 and lights without a size nothing is left to chance."""
    scene = h.receiver([PointLight(position=(1.0, 2.0, 2.0), intensity=(9.0,) * 3)])
    image = h.pixels(scene, h.settings(max_depth=0, integrator=integrator.key))
    np.testing.assert_allclose(image, 2 / 3 / np.pi, rtol=1e-5)


@each
def test_an_integrator_does_not_depend_on_threads_or_tiles(integrator):
    settings = h.settings(width=16, integrator=integrator.key, max_depth=3)
    images = [h.pixels(scenes.everything(), h.replaced(settings, threads=n, tile_size=t)) for n, t in ((1, 0), (2, 3))]
    assert h.same_bits(*images)


def test_the_furnace_catches_a_lost_path_in_a_hundred(monkeypatch):
    scatter = Path.scatter

    def lossy(plan, rays, surface, reflection):
        (scattered,) = scatter(plan, rays, surface, reflection)
        return (scattered.take(np.nonzero(scattered.sample % 16)[0]),)

    monkeypatch.setattr(Path, "scatter", staticmethod(lossy))
    with pytest.raises(AssertionError):
        check_furnace(Path)
