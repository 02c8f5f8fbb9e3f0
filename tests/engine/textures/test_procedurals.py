"""Patterns against twins that know no arrays, and the checker's average against quadrature."""

import math

import numpy as np
import pytest

from glanz.engine import (
    BrickTexture,
    CheckerTexture,
    GaborTexture,
    GradientTexture,
    MagicTexture,
    VoronoiTexture,
    WaveTexture,
    WhiteNoiseTexture,
)
from glanz.engine.textures import brick, checker, gabor, magic, voronoi, wave
from glanz.engine.textures.checker import mean_sign
from glanz.tests import helpers as h
from glanz.tests.contracts.test_textures import SLOPE, Points, somewhere


def test_a_checker_is_odd_where_an_odd_number_of_coordinates_is():
    p = somewhere()
    value = CheckerTexture((1.0, 0.5, 0.0), (0.0, 0.25, 1.0))
    found = value.eval(Points(p))
    for point, colour in zip(p.T[:500], found.T):
        x, y, z = (math.floor((float(c) + 1e-6) * 0.999999) for c in point)
        assert colour.tolist() == list(value.odd if (x + y + z) % 2 else value.even)


def test_a_surface_at_a_whole_number_is_on_one_side():
    """Blender's shift: z = 0 up to rounding is the cube above."""
    p = somewhere()
    p[2] = 0
    above = p.copy()
    above[2] = 0.5
    wobbling = p.copy()
    wobbling[2] = np.where(np.arange(p.shape[1]) % 2, np.float32(-1e-7), np.float32(1e-7))
    value = CheckerTexture()
    expected = value.eval(Points(above))
    for q in (p, wobbling):
        assert np.array_equal(value.eval(Points(q)), expected)


@pytest.mark.parametrize("half", [0.0, 1e-4, 0.1, 0.4999, 0.5001, 0.75, 1.0, 3.3, 200.0])
def test_the_mean_of_the_sign_is_its_integral(half):
    """Against the exact sum over the unit intervals that [x - half, x + half] cuts."""
    x = np.linspace(-3.3, 4.1, 101)
    for value, found in zip(x, mean_sign(x.astype(np.float32), np.full(x.shape, half, np.float32))):
        low, high = float(np.float32(value)) - half, float(np.float32(value)) + half
        if half == 0:
            assert found == (-1) ** math.floor(value)
            continue
        total = 0.0
        for i in range(math.floor(low), math.floor(high) + 1):
            total += (-1) ** i * max(min(high, i + 1) - max(low, i), 0)
        assert abs(found - total / (2 * half)) <= max(2e-3 if half == 1e-4 else 2e-6, 4e-5 / max(half, 1))


def test_integrals_catch_a_triangle_wave_of_another_phase(monkeypatch):
    wave = checker._triangle_wave
    monkeypatch.setattr(checker, "_triangle_wave", lambda x: wave(x + np.float32(0.1)))
    with pytest.raises(AssertionError):
        test_the_mean_of_the_sign_is_its_integral(0.75)


def twin_gradient(shape, x, y, z):
    r = math.sqrt(x * x + y * y + z * z)
    t = min(max(x, 0), 1)
    value = {
        "linear": x,
        "quadratic": max(x, 0) ** 2,
        "easing": 3 * t**2 - 2 * t**3,
        "diagonal": (x + y) / 2,
        "radial": math.atan2(y, x) / (2 * math.pi) + 0.5,
        "spherical": max(0.999999 - r, 0),
        "quadratic sphere": max(0.999999 - r, 0) ** 2,
    }[shape]
    return min(max(value, 0), 1)


@pytest.mark.parametrize("shape", ["linear", "quadratic", "easing", "diagonal", "radial", "spherical", "quadratic sphere"])
def test_gradients_are_those_of_the_twin(shape):
    p = somewhere(scale=2.0)
    expected = [twin_gradient(shape, *map(float, q)) for q in p.T]
    found = GradientTexture(shape).eval(Points(p))
    assert np.abs(found - expected).max() <= 1e-6
    assert len(set(expected)) > 10


def test_a_scale_multiplies_points_and_footprints():
    p, axes = somewhere(n=500), tuple(np.full((2, 3, 500), 0.1, np.float32))
    for plugin in (CheckerTexture, BrickTexture, VoronoiTexture, WaveTexture, GaborTexture):
        found, expected = plugin(scale=2.0).eval(Points(p, axes)), plugin().eval(Points(2 * p, tuple(2 * a for a in axes)))
        assert h.same_bits(np.array(found), np.array(expected)), plugin.key


def twin_wave(kind, where, profile, p, phase):
    x, y, z = ((c + 1e-6) * 0.999999 for c in p)
    if kind == "bands":
        n = {"x": 20 * x, "y": 20 * y, "z": 20 * z, "diagonal": 10 * (x + y + z)}[where]
    else:
        n = 20 * math.hypot(*(c for c, axis in zip((x, y, z), "xyz") if axis != where))
    n += phase
    turns = n / (2 * math.pi)
    return {"sine": (1 - math.cos(n)) / 2, "saw": turns % 1, "triangle": 2 * abs(turns - math.floor(turns + 0.5))}[profile]


@pytest.mark.parametrize("profile", ["sine", "saw", "triangle"])
@pytest.mark.parametrize("shape", ["bands x", "bands y", "bands z", "bands diagonal", "rings x", "rings y", "rings z", "rings spherical"])
def test_waves_are_those_of_the_twin(shape, profile):
    p = somewhere(n=200, scale=2.0)
    found = WaveTexture(shape=shape, profile=profile, phase=0.7).eval(Points(p))
    difference = np.abs(found[0] - [twin_wave(*shape.split(), profile, map(float, q), 0.7) for q in p.T])
    # Rounding may put a point beyond the edge of a saw's tooth.
    assert (np.minimum(difference, 1 - difference) <= 1e-4).all()
    assert found.std() > 0.2


def test_twins_catch_a_wave_that_is_not_moved_off_whole_numbers(monkeypatch):
    monkeypatch.setattr(wave, "_SHIFT", np.float32(1e-3))
    with pytest.raises(AssertionError):
        test_waves_are_those_of_the_twin("bands x", "sine")


def twin_magic(p, scale, distortion, depth):
    """Each fold replaces a coordinate by a sine or cosine of all three, with these signs."""
    a, b, c = (math.fmod(x * scale, 2 * math.pi) for x in p)
    v = {"x": math.sin(5 * (a + b + c)), "y": math.cos(5 * (-a + b - c)), "z": -math.cos(5 * (-a - b + c))}
    folds = (
        ("y", -1, "cos", (1, -1, 1)), ("x", 1, "cos", (1, -1, -1)), ("z", 1, "sin", (-1, -1, -1)), ("x", -1, "cos", (-1, 1, -1)),
        ("y", -1, "sin", (-1, 1, 1)), ("y", -1, "cos", (-1, 1, 1)), ("x", 1, "cos", (1, 1, 1)), ("z", 1, "sin", (1, 1, -1)),
        ("x", -1, "cos", (-1, -1, 1)), ("y", -1, "sin", (1, -1, 1)),
    )  # fmt: skip
    if depth:
        v = {name: x * distortion for name, x in v.items()}
    for name, sign, function, signs in folds[:depth]:
        v[name] = sign * getattr(math, function)(sum(s * x for s, x in zip(signs, v.values()))) * distortion
    return [0.5 - x / (2 * distortion) for x in v.values()]


@pytest.mark.parametrize("depth", range(11))
def test_magic_is_that_of_the_twin(depth):
    p = somewhere(n=200, scale=4.0)
    found = MagicTexture(scale=1.5, distortion=1.2, depth=depth).eval(Points(p))
    assert np.abs(found.T - [twin_magic(map(float, q), 1.5, 1.2, depth) for q in p.T]).max() <= 2e-3
    mean = MagicTexture(scale=1.5, distortion=1.2, depth=depth, output="fac").eval(Points(p))
    assert np.abs(mean[0] - found.mean(axis=0)).max() <= 1e-6


def test_twins_catch_a_fold_that_replaces_another_coordinate(monkeypatch):
    monkeypatch.setattr(magic, "_FOLDS", (("z", magic._FOLDS[0][1]), *magic._FOLDS[1:]))
    with pytest.raises(AssertionError):
        test_magic_is_that_of_the_twin(3)


def test_older_magic_repeats_before_it_is_scaled():
    p = np.abs(somewhere(n=200, scale=4.0))
    older = MagicTexture(scale=1.5, scales_first=False)
    assert np.abs(older.eval(Points(p)) - MagicTexture(scale=1.5).eval(Points(p))).max() <= 1e-4
    far = p + np.float32(2 * math.pi)
    assert np.abs(older.eval(Points(far)) - older.eval(Points(p))).max() <= 1e-3
    assert np.abs(MagicTexture(scale=1.5).eval(Points(far)) - older.eval(Points(p))).max() > 0.1


def twin_brick(x, y, size, smooth, bias, width, height, shift, shift_every, squash, squash_every):
    """The share of the second colour, and that of mortar."""
    row = math.floor(y / height)
    if shift_every and squash_every:
        width *= squash if row % squash_every == 0 else 1
        x += width * shift if row % shift_every == 0 else 0
    column = math.floor(x / width)
    n = ((row << 16) + (column & 0xFFFF) + 1013) & 0x7FFFFFFF
    n = (n >> 13) ^ n
    n = (n * (n * n * 60493 + 19990303) + 1376312589) & 0x7FFFFFFF
    inside = min(x - width * column, y - height * row, width * (column + 1) - x, height * (row + 1) - y)
    t = min(max((1 - inside / size) / smooth, 0), 1) if inside < size else 0
    return min(max(n / 2**31 + bias, 0), 1), t * t * (3 - 2 * t)


@pytest.mark.parametrize(("every", "squash"), [((2, 2), 1.0), ((3, 1), 0.7), ((0, 2), 0.5)])
def test_bricks_are_those_of_the_twin(every, squash):
    p = somewhere(n=500)
    colours = {"colour1": (0.0, 0.0, 0.5), "colour2": (1.0, 0.0, 0.5), "mortar": (0.0, 1.0, 0.5)}
    layout = {"shift": 0.4, "shift_every": every[0], "squash": squash, "squash_every": every[1]}
    value = BrickTexture(**colours, mortar_size=0.05, mortar_smooth=0.6, bias=-0.1, width=0.9, height=0.4, **layout)
    twins = [twin_brick(float(x), float(y), 0.05, 0.6, -0.1, 0.9, 0.4, *layout.values()) for x, y in p[:2].T]
    expected = np.array([(tint * (1 - mortar), mortar, 0.5) for tint, mortar in twins])
    near = np.abs(value.eval(Points(p)).T - expected).max(axis=1) <= 1e-3
    # Rounding may put a point into the next brick.
    assert near.mean() >= 0.995
    fac = h.replaced(value, output="fac").eval(Points(p))
    assert (np.abs(fac[0] - expected[:, 1]) <= 1e-3).mean() >= 0.995


def test_twins_catch_bricks_of_other_colours(monkeypatch):
    random = brick._random
    monkeypatch.setattr(brick, "_random", lambda row, column: random(row + np.int32(1), column))
    with pytest.raises(AssertionError):
        test_bricks_are_those_of_the_twin((2, 2), 1.0)


def test_mortar_without_a_transition_is_all_or_nothing():
    fac = BrickTexture(mortar_smooth=0.0, output="fac").eval(Points(somewhere()))
    assert set(np.unique(fac)) == {0, 1}


def test_white_noise_knows_no_neighbours():
    p = somewhere(n=2000)
    near = np.nextafter(p, np.float32(np.inf))
    a, b = (WhiteNoiseTexture(output="color").eval(Points(q)) for q in (p, near))
    assert abs(np.corrcoef(a.ravel(), b.ravel())[0, 1]) <= h.Z / 6000**0.5
    assert np.abs(a.mean(axis=1) - 0.5).max() <= h.Z * (1 / 12 / 2000) ** 0.5
    assert h.same_bits(WhiteNoiseTexture().eval(Points(p))[0].copy(), a[0].copy())


@pytest.mark.parametrize(
    ("module", "name", "plugin", "outputs"),
    [(voronoi, "fractal_cells", VoronoiTexture, ("distance", "color", "position")), (gabor, "phasor", GaborTexture, ("value", "phase"))],
)
def test_outputs_of_one_node_are_worked_out_once(module, name, plugin, outputs, monkeypatch):
    calls, function = [], getattr(module, name)
    monkeypatch.setattr(module, name, lambda *args: calls.append(1) or function(*args))
    at = Points(somewhere(n=16))
    for output in outputs:
        at.value(plugin(scale=SLOPE, output=output))
    assert len(calls) == 1
    at.value(plugin(scale=2.0, output=output))
    assert len(calls) == 2
