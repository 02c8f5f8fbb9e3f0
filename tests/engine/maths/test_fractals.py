"""Fractals are those of their scalar twins in float64 (Musgrave in Ebert et al. 2003, chapter 16)."""

import math

import numpy as np
import pytest

from glanz.engine.maths import fractals
from glanz.engine.maths.fractals import FRACTALS, fractal
from glanz.tests import helpers as h
from glanz.tests.engine.maths.test_perlin import places, twin_noise


def twin_fbm(noise, whole, rest, r, offset, gain, is_normalized):
    def octaves(count):
        total, most = sum(r**i * noise(i) for i in range(count)), sum(r**i for i in range(count))
        return 0.5 * total / most + 0.5 if is_normalized else total

    coarse = octaves(whole + 1)
    return coarse + rest * (octaves(whole + 2) - coarse) if rest else coarse


def twin_multifractal(noise, whole, rest, r, offset, gain, is_normalized):
    value = math.prod(r**i * noise(i) + 1 for i in range(whole + 1))
    return value * (rest * r ** (whole + 1) * noise(whole + 1) + 1)


def twin_hetero_terrain(noise, whole, rest, r, offset, gain, is_normalized):
    value = noise(0) + offset
    for i in range(1, whole + 1):
        value += (noise(i) + offset) * r**i * value
    return value + rest * (noise(whole + 1) + offset) * r ** (whole + 1) * value


def twin_hybrid_multifractal(noise, whole, rest, r, offset, gain, is_normalized):
    value, weight = 0.0, 1.0
    for i in range(whole + 2):
        if weight <= 0.001:
            break
        weight = min(weight, 1)
        signal = (noise(i) + offset) * r**i
        value += (1 if i <= whole else rest) * weight * signal
        weight *= gain * signal
    return value


def twin_ridged_multifractal(noise, whole, rest, r, offset, gain, is_normalized):
    value = signal = (offset - abs(noise(0))) ** 2
    for i in range(1, whole + 1):
        signal = min(max(signal * gain, 0), 1) * (offset - abs(noise(i))) ** 2
        value += signal * r**i
    return value


TWINS = {key: globals()[f"twin_{key.replace(' ', '_')}"] for key in FRACTALS}
each = pytest.mark.parametrize("kind", FRACTALS)


def difference(kind, detail, is_normalized=False):
    """How far the fractal is from its twin at most; roughness, offset and gain differ from point to point."""
    p = places(60)
    rng = np.random.default_rng(7)
    roughness, offset, gain = rng.uniform(0.2, 0.9, 60), rng.uniform(0, 1, 60), rng.uniform(0.5, 3, 60)
    found = fractal(p, None, kind, np.float32([detail]), *map(np.float32, (roughness, [2.3], offset, gain)), is_normalized)
    assert found.dtype == np.float32
    whole = math.floor(detail)
    expected = [
        TWINS[kind](lambda i, q=q: twin_noise(*(2.3**i * float(c) for c in q)), whole, detail - whole, r, o, g, is_normalized)
        for q, r, o, g in zip(p.T, roughness, offset, gain)
    ]
    return np.abs(found - expected).max()


@each
@pytest.mark.parametrize("detail", [0.0, 1.0, 2.5, 3.75])
def test_octaves_are_those_of_the_twin(kind, detail):
    assert difference(kind, detail) <= 1e-3
    if kind == "fbm":
        assert difference(kind, detail, True) <= 3e-4


@each
def test_twins_catch_octaves_whose_last_part_counts_in_full(kind, monkeypatch):
    octaves = fractals._octaves
    monkeypatch.setattr(fractals, "_octaves", lambda *args, **kw: ((s, np.ceil(share)) for s, share in octaves(*args, **kw)))
    with pytest.raises(AssertionError):
        test_octaves_are_those_of_the_twin(kind, 2.5)


@each
def test_how_many_octaves_others_have_does_not_matter(kind):
    """Detail that varies: each point has its own."""
    p = places(64)
    detail = np.linspace(0, 5, 64, dtype=np.float32)
    parameters = np.float32([0.6]), np.float32([2.1]), np.float32([0.8]), np.float32([1.5])
    together = fractal(p, None, kind, detail, *parameters, True)
    alone = [fractal(p[:, i : i + 1], None, kind, detail[i : i + 1], *parameters, True)[0] for i in range(64)]
    assert h.same_bits(together, np.array(alone))


@each
def test_octaves_finer_than_the_footprint_are_left_out(kind):
    """What is left is the same everywhere for footprints wider than a cell; and of those without extent it is all."""
    p = places()
    wide, narrow = np.full(p.shape[1], np.float32(0.5)), np.zeros(p.shape[1], np.float32)
    parameters = (kind, np.float32([4]), np.float32([0.5]), np.float32([2]), np.float32([1]), np.float32([2]), True)
    assert np.ptp(fractal(p, wide, *parameters)) == 0
    assert h.same_bits(fractal(p, narrow, *parameters), fractal(p, None, *parameters))


def test_the_mean_of_normalised_noise_is_a_half():
    p = places()
    wide = np.full(p.shape[1], np.float32(0.5))
    assert h.same_bits(fractal(p, wide, "fbm", [4], [0.5], [2], is_normalized=True), np.full(p.shape[1], np.float32(0.5)))


@each
def test_octaves_looked_up_together_are_those_looked_up_one_by_one(kind, monkeypatch):
    """Few points have several octaves at a time; and of each octave only those where it is seen are looked up."""
    p = places(64)
    half = np.random.default_rng(3).uniform(0, 0.3, 64).astype(np.float32)
    calls = h.spy(monkeypatch, fractals, "noise")

    def found(together):
        monkeypatch.setattr(fractals, "_TOGETHER", together)
        return fractal(p, half, kind, *map(np.float32, ([4.5], [0.6], [2.1], [0.8], [1.5])))

    assert h.same_bits(found(4096), found(1))
    assert len(calls) == 1 + 6
    assert calls[0].result.size == sum(call.result.size for call in calls[1:]) < 0.6 * 6 * 64


def test_octaves_that_nobody_sees_are_not_worked_out(monkeypatch):
    calls = h.spy(monkeypatch, fractals, "noise")
    p = places(64)
    fractal(p, np.full(64, np.float32(0.5)), "fbm", [15.0], [0.5], [2.0])
    assert sum(call.result.size for call in calls) == 0
