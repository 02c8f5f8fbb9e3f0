"""The picture by the way that light has come: what each part is, and that together they are the whole."""

import math

import numpy as np
import pytest

from glanz.engine import (
    Dielectric,
    Lambert,
    LambertTransmission,
    Material,
    Mirror,
    PerspectiveCamera,
    Phong,
    PointLight,
    Transparent,
    render_image,
)
from glanz.engine.registry import INTEGRATORS
from glanz.engine.wavefront import splitting
from glanz.tests import helpers as h, scenes

KINDS = ("Diffuse", "Glossy", "Transmission")
PARTS = tuple(f"{kind} {part}" for kind in KINDS for part in ("Color", "Direct", "Indirect"))
ALL = ("Combined", "Emission", "Environment", *PARTS)


def parts_of(scene, passes=ALL, **changes):
    """{pass: (height, width, channels) float64}."""
    rendered = render_image(scene, h.settings(passes=passes, **changes)).passes
    return {name: values.astype(np.float64) for name, values in rendered.items()}


def whole_of(parts):
    by_kind = sum(parts[f"{kind} Color"] * (parts[f"{kind} Direct"] + parts[f"{kind} Indirect"]) for kind in KINDS)
    return by_kind + parts["Emission"] + parts["Environment"]


def assert_whole(parts):
    """To the rounding of float32, in shares of the brightest pixel."""
    picture = parts["Combined"][..., :3]
    assert picture.max() > 0
    assert np.abs(whole_of(parts) - picture).max() <= 1e-6 * picture.max()


def glassware():
    """A glass ball, a sheet of paper, a mirror and a veil over a dull and shiny floor, below a lamp that glows and a sky."""
    shiny = Material(name="floor", lobes=(Lambert((0.6, 0.4, 0.2)), Phong((0.3,) * 3, 20)))
    floor = h.thing(h.quad((0, 0, 0), (8, 0, 0), (0, 8, 0)), shiny)
    ball = h.thing(h.icosphere(3, smooth=True), Material(name="glass", lobes=(Dielectric(),)), h.affine(0.6 * np.eye(3), (0, 0, 0.8)))
    thin = Material(name="paper", lobes=(Lambert((0.4,) * 3), LambertTransmission((0.4,) * 3)))
    paper = h.thing(h.quad((-1.5, 0, 0.5), (1, 0, 0), (0, 0, 1)), thin)
    mirror = h.thing(h.quad((1.5, 1, 1), (1, 0, 0), (0, 0, 2)), Material(name="mirror", lobes=(Mirror((0.9, 0.8, 0.7)),)))
    veil = Material(name="veil", lobes=(Lambert((0.5,) * 3), Transparent((0.4, 0.4, 0.5))), alpha=0.7)
    veil = h.thing(h.quad((1.3, -1.5, 0.5), (1, 0, 0), (0, 0, 1)), veil)
    lamp = h.thing(h.quad((0, 0, 3), (0, 2, 0), (2, 0, 0)), Material(name="lamp", emission=(5.0, 4.0, 3.0)))
    camera = PerspectiveCamera.look_at((0, -5, 2.5), (0, 0, 0.7), up=(0, 0, 1), fov=math.radians(60))
    bulb = PointLight(position=(2, -2, 3), intensity=(3, 3, 3))
    return h.scene([floor, ball, paper, mirror, veil, lamp], [bulb], camera, (0.2, 0.3, 0.4))


@pytest.mark.parametrize("integrator", INTEGRATORS)
@pytest.mark.parametrize("scene", [scenes.everything, glassware])
def test_the_parts_together_are_the_picture(scene, integrator):
    assert_whole(parts_of(scene(), integrator=integrator, width=24, height=24, samples=4, max_depth=4))


def test_the_parts_together_are_the_picture_where_pixels_are_divided():
    assert_whole(parts_of(glassware(), width=16, height=16, samples=4, max_depth=3, adaptive_threshold=0.1))


def test_the_parts_do_not_change_the_picture():
    """Bit for bit: nothing draws another random number for them."""
    alone = parts_of(glassware(), ("Combined",), max_depth=4)["Combined"]
    assert h.same_bits(alone, parts_of(glassware(), max_depth=4)["Combined"])


@pytest.mark.parametrize("part", PARTS)
def test_a_part_is_the_same_without_the_others(part):
    """What it is divided by is gathered, but not given."""
    alone = parts_of(glassware(), (part,), max_depth=3)
    assert list(alone) == [part]
    assert h.same_bits(alone[part], parts_of(glassware(), max_depth=3)[part])


def furnace(*lobes, emission=(0.0, 0.0, 0.0), fov=0.7):
    """A wall of these lobes before the camera, under an even sky of 1."""
    wall = h.thing(h.quad((0, 0, 0), (10, 0, 0), (0, 10, 0)), Material(name="wall", lobes=lobes, emission=emission))
    return h.scene([wall], camera=PerspectiveCamera.look_at((0, 0, 1), (0, 0, 0), up=(0, 1, 0), fov=fov), world=1.0)


def test_before_they_are_multiplied_by_colours_parts_are_light():
    """Under a sky of 1 what arrives is 1, whatever the colour; to 1e-6."""
    parts = parts_of(furnace(Lambert((0.8, 0.4, 0.1)), Mirror((0.1, 0.2, 0.3)), emission=(2.0, 1.0, 0.5)))
    np.testing.assert_allclose(parts["Diffuse Color"], np.broadcast_to((0.8, 0.4, 0.1), (8, 8, 3)), rtol=1e-6)
    np.testing.assert_allclose(parts["Glossy Color"], np.broadcast_to((0.1, 0.2, 0.3), (8, 8, 3)), rtol=1e-6)
    np.testing.assert_allclose(parts["Emission"], np.broadcast_to((2.0, 1.0, 0.5), (8, 8, 3)), rtol=1e-6)
    for kind in ("Diffuse", "Glossy"):
        # One of both is followed by each path, so this is so on average; by chance, one of a million pixels is 0.2 off.
        assert parts[f"{kind} Direct"].mean() == pytest.approx(1, abs=0.1)
    for dark in ("Environment", "Diffuse Indirect", "Glossy Indirect", "Transmission Direct", "Transmission Color"):
        assert not parts[dark].any()


def test_a_black_channel_has_no_light_of_its_own():
    """0 / 0 is 0, not what is no number."""
    parts = parts_of(furnace(Lambert((0.5, 0.0, 0.0))))
    np.testing.assert_allclose(parts["Diffuse Direct"], np.broadcast_to((1.0, 0.0, 0.0), (8, 8, 3)), rtol=1e-6)


def test_smooth_glass_has_fresnelsshares():
    """Seen from above: 4 % of index 1.5 are reflected, and 96 % pass, bent together or not."""
    for ior, share in ((1.5, 0.04), (1 / 1.5, 0.04), (2.0, 1 / 9)):
        parts = parts_of(furnace(Dielectric(ior, transmittance=(0.5, 1.0, 1.0)), fov=1e-3), width=1, height=1)
        np.testing.assert_allclose(parts["Glossy Color"][0, 0], share, rtol=1e-4)
        np.testing.assert_allclose(parts["Transmission Color"][0, 0], (0.5 - 0.5 * share, 1 - share, 1 - share), rtol=1e-4)


def test_what_comes_by_one_surface_is_direct_and_what_comes_by_two_is_not():
    """A floor in a closed white room with a lamp: light that the floor has from the lamp alone is what one bounce brings."""
    room = scenes.everything()
    one = parts_of(room, max_depth=0, samples=64)
    more = parts_of(room, max_depth=4, samples=64)
    assert not any(one[f"{kind} Indirect"].any() for kind in KINDS)
    for kind in ("Diffuse", "Glossy"):
        assert h.same_bits(one[f"{kind} Color"], more[f"{kind} Color"])
        assert more[f"{kind} Indirect"].any()
    np.testing.assert_allclose(one["Diffuse Direct"].mean(), more["Diffuse Direct"].mean(), rtol=0.01)


def test_the_sum_catches_parts_that_are_counted_twice(monkeypatch):
    """The mutant lets what is glossy be diffuse, too."""
    monkeypatch.setattr(splitting, "shares", lambda surface, reflection, wi: np.ones((2, *wi.shape), np.float32))
    with pytest.raises(AssertionError):
        assert_whole(parts_of(glassware(), max_depth=2))


def test_lobes_share_their_directions_in_proportion(monkeypatch):
    """Dull and shiny at once, lit by a lamp in the mirror direction: k_d / pi against Phong's (n + 2) / (2 pi), to 1e-5."""
    k_d, k_s, n = 0.5, 0.2, 10
    wall = h.thing(h.quad((0, 0, 0), (10, 0, 0), (0, 10, 0)), Material(name="wall", lobes=(Lambert((k_d,) * 3), Phong((k_s,) * 3, n))))
    camera = PerspectiveCamera.look_at((0, -1, 1), (0, 0, 0), up=(0, 0, 1), fov=1e-4)
    parts = parts_of(h.scene([wall], [PointLight(position=(0, 1, 1), intensity=(1, 1, 1))], camera), width=1, height=1, samples=1)
    shiny = parts["Glossy Color"] * parts["Glossy Direct"] / (parts["Diffuse Color"] * parts["Diffuse Direct"])
    assert shiny[0, 0] == pytest.approx(k_s * (n + 2) / 2 / k_d, rel=1e-4)
