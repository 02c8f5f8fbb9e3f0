"""What every integrator promises (`interfaces.Integrator`), checked for every class in the registry."""

import inspect

import numpy as np
import pytest

from glanz.engine import AreaLight, Dielectric, Lambert, Material, Mirror, PerspectiveCamera, Phong, PointLight, render_image
from glanz.engine.integrators.path import Path
from glanz.engine.interfaces import Integrator
from glanz.engine.registry import INTEGRATORS
from glanz.engine.scene.validate import validate
from glanz.engine.world.accel import Accel
from glanz.tests import chance, helpers as h, scenes

each = pytest.mark.parametrize("integrator", INTEGRATORS.values(), ids=lambda i: i.key)
UNPHYSICAL = [INTEGRATORS["whitted_phong"]]
SHARED = {"distributed": 4}
"""Integrators that need so many times fewer samples."""
COMPLETE = [i for i in INTEGRATORS.values() if i.is_complete]
each_complete = pytest.mark.parametrize("integrator", COMPLETE, ids=lambda i: i.key)
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


@each_complete
@chance.fresh
def test_an_integrator_fills_the_furnace(integrator):
    """Detects 1 %."""
    check_furnace(integrator)


@pytest.mark.parametrize("integrator", [i for i in INTEGRATORS.values() if i.samples_lights and i not in UNPHYSICAL], ids=lambda i: i.key)
def test_direct_light_of_a_point_is_exact(integrator):
    """With depth 0 and lights without a size nothing is left to chance."""
    scene = h.receiver([PointLight(position=(1.0, 2.0, 2.0), intensity=(9.0,) * 3)])
    image = h.pixels(scene, h.settings(max_depth=0, integrator=integrator.key))
    np.testing.assert_allclose(image, 2 / 3 / np.pi, rtol=1e-5)


def check_same_light(integrator):
    """A lamp, a ball of metal and glass in a bright room: the picture is as bright as that of 400 other paths per pixel.

    With these seeds the means differ by at most 0.16 %; 0.6 % is allowed.
    """
    lobes = (Lambert((0.3,) * 3), Phong((0.2,) * 3, 5.0), Mirror((0.2,) * 3), Dielectric(1.5, (0.3,) * 3, (0.3,) * 3))
    ball = h.thing(h.icosphere(2, 0.3, (0, 0, 0), smooth=True), Material(name="ball", lobes=lobes))
    room = h.thing(h.box((-1, -1, -1), (1, 1, 1)), h.lambert(0.5, emission=0.2))
    lamp = AreaLight(world_from_light=h.affine(np.eye(3), (0.2, 0.3, 0.9)), size_x=0.6, size_y=0.5, radiance=(3.0,) * 3)
    scene = h.scene([ball, room], [lamp], camera=PerspectiveCamera.look_at((0.1, -0.9, 0.1), (0, 0, 0), fov=1.2))
    settings = h.settings(width=24, height=24, samples=64, max_depth=4, sampler="random")
    truth = h.pixels(scene, h.replaced(settings, samples=400, seed=9))[0].mean()
    image = h.pixels(scene, h.replaced(settings, integrator=integrator.key, samples=400 // SHARED.get(integrator.key, 1), branches=8))[0]
    assert abs(image.mean() / truth - 1) <= 0.006


@each_complete
@chance.fresh
def test_all_integrators_find_the_same_light_as_path_tracing(integrator):
    check_same_light(integrator)


@pytest.mark.parametrize("integrator", [i for i in COMPLETE if i is not Path], ids=lambda i: i.key)
def test_the_comparison_catches_one_percent_at_every_bounce(integrator, monkeypatch):
    scatter = integrator.scatter

    def brighter(plan, rays, surface, reflection):
        for scattered in scatter(plan, rays, surface, reflection):
            scattered.beta[...] *= np.float32(1.01)
            yield scattered

    monkeypatch.setattr(integrator, "scatter", staticmethod(brighter))
    with pytest.raises(AssertionError):
        check_same_light(integrator)


def test_blind_integrators_name_the_lights_that_stay_dark():
    scene = h.receiver([PointLight(name="Bulb", position=(1.0, 2.0, 2.0))])
    for integrator in INTEGRATORS.values():
        _, warnings = validate(scene, h.settings(integrator=integrator.key))
        assert [w for w in warnings if "stays dark: light 'Bulb'" in w] == list(warnings)
        assert bool(warnings) != integrator.samples_lights


@pytest.mark.parametrize("integrator", [i for i in INTEGRATORS.values() if not i.samples_lights], ids=lambda i: i.key)
def test_without_shadow_rays_none_is_sent(monkeypatch, integrator):
    occluded = h.spy(monkeypatch, Accel, "occluded")
    render_image(scenes.everything(), h.settings(integrator=integrator.key, max_depth=3))
    assert not occluded


@each
def test_an_integrator_does_not_depend_on_threads_or_tiles(integrator):
    settings = h.settings(width=16, integrator=integrator.key, max_depth=3)
    everything = scenes.everything()
    images = [render_image(everything, h.replaced(settings, threads=n, tile_size=t)).passes["Combined"] for n, t in ((1, 0), (2, 3))]
    assert h.same_bits(*images)


def test_the_furnace_catches_a_lost_path_in_a_hundred(monkeypatch):
    scatter = Path.scatter

    def lossy(plan, rays, surface, reflection):
        (scattered,) = scatter(plan, rays, surface, reflection)
        return (scattered.take(np.nonzero(scattered.sample % 16)[0]),)

    monkeypatch.setattr(Path, "scatter", staticmethod(lossy))
    with pytest.raises(AssertionError):
        check_furnace(Path)
