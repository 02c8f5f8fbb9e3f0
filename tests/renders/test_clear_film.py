"""A transparent film is as clear as what it sees: alpha is the share that something covers, and the world still gives its light."""

import numpy as np
import pytest

from glanz.engine import (
    Dielectric,
    Lambert,
    Material,
    OrthographicCamera,
    PointLight,
    Transparent,
    World,
    render_image,
)
from glanz.tests import helpers as h
from glanz.tests.renders.test_costs import SETTINGS, entered, plain

INTEGRATORS = ("path", "path_naive", "distributed", "whitted", "whitted_phong")
HALF = h.grey(0.5)


def seen(objects, world=1.0, lights=(), passes=("Combined",), **changes):
    """Means over the picture {pass: (channels,)}, 2 m wide, of a camera that looks down."""
    camera = OrthographicCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0))
    scene = h.replaced(h.scene(objects, lights, camera), world=World(radiance=h.grey(world)))
    image = render_image(scene, h.settings(**{"film_transparent": True, "passes": passes, "samples": 16, **changes}))
    assert not image.warnings
    return {name: values.mean(axis=(0, 1), dtype=np.float64) for name, values in image.passes.items()}


def card(material, width=4.0, z=0.0):
    """A square card whose right edge is at x = `width` - 2."""
    return h.thing(h.quad((0.5 * width - 2, 0, z), (width, 0, 0), (0, 4, 0), name=f"card {z}"), material)


def alpha(*objects, **changes):
    return seen(objects, **changes)["Combined"][3]


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_alpha_is_the_share_that_is_covered(integrator):
    """Half of the picture, in a box filter over pixels that the edge cuts through their middle: 9 columns."""
    assert abs(alpha(card(h.lambert(0.5), 2.0), width=9, samples=64, integrator=integrator) - 0.5) <= 0.01
    assert alpha(integrator=integrator) == 0


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("how", ["alpha", "lobe"])
def test_alpha_through_two_halves_is_three_quarters(how, integrator):
    """The first by a cut-out or a lobe of which half passes, the rest black."""
    half = Material(name="half", alpha=0.5) if how == "alpha" else Material(name="half", lobes=(Transparent(HALF),))
    found = alpha(card(half, z=0.0), card(half, z=1.0), integrator=integrator, samples=4)
    # Black cut-outs and veils let all pass that goes on, so there is no noise.
    assert abs(found - 0.75) <= 1e-6


def test_alpha_is_that_of_the_mean_of_what_coloured_veils_let_pass():
    assert abs(alpha(card(Material(name="red", lobes=(Transparent((1.0, 0.5, 0.0)),)))) - 0.5) <= 1e-6


def test_glass_is_something():
    assert alpha(card(Material(name="glass", lobes=(Dielectric(),)))) == 1


@pytest.mark.parametrize("integrator", ["path", "distributed"])
def test_the_world_that_is_not_seen_lights_what_is(integrator):
    """A dull card in a white furnace is as bright as it reflects: premultiplied, 0.5 where half is covered; and passes know the world."""
    found = seen((card(h.lambert(1.0), 2.0),), passes=("Combined", "Environment"), integrator=integrator)
    np.testing.assert_allclose(found["Combined"], 0.5, atol=1e-6)
    np.testing.assert_allclose(found["Environment"], 0.5, atol=1e-6)


def test_a_black_world_is_not_seen_either():
    assert alpha(card(h.lambert(0.5), 2.0), world=0.0) == 0.5


def test_what_is_covered_is_the_same_as_before_a_film_that_is_not_transparent():
    objects, lights = (card(h.lambert((0.2, 0.5, 0.9))),), (PointLight(position=(0, 0, 1), intensity=(1.0,) * 3),)
    clear, opaque = (seen(objects, lights=lights, film_transparent=is_on)["Combined"] for is_on in (True, False))
    assert (clear == opaque).all()
    assert seen((), film_transparent=False)["Combined"][3] == 1


def test_edges_of_black_things_are_divided_too():
    """Only alpha tells them from what is clear."""
    found = seen(
        (card(Material(name="black", lobes=(Lambert(),)), 2.0),),
        world=0.0,
        passes=("Combined", "Sample Count"),
        width=9,
        samples=1,
        adaptive_threshold=0.1,
    )
    assert found["Sample Count"][0] > 2
    assert abs(found["Combined"][3] - 0.5) <= 0.01


def test_the_closed_forms_catch_a_film_that_forgets_what_veils_absorb(monkeypatch):
    def forgetful(plan, rays, hits, film):
        film.clear[0, rays.slot[hits.prim < 0]] = 1

    monkeypatch.setattr("glanz.engine.plan.stay_clear", forgetful)
    half = Material(name="half", lobes=(Transparent(HALF),))
    assert abs(alpha(card(half, z=0.0), card(half, z=1.0)) - 0.75) > 0.1


def test_a_film_that_is_not_transparent_costs_nothing():
    file = "wavefront/clear_film.py"
    assert file not in entered(plain())
    assert file in entered(plain(), h.replaced(SETTINGS, film_transparent=True))
