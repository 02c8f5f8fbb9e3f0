"""Mirrors and glass in whole pictures (catalogue D9, D18, F2, F5)."""

import numpy as np
import pytest

from glanz.engine import Dielectric, Lambert, Material, Mirror, PerspectiveCamera, render_image
from glanz.engine.bsdfs import dielectric
from glanz.engine.wavefront import continuation
from glanz.tests import chance, helpers as h

CAMERA = PerspectiveCamera.look_at((0.1, -4, 0.3), (0, 0, 0), fov=0.6)


def seen(lobes, smooth, samples=64, **settings):
    """A sphere of `lobes` in even radiance 1: (48, 48, 3)."""
    sphere = h.thing(h.icosphere(3, smooth=smooth), Material(name="sphere", lobes=lobes))
    scene = h.scene([sphere], camera=CAMERA, world=1.0)
    settings = h.settings(**{"width": 48, "height": 48, "samples": samples, "max_depth": 200} | settings)
    return render_image(scene, settings).passes["Combined"][..., :3]


@pytest.mark.parametrize("smooth", [False, True])
@pytest.mark.parametrize("lobes", [(Mirror(),), (Dielectric(1.0),), (Dielectric(1 + 1e-12),)], ids=["mirror", "ior 1", "ior 1 + 1e-12"])
def test_what_loses_nothing_cannot_be_seen_in_even_light(lobes, smooth):
    """F2, D6: not one sample is off, also where shading normals point through the surface."""
    assert np.abs(seen(lobes, smooth) - 1).max() <= 1e-6


@pytest.mark.parametrize("smooth", [False, True])
@pytest.mark.parametrize("ior", [1 / 1.5, 1.5, 2.42])
@chance.fresh
def test_glass_is_as_bright_as_what_surrounds_it(ior, smooth):
    """D18: radiance is scaled by eta^2 on the way in and back on the way out; detects 1.5 %, as some paths are inside for 200 bounces."""
    image = seen((Dielectric(ior),), smooth)
    assert h.mean_is(image.mean(axis=2).reshape(-1), 1.0, floor=5e-3)
    assert not h.mean_is(1.015 * image.mean(axis=2).reshape(-1), 1.0, floor=5e-3)


@pytest.mark.parametrize("ior", [1 / 1.5, 1.5, 2.42])
def test_roulette_ends_no_path_in_glass_that_loses_nothing(ior):
    """What radiance loses on the way in it wins on the way out, and so no path weighs more or less than another: there is no noise."""
    assert np.abs(seen((Dielectric(ior),), smooth=False, samples=16, max_depth=2000) - 1).max() <= 1e-4


def test_even_light_catches_roulette_that_takes_the_index_for_a_loss(monkeypatch):
    monkeypatch.setattr(continuation, "SQUEEZE", "")
    with pytest.raises(AssertionError):
        test_roulette_ends_no_path_in_glass_that_loses_nothing(2.42)


@pytest.mark.parametrize(("ior", "floor"), [(0.1, 2e-4), (1.01, 2e-4), (10.0, 1e-2)])
def test_glass_of_extreme_indices_is_as_bright_as_what_surrounds_it(ior, floor):
    """D18, without shading normals, which can keep light of a nearly invisible ball in circles; detects 0.02 %.

    At 10, where some paths are inside for 2,000 bounces, 1 %.
    """
    image = seen((Dielectric(ior),), smooth=False, samples=16, max_depth=2000)
    assert h.mean_is(image.mean(axis=2).reshape(-1), 1.0, floor)


@chance.fresh
def test_lobes_of_every_kind_share_the_light():
    mixed = (Lambert((0.5,) * 3), Mirror((0.25,) * 3), Dielectric(1.5, (0.25,) * 3, (0.25,) * 3))
    # Shading normals keep some paths inside for all of the 200 bounces.
    assert h.mean_is(seen(mixed, True).mean(axis=2).reshape(-1), 1.0, floor=1e-3)


def test_the_furnace_catches_radiance_that_is_not_scaled_on_one_side(monkeypatch):
    original = Dielectric.scatter

    def one_sided(k, n, wo, is_front, u1):
        wi, weight = original(k, n, wo, is_front, u1)
        return wi, np.where(is_front | ((n * wi).sum(axis=0) > 0), weight, k.transmittance)

    monkeypatch.setattr(dielectric.Dielectric, "scatter", staticmethod(one_sided))
    assert not h.mean_is(seen((Dielectric(1.5),), False).mean(axis=2).reshape(-1), 1.0, floor=1e-6)


@pytest.mark.parametrize(("depth", "expected"), [(1, 0.9216), (3, 0.92307456), (50, 12 / 13)])
@chance.fresh
def test_a_slab_of_glass_passes_what_its_round_trips_add_up_to(depth, expected):
    """D9: T = (1 - R)^2 (1 + R^2 + ...), in the limit 2 n / (n^2 + 1); detects 0.4 %."""
    slab = h.thing(h.box((-50, -50, 0), (50, 50, 1)), Material(name="slab", lobes=(Dielectric(1.5),)))
    glow = h.thing(h.quad((0, 0, -3), (900, 0, 0), (0, 900, 0)), Material(name="glow", emission=(1.0, 1.0, 1.0)))
    camera = PerspectiveCamera.look_at((0, 0, 5), (0, 0, 0), up=(0, 1, 0), fov=1e-3)
    settings = h.settings(width=16, height=16, samples=1024, max_depth=depth, sampler="random")
    image = render_image(h.scene([slab, glow], camera=camera), settings).passes["Combined"][..., 0]
    assert h.mean_is(image.reshape(-1), expected, floor=1e-6)


@chance.fresh
def test_a_slab_at_45_degrees_passes_the_mean_of_both_polarisations():
    """D11: (1 - R) / (1 + R) with R = .050239911, .904326791: light is unpolarised at every boundary; detects 0.5 %."""
    slab = h.thing(h.box((-50, -50, 0), (50, 50, 1)), Material(name="slab", lobes=(Dielectric(1.5),)))
    glow = h.thing(h.quad((0, 0, -3), (900, 0, 0), (0, 900, 0)), Material(name="glow", emission=(1.0, 1.0, 1.0)))
    camera = PerspectiveCamera.look_at((5, 0.1, 6), (0, 0.1, 1), up=(0, 1, 0), fov=1e-4)
    settings = h.settings(width=16, height=16, samples=1024, max_depth=50, sampler="random")
    image = render_image(h.scene([slab, glow], camera=camera), settings).passes["Combined"][..., 0]
    assert h.mean_is(image.reshape(-1), 0.904326791, floor=1e-6)


def test_slabs_catch_a_fresnel_that_is_a_tenth_off(monkeypatch):
    """D9, D11: by Schlick's approximation, at 45 degrees, and by 1 % less of the refracted light straight on."""
    r0 = 0.04
    monkeypatch.setattr(dielectric, "fresnel_dielectric", lambda cos_i, eta: np.float32(r0) + np.float32(1 - r0) * (1 - cos_i) ** 5)
    with pytest.raises(AssertionError):
        test_a_slab_at_45_degrees_passes_the_mean_of_both_polarisations()
    monkeypatch.setattr(dielectric, "fresnel_dielectric", lambda cos_i, eta: np.full_like(cos_i, 0.05))
    with pytest.raises(AssertionError):
        test_a_slab_of_glass_passes_what_its_round_trips_add_up_to(50, 12 / 13)


def test_light_reflected_a_thousand_times_between_mirrors_is_the_power_of_the_reflectance(monkeypatch):
    """F5: .999^1000 = .367695 of what glows at the end, to the rounding of 1,000 float32 products."""
    monkeypatch.setattr(continuation, "ROULETTE_DEPTH", 10**6)
    mirror = Material(name="mirror", lobes=(Mirror((0.999,) * 3),))
    # A ray that starts in the middle at 45 degrees climbs as far as the gap is wide: 1,000 m of mirror reflect it 1,000 times.
    walls = [h.thing(h.quad((x, 0, 500), (0, 9, 0), (0, 0, 1000)), mirror) for x in (-0.5, 0.5)]
    camera = PerspectiveCamera.look_at((0, 0, 0.25), (1, 0, 1.25), up=(0, 1, 0), fov=1e-7)
    image = render_image(h.scene(walls, camera=camera, world=1.0), h.settings(width=2, height=2, samples=1, max_depth=2000))
    assert image.passes["Combined"][..., 0] == pytest.approx(0.999**1000, rel=1e-4)
