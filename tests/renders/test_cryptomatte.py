"""Which things cover a pixel: their shares are those of areas and of what hides, and their numbers those of their names."""

import math
from itertools import pairwise

import numpy as np
import pytest

from glanz.engine import PASSES, Material, PerspectiveCamera, Transparent, metadata, plan, render_image, rendering
from glanz.engine.maths.murmur import id_bits, id_of, murmur3
from glanz.engine.passes.cryptomatte import Cryptomatte
from glanz.engine.wavefront.ranks import Ranks
from glanz.tests import helpers as h

LEVELS = ("CryptoObject00", "CryptoObject01")


def test_hashes_are_those_of_murmur3():
    """Published values, with tails of 0 to 3 bytes."""
    known = {"": 0, "hello": 0x248BFA47, "hello, world": 0x149BBB7F, "The quick brown fox jumps over the lazy dog": 0x2E4FF723}
    assert {text: murmur3(text.encode()) for text in known} == known


def test_numbers_of_names_are_finite_and_not_0():
    bits = np.array([id_bits(str(i)) for i in range(20000)], np.uint32)
    numbers = bits.view(np.float32)
    assert np.isfinite(numbers).all()
    assert (np.abs(numbers) >= np.finfo(np.float32).tiny).all()
    assert np.float32(id_of("7")) == numbers[7]


def strips(*widths, front=None):
    """One pixel that looks straight at strips side by side, named by their places, that fill it from the left; a sheet in front."""
    edges = np.cumsum((0, *widths)) * 2 - 1
    things = [h.thing(h.quad(((a + b) / 2, 0, 0), (b - a, 0, 0), (0, 2, 0), name=str(i))) for i, (a, b) in enumerate(pairwise(edges))]
    sheet = [h.thing(h.quad((0, 0, 0.1), (2, 0, 0), (0, 2, 0), name="front"), front)] if front else []
    camera = PerspectiveCamera.look_at((0, 0, 100), (0, 0, 0), up=(0, 1, 0), fov=2 * math.atan(0.01))
    return h.scene([*things, *sheet], camera=camera)


def covered(scene, **changes):
    """[(number, share)] of the one pixel, rank by rank."""
    settings = h.settings(**{"width": 1, "height": 1, "samples": 4096, "passes": LEVELS} | changes)
    passes = render_image(scene, settings).passes
    return [(n, s) for key in LEVELS for n, s in passes[key][0, 0].astype(np.float64).reshape(2, 2)]


def assert_covered(found, expected):
    """Shares to 5 standard deviations of chance, the names in the order of ranks."""
    assert [n for n, s in found if s] == [np.float32(id_of(name)) for name in expected]
    for (_, share), wanted in zip(found, expected.values()):
        assert abs(share - wanted) <= 5 * math.sqrt(wanted / 4096)


def test_shares_are_areas_in_descending_order():
    """Of five strips the four that cover most; nothing where there is nothing."""
    assert_covered(covered(strips(0.1, 0.3, 0.05, 0.2, 0.35)), {"4": 0.35, "1": 0.3, "3": 0.2, "0": 0.1})
    assert_covered(covered(strips(0.25)), {"0": 0.25})


@pytest.mark.parametrize("integrator", ["path", "distributed", "whitted"])
@pytest.mark.parametrize("adaptive", [0.0, 0.1])
def test_what_is_transparent_covers_what_it_hides(adaptive, integrator):
    veil = Material(name="veil", lobes=(*h.lambert(0.2).lobes, Transparent((0.3, 0.3, 0.3))))
    found = covered(strips(1.0, front=veil), adaptive_threshold=adaptive, integrator=integrator)
    assert_covered(found, {"front": 0.7, "0": 0.3})
    assert_covered(covered(strips(1.0, front=h.replaced(h.lambert(), alpha=0.4))), {"0": 0.6, "front": 0.4})


def test_the_shares_catch_surfaces_that_are_not_asked_beyond(monkeypatch):
    monkeypatch.setattr(plan, "record_beyond", lambda passes: lambda *where: None)
    with pytest.raises(AssertionError):
        test_what_is_transparent_covers_what_it_hides(0.0, "whitted")


def test_shares_of_trees_do_not_depend_on_batches(monkeypatch):
    """Three veils that cross, which some rays meet in one order and some in another; to the bit."""
    veil = Material(name="veil", lobes=(*h.lambert(0.2).lobes, Transparent((0.3, 0.4, 0.7))))
    veils = [h.thing(h.quad((0, 0, 0), (3, 0, z), (0, 3, z), name=str(z)), veil) for z in (-0.5, 0.1, 0.6)]
    settings = h.settings(integrator="whitted", passes=LEVELS, samples=16, pixel_filter="mitchell", max_depth=4)
    whole = render_image(h.scene(veils), settings).passes
    monkeypatch.setattr(rendering, "LANES", 48)
    parts = render_image(h.scene(veils), h.replaced(settings, tile_size=5)).passes
    assert all(h.same_bits(whole[key], parts[key]) for key in LEVELS)
    assert (whole["CryptoObject01"][..., 1] > 0).any()


def test_shares_do_not_depend_on_batches():
    rng = np.random.default_rng(1)
    number, weight = rng.integers(0, 4, (50, 7)).astype(np.float32), rng.random((50, 7))
    one, two = Ranks(9), Ranks(9)
    pixels = np.arange(1, 8)
    one.add(pixels, number, weight)
    for part in (slice(0, 3), slice(3, 50)):
        two.add(pixels[::2], number[part, ::2], weight[part, ::2])
        two.add(pixels[1::2], number[part, 1::2], weight[part, 1::2])
    for level in (0, 1):
        assert np.array_equal(one.pairs(level), two.pairs(level))
    exact = [weight[:, 2][number[:, 2] == n].sum() for n in (1, 2, 3)]
    np.testing.assert_allclose(sorted(one.pairs(0)[1::2, 3]), sorted(exact)[1:], rtol=1e-12)


def test_files_say_which_name_has_which_number():
    scene = strips(0.5, 0.5)
    facts = metadata(scene, h.settings(passes=("CryptoObject00", "CryptoAsset00")), "View")
    head = f"cryptomatte/{id_bits('View.CryptoObject'):08x}"[:19]
    assert facts[f"{head}/name"] == "View.CryptoObject"
    assert facts[f"{head}/manifest"] == f'{{"0":"{id_bits("0"):08x}","1":"{id_bits("1"):08x}"}}'
    assert not any(name.startswith("crypto") for name in metadata(scene, h.settings()))


def test_names_of_levels():
    assert PASSES["CryptoMaterial12"] == Cryptomatte("Material", 12)
    assert PASSES["CryptoMaterial12"].key == "CryptoMaterial12"
    assert "CryptoMaterial" not in PASSES
    with pytest.raises(KeyError, match=r"known: .*CryptoObject00"):
        PASSES["CryptoThing00"]


def test_what_fills_a_pixel_covers_it_under_a_filter_with_negative_lobes_too():
    """Samples of those take away; to 1e-6."""
    scene = strips(1.0)
    closer = h.replaced(scene, camera=PerspectiveCamera.look_at((0, 0, 100), (0, 0, 0), up=(0, 1, 0), fov=0.001))
    found = covered(closer, pixel_filter="mitchell", filter_width=2.0, samples=64)
    assert found[0][1] == pytest.approx(1, abs=1e-6)


def test_a_level_that_is_no_number_of_ours_is_unknown():
    """Digits of other scripts: the name would be another one."""
    with pytest.raises(KeyError, match="unknown pass"):
        PASSES["CryptoObject\u0663\u0663"]
