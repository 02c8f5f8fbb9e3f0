"""The operations of Math and Vector Math are those of Python's own numbers, and 0 where these have no result."""

import math

import numpy as np
import pytest

from glanz.engine.maths import arithmetic
from glanz.engine.maths.arithmetic import NUMBERS, TRIPLES, operands


def defined(function, *numbers):
    """`function` of numbers, or 0 where it has no result."""
    try:
        value = function(*numbers)
    except (ValueError, ZeroDivisionError):
        return 0.0
    return value if isinstance(value, float | int) else 0.0


def to_and_fro(a, top):
    a, top = a % (2 * abs(top)), abs(top)
    return a if a <= top else 2 * top - a


def soft(a, b, width):
    if width == 0:
        return min(a, b)
    return min(a, b) - width * max(1 - abs(a - b) / width, 0) ** 3 / 6 if width > 0 else None


TWINS = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": lambda a, b: defined(lambda: a / b),
    "multiply add": lambda a, b, c: a * b + c,
    "power": lambda a, b: defined(pow, a, b),
    "logarithm": lambda a, b: defined(math.log, a, b),
    "sqrt": lambda a: defined(math.sqrt, a),
    "inverse sqrt": lambda a: defined(lambda: 1 / math.sqrt(a)),
    "absolute": abs,
    "exponent": math.exp,
    "minimum": min,
    "maximum": max,
    "less than": lambda a, b: float(a < b),
    "greater than": lambda a, b: float(a > b),
    "sign": lambda a: (a > 0) - (a < 0),
    "compare": lambda a, b, c: float(abs(a - b) <= max(c, 2.0**-23)),
    "smooth min": soft,
    "smooth max": lambda a, b, c: None if c < 0 else -soft(-a, -b, c),
    "round": lambda a: math.floor(a + 0.5),
    "floor": math.floor,
    "ceil": math.ceil,
    "trunc": math.trunc,
    "fract": lambda a: a % 1,
    "modulo": lambda a, b: defined(math.fmod, a, b),
    "floored modulo": lambda a, b: defined(lambda: a % b),
    "wrap": lambda a, b, c: c if b == c else c + (a - c) % (b - c),
    "snap": lambda a, b: defined(lambda: a // b) * b,
    "pingpong": lambda a, b: defined(to_and_fro, a, b),
    "sine": math.sin,
    "cosine": math.cos,
    "tangent": math.tan,
    "arcsine": lambda a: math.asin(min(max(a, -1), 1)),
    "arccosine": lambda a: math.acos(min(max(a, -1), 1)),
    "arctangent": math.atan,
    "arctan2": math.atan2,
    "sinh": math.sinh,
    "cosh": math.cosh,
    "tanh": math.tanh,
    "radians": math.radians,
    "degrees": math.degrees,
}
"""None: no matter."""


def eighths(seed, count, n=150):
    """Numbers whose quotients float32 holds as exactly as it takes to tell on which side of a whole number they are."""
    return np.random.default_rng(seed).integers(-32, 33, (count, n)) / 8


@pytest.mark.parametrize("name", TWINS)
def test_an_operation_on_numbers_is_pythons(name):
    function = NUMBERS[name]
    given = eighths(1, operands(function))
    given[:, :4] = 0
    with np.errstate(all="ignore"):
        found = function(*given.astype(np.float32))
    assert found.dtype == np.float32
    wanted = [TWINS[name](*map(float, lane)) for lane in given.T]
    matters = [w is not None for w in wanted]
    wanted = np.array([w or 0.0 for w in wanted], float)
    np.testing.assert_allclose(found[matters], wanted[matters], rtol=2e-6, atol=2e-6)


def test_every_operation_has_its_twin():
    assert {*NUMBERS} == {*TWINS, "power before 5.0"}


@pytest.mark.parametrize("name", TWINS)
def test_twins_catch_any_operation_that_is_another(name, monkeypatch):
    takes = operands(NUMBERS[name])
    for other, function in NUMBERS.items():
        if other not in (name, f"{name} before 5.0") and operands(function) == takes:
            monkeypatch.setitem(NUMBERS, name, function)
            with pytest.raises(AssertionError):
                test_an_operation_on_numbers_is_pythons(name)


def unit(a):
    size = np.linalg.norm(a)
    return a / size if size else a


def refracted(a, b, eta):
    """By angles: what is along the surface grows by eta, and the whole keeps its length."""
    n = unit(b)
    if not n.any() or abs(np.linalg.norm(a) - 1) > 1e-6:
        return None
    along = eta * (a - (a @ n) * n)
    rest = 1 - along @ along
    return along - math.sqrt(rest) * n if rest >= 0 else np.zeros(3)


TRIPLE_TWINS = {
    "scale": lambda a, b: a * b[0],
    "cross product": np.cross,
    "project": lambda a, b: (a @ unit(b)) * unit(b),
    "reflect": lambda a, b: a - 2 * (a @ unit(b)) * unit(b),
    "refract": lambda a, b, c: refracted(a, b, c[0]),
    "faceforward": lambda a, b, c: a if b @ c < 0 else -a,
    "dot product": np.dot,
    "distance": lambda a, b: np.linalg.norm(a - b),
    "length": np.linalg.norm,
    "normalize": unit,
    "fraction": lambda a: a % 1,
    "wrap": lambda *abc: [TWINS["wrap"](*lane) for lane in zip(*abc)],
}


@pytest.mark.parametrize("name", TRIPLE_TWINS)
def test_an_operation_on_vectors_is_that_of_numpy(name):
    function = TRIPLES[name]
    given = np.stack([eighths(seed, 3) for seed in range(operands(function))])
    given[:, :, :2] = 0
    if name == "refract":
        given[0] /= np.maximum(np.linalg.norm(given[0], axis=0), 1)
        given[2] = np.abs(given[2, :1]) + 0.3
    if name == "scale":
        given[1] = given[1, :1]
    found = function(*given.astype(np.float32))
    wanted = [TRIPLE_TWINS[name](*lane) for lane in np.moveaxis(given, 2, 0)]
    matters = [w is not None for w in wanted]
    wanted = np.array([np.zeros(3) if w is None else w for w in wanted]).reshape(given.shape[2], -1).T
    np.testing.assert_allclose(found[:, matters], wanted[:, matters], rtol=1e-5, atol=1e-4 if name == "refract" else 1e-5)


def test_other_operations_on_vectors_are_those_on_numbers():
    for name in {*TRIPLES} - {*TRIPLE_TWINS, "wrap before 5.0"}:
        assert TRIPLES[name] is NUMBERS[name]


@pytest.mark.parametrize(("name", "wrong"), [("project", "reflect"), ("reflect", "project"), ("distance", "dot product")])
def test_twins_catch_vectors_of_another_operation(name, wrong, monkeypatch):
    monkeypatch.setitem(TRIPLES, name, TRIPLES[wrong])
    with pytest.raises(AssertionError):
        test_an_operation_on_vectors_is_that_of_numpy(name)


def test_what_is_left_of_large_numbers_is_rounded_once(monkeypatch):
    """40,000,000 in steps of 0.7 leaves what a double of the same numbers leaves."""

    def left():
        a, b = np.float32([4e7, -3e8]), np.float32([0.7, 1.3])
        found = arithmetic.floored_modulo(a, b)
        exact = a.astype(float) - np.floor(a / b).astype(float) * b.astype(float)
        return np.abs(found - exact).max()

    assert left() <= 1e-6
    monkeypatch.setattr(arithmetic, "_less", lambda a, b, c: a - b * c)
    assert left() > 1e-3
