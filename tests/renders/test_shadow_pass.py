"""The Shadow pass against closed forms: irradiance with what is in the way over that without, in each channel.

Each picture is 8 x 8 pixels that see one point. Where no random number matters every pixel must be right to float32, else
their mean, by Student's t at 1e-6.
"""

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    Dielectric,
    EnvironmentMap,
    Lambert,
    LambertTransmission,
    Material,
    Mirror,
    PerspectiveCamera,
    Phong,
    PointLight,
    SunLight,
    Transparent,
    World,
    render_image,
)
from glanz.engine.integrators.path import Path
from glanz.engine.passes import shadow
from glanz.engine.registry import INTEGRATORS
from glanz.engine.wavefront.direct import to_one_light
from glanz.tests import helpers as h
from glanz.tests.polygons import polygon_irradiance

HEIGHT, LOW = 0.8, 0.4
PANEL = AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, HEIGHT)), size_x=2.0, size_y=2.0)
RED = PointLight(position=(-1.0, 0.0, 1.0), intensity=(4.0, 0.0, 0.0))
WHITE = PointLight(position=(1.0, 0.0, 1.0), intensity=(1.0, 1.0, 1.0))
TINT = (0.2, 0.5, 0.9)
GREY = (0.5,) * 3


def shadows(scene, samples=16, **changes):
    """(64, 3) float64, what pixels say."""
    image = render_image(scene, h.settings(**{"passes": ("Shadow",), "samples": samples, "max_depth": 0} | changes))
    return image.passes["Shadow"].reshape(-1, 3).astype(np.float64)


def is_everywhere(found, expected, rtol=1e-5):
    np.testing.assert_allclose(found, np.broadcast_to(expected, found.shape), rtol=rtol)


def half_plane(material=None, z=LOW, x=0.0):
    """A sheet over everything up to `x`."""
    return h.thing(h.quad((x - 50, 0, z), (100, 0, 0), (0, 100, 0), name=f"sheet {z}"), material or h.lambert(0.5))


def over(material, **changes):
    """A sheet over everything; what it says of a point below."""
    return h.receiver([WHITE], [half_plane(h.replaced(material, **changes), x=50)], distance=0.2)


def penumbra(x):
    """The share of the panel's irradiance at (x, 0, 0) that passes the edge at (0, LOW), seen through it from `x` on."""

    def irradiance(least):
        return polygon_irradiance([(least, -1, HEIGHT), (1, -1, HEIGHT), (1, 1, HEIGHT), (least, 1, HEIGHT)], (x, 0, 0), (0, 0, 1))

    return irradiance(min(max(-1, x - x * HEIGHT / LOW), 1)) / irradiance(-1)


def assert_penumbra(material=None, light=(PANEL, ()), **changes):
    """Detects 1 % where half of the panel, which shines most from overhead, is hidden from below its left part."""
    lamps, objects = (light[0],) if light[0] else (), light[1]
    for x in (-0.5, 0.0, 0.25, 0.75):
        point = (x, 0, 0)
        scene = h.receiver(lamps, [half_plane(), *objects], point=point, distance=0.1, material=material)
        found = shadows(scene, **{"samples": 256, **changes})[:, 1]
        assert h.mean_is(found, penumbra(x), floor=1e-3)
        assert found.std() <= 0.1


def test_the_closed_form_is_no_share_of_the_area():
    """Or it would not tell what is weighed from what is counted."""
    assert abs(penumbra(0.0) - 0.5) < 1e-12
    assert penumbra(0.25) - 0.625 > 0.04


@pytest.mark.parametrize("integrator", ["path", "distributed", "path_blind"])
def test_penumbras_are_those_of_the_closed_form(integrator):
    assert_penumbra(integrator=integrator, samples=64 if integrator == "distributed" else 256)


def test_penumbras_do_not_depend_on_how_the_surface_reflects():
    assert_penumbra(Material(name="shiny", lobes=(Lambert((0.5, 0.0, 0.1)), Phong(GREY, 5.0))))


def test_glowing_meshes_have_penumbras():
    glow = h.thing(h.quad((0, 0, HEIGHT), (2, 0, 0), (0, -2, 0), name="glow"), h.lambert(0, "glow", 3.0))
    assert_penumbra(light=(None, (glow,)))


def of_equal_weight(plan, rays, surface):
    for light, wi, distance, E in to_one_light(plan, rays, surface):
        yield light, wi, distance, np.ones_like(E)


def without_cosine(reflection, surface, wi):
    return 1 / np.maximum((surface.ns * wi).sum(axis=0), 0.1)


@pytest.mark.parametrize(("owner", "name", "mutant"), [(Path, "to_lights", of_equal_weight), (shadow, "_share", without_cosine)])
def test_the_penumbra_catches_light_that_is_weighed_wrongly(monkeypatch, owner, name, mutant):
    monkeypatch.setattr(owner, name, staticmethod(mutant) if owner is Path else mutant)
    with pytest.raises(AssertionError):
        assert_penumbra()


def test_a_pixel_is_a_ratio_of_means():
    """Not the mean of ratios: where there is much light, whether it arrives counts more. One lamp is low, the other half hidden."""
    low, high = (PointLight(position=p, intensity=(1.0,) * 3) for p in ((1.0, 0.0, 0.2), (0.0, 0.0, 2.0)))
    floor = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), h.lambert())
    camera = PerspectiveCamera.look_at((0, 0, 0.9), (0, 0, 0), up=(0, 1, 0), fov=1.6)
    scene = h.scene([floor, half_plane(z=1.0)], [low, high], camera)
    (found,) = shadows(scene, width=1, height=1, samples=4096, integrator="whitted")[:, 0]
    x, y = 0.9 * np.tan(0.8) * ((np.indices((400, 400)) + 0.5) / 200 - 1)
    by_low, by_high = (z / ((x - c) ** 2 + y**2 + z**2) ** 1.5 for c, z in ((1, 0.2), (0, 2.0)))
    of_means, ratio = (by_low + by_high * (x > 0)).sum() / (by_low + by_high).sum(), (by_low + by_high * (x > 0)) / (by_low + by_high)
    assert abs(of_means - ratio.mean()) > 0.03
    assert abs(found - of_means) <= 0.01


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_what_nothing_hides_is_lit_and_what_all_is_hidden_from_is_dark(integrator):
    """To the bit, whatever the lights; 0 also where nothing shines, and where nothing is met."""
    for lights in ((PANEL,), (RED, SunLight(angle=0.3))):
        open_, shut = (shadows(h.receiver(lights, [half_plane(x=x)], distance=0.2), integrator=integrator) for x in (-40, 50))
        assert (open_ == 1).all()
        assert not shut.any()
    assert not shadows(h.receiver(), integrator=integrator).any()
    assert not shadows(h.receiver([PointLight(position=(0, 0, -1))]), integrator=integrator).any()
    assert not shadows(h.scene(), integrator=integrator).any()


def test_hard_shadows_are_those_of_the_picture():
    """Whitted's: the middle of the panel is seen or not."""
    for x, expected in ((-0.01, 0), (0.01, 1)):
        assert (
            shadows(h.receiver([PANEL], [half_plane()], point=(x, 0, 0), size=1e-3, distance=0.1), integrator="whitted") == expected
        ).all()


@pytest.mark.parametrize("integrator", ["whitted", "path"])
def test_lights_count_by_what_they_bring_in_each_channel(integrator):
    """The red lamp is hidden: of 4 + 1 parts of red 1 is left, of the others all."""
    scene = h.receiver([RED, WHITE], [half_plane(x=-0.2, z=0.5)], distance=0.2)
    found = shadows(scene, samples=256, integrator=integrator)
    assert (found[:, 1:] == 1).all()
    if integrator == "whitted":
        is_everywhere(found[:, 0], 0.2)
    assert h.mean_is(found[:, 0], 0.2, floor=1e-3)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_shadows_of_coloured_panes_are_coloured(integrator):
    """Also where the floor reflects no green: what arrives counts, not what goes on."""
    is_everywhere(shadows(over(Material(name="pane", lobes=(Transparent(TINT),))), integrator=integrator), TINT)
    half = np.array(TINT) * 0.4 + 0.6
    is_everywhere(shadows(over(Material(name="thin", lobes=(Transparent(TINT),)), alpha=0.4), integrator=integrator), half)
    scene = h.receiver(
        [WHITE], [half_plane(Material(name="pane", lobes=(Transparent(TINT),)), x=50)], material=h.lambert((1.0, 0, 0)), distance=0.2
    )
    is_everywhere(shadows(scene, integrator=integrator), TINT)


def test_glass_is_in_the_way_of_those_who_follow_light_through_it():
    glass = Material(name="glass", lobes=(Dielectric(transmittance=TINT),))
    assert not shadows(over(glass)).any()
    is_everywhere(shadows(over(glass), integrator="whitted"), TINT)


@pytest.mark.parametrize(("tint", "integrators"), [(TINT, ("path", "distributed", "path_naive")), ((1.0, 1.0, 1.0), INTEGRATORS)])
def test_the_first_surface_is_the_first_that_is_not_passed(tint, integrators):
    """A pane in the light before a floor that has half of it. Under Whitted, rays of their own pass; and what is lost in a pane covers."""
    quad, shade = h.quad((0, 0, 0.05), (0.01, 0, 0), (0, 0.01, 0), name="pane"), Material(name="shade", lobes=(Transparent(GREY),))
    pane, floor = h.thing(quad, Material(name="pane", lobes=(Transparent(tint),))), h.lambert(1.0)
    beside = h.thing(h.quad((0.02, 0, 0.02), (0.02, 0, 0), (0, 0.02, 0), name="beside"), shade)
    for integrator in integrators:
        scene = h.receiver([WHITE], [pane, beside], distance=0.1, material=floor)
        is_everywhere(shadows(scene, integrator=integrator, max_depth=2), 0.5)


@pytest.mark.parametrize("integrator", ["path", "distributed", "whitted", "whitted_phong"])
def test_surfaces_share_a_pixel_by_what_they_cover(integrator):
    """A veil, of which 0.3 is clear, in the light, before a floor in the dark."""
    veil = Material(name="veil", lobes=(Lambert(GREY), Transparent((0.3,) * 3)))
    veil = h.thing(h.quad((0, 0, 0.05), (0.02, 0, 0), (0, 0.02, 0), name="veil"), veil)
    dark = h.thing(h.quad((0.02, 0, 0.02), (0.02, 0, 0), (0, 0.02, 0), name="dark"), h.lambert())
    scene = h.receiver([WHITE], [veil, dark], distance=0.1)
    E_veil, E_floor = (z / (1 + z * z) ** 1.5 for z in (0.95, 1.0))
    found = shadows(scene, samples=256, integrator=integrator, max_depth=1)
    assert h.mean_is(found[:, 1], 0.7 * E_veil / (0.7 * E_veil + 0.3 * E_floor), floor=1e-4)


def test_what_moves_is_in_the_way_for_a_time():
    """The edge passes before the lamp at the middle of the shutter; one stratum of 256 may lie on either side of it."""
    keys = np.stack([np.eye(4)] * 2)
    keys[:, 0, 3] = -1, 1
    for x, expected in ((0.0, 0.5), (0.5, 0.25), (-0.5, 0.75), (1.5, 0.0)):
        sheet = h.replaced(half_plane(x=x), motion=keys)
        lamp = PointLight(position=(0.0, 0.0, 2 * LOW), intensity=(1.0,) * 3)
        scene = h.receiver([lamp], [sheet], distance=0.2)
        np.testing.assert_allclose(shadows(scene, samples=256), 1 - _covered(x), atol=1.01 / 256)
        assert 1 - _covered(x) == expected


def _covered(x):
    """The share of time in which the edge at x + 2 t - 1 lies beyond 0."""
    return min(max((x + 1) / 2, 0), 1)


def test_visibility_is_minded():
    """What shadow rays do not see is in no light's way, a light that dull surfaces do not see is none for them."""
    scene = h.receiver([WHITE], [h.replaced(half_plane(x=50), hidden_from=("shadow",))], distance=0.2)
    assert (shadows(scene) == 1).all()
    lights = (h.replaced(WHITE, hidden_from=("diffuse",)), h.replaced(RED, intensity=(1.0, 1.0, 1.0)))
    for integrator in ("path", "whitted"):
        sheet = half_plane(x=-0.2, z=0.5)
        assert not shadows(h.receiver(lights, [sheet], distance=0.2), integrator=integrator).any()
        assert (shadows(h.receiver(lights[:1], distance=0.2), integrator=integrator) == 0).all()
        shiny = Material(name="shiny", lobes=(Phong(GREY, 2.0),))
        found = shadows(h.receiver(lights, [sheet], material=shiny, distance=0.2), samples=64, integrator=integrator)
        assert h.mean_is(found[:, 0], 0.5, floor=1e-6)
    seen, unseen = (h.receiver([h.replaced(PANEL, is_visible=v)], [half_plane()], distance=0.1) for v in (True, False))
    assert h.same_bits(shadows(seen), shadows(unseen))


@pytest.mark.parametrize("lobes", [(), (Mirror(GREY),), (Dielectric(),)], ids=["black", "mirror", "glass"])
def test_surfaces_that_reflect_no_lamp_lie_in_shadows_too(lobes):
    material = Material(name="m", lobes=lobes)
    for x, expected in ((-0.2, 0.2), (-40, 1.0)):
        scene = h.receiver([RED, WHITE], [half_plane(x=x, z=0.5)], material=material, distance=0.2)
        is_everywhere(shadows(scene, integrator="whitted")[:, 0], expected)


@pytest.mark.parametrize(
    ("lobes", "behind"), [((LambertTransmission(GREY),), 1.0), ((Lambert(GREY), LambertTransmission((0.25,) * 3)), 1 / 3)]
)
def test_light_from_behind_counts_as_it_is_transmitted(lobes, behind):
    """One lamp before the sheet that is hidden, one behind it, as bright: a share of the light passes, and the rest is missing."""
    front, back = (PointLight(position=(0.0, 0.0, z), intensity=(1.0,) * 3) for z in (1, -1))
    blocker = h.thing(h.quad((0, 0, 0.5), (1, 0, 0), (0, 1, 0), name="blocker"), h.lambert())
    scene = h.receiver([front, back], [blocker], material=Material(name="paper", lobes=lobes), distance=0.2)
    is_everywhere(shadows(scene, integrator="whitted"), behind)
    # What is not thin in the same scene has no light from behind.
    scene = h.receiver([back], [h.thing(h.quad((5, 5, 0)), Material(name="paper", lobes=lobes))], distance=0.2)
    assert not shadows(scene).any()


def test_a_picture_of_the_world_is_a_light_and_an_even_world_is_none():
    """Half of the sky is hidden by a wall through the point, but for its part below the sheet's far end."""
    wall = h.thing(h.quad((-1e-4, 0, 0), (0, 1e4, 0), (0, 0, 1e4), name="wall"), h.lambert(0.5))
    scene = h.receiver(objects=[wall], distance=1e-4, tilt=0.5, size=1e-6)
    sky = h.replaced(scene, world=World(environment=EnvironmentMap(pixels=np.ones((3, 4, 8), np.float32))))
    assert h.mean_is(shadows(sky, samples=256)[:, 0], 0.5, floor=1e-3)
    assert not shadows(h.replaced(scene, world=World(radiance=(1.0,) * 3))).any()


def test_divided_pixels_say_the_same():
    """Where cells are divided numerators and denominators are gathered, then divided: a lit edge against none."""
    floor = h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), h.lambert())
    camera = PerspectiveCamera.look_at((0, 0, 0.3), (0, 0, 0), up=(0, 1, 0), fov=1.5)
    scene = h.scene([floor, half_plane()], [h.replaced(WHITE, position=(0.0, 0.0, 2 * LOW))], camera)
    found = shadows(scene, width=5, height=5, samples=4, integrator="whitted", adaptive_threshold=0.05, adaptive_levels=4)
    found = found.reshape(5, 5, 3)
    assert (found[:, :2] == 0).all()
    assert (found[:, 3:] == 1).all()
    np.testing.assert_allclose(found[:, 2], 0.5, atol=0.04)


def test_the_pass_changes_no_picture():
    scene = h.receiver([PANEL, WHITE], [half_plane()], distance=0.1)
    with_, without = (
        render_image(scene, h.settings(passes=("Combined", *more), samples=16)).passes["Combined"] for more in (("Shadow",), ())
    )
    assert h.same_bits(with_, without)
