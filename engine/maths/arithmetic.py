"""Arithmetic as shader nodes have it: of anything, and what has no value is 0.

Numbers are arrays of float32 of any shapes that broadcast. NUMBERS and TRIPLES name the operations of Blender's nodes Math
and Vector Math; each takes as many operands as it has parameters. Blender 5.0 computes some of them in other ways than before.
"""

import numpy as np

from .vectors import cross, dot, length

_FINEST = np.finfo(np.float32).eps


def divided(a, b):
    """a / b, and 0 where b is 0."""
    shape = np.broadcast_shapes(np.shape(a), np.shape(b))
    return np.divide(a, b, out=np.zeros(shape, np.float32), where=b != 0)


def power(a, b):
    """a^b, and 0 where there is none: of 0 with b below 0, and of a below 0 unless b is a whole number."""
    is_defined = np.where(a == 0, b >= 0, (a > 0) | (b == np.trunc(b)))
    return np.where(is_defined, np.power(np.where(is_defined, a, 1), b), np.float32(0))


def old_power(a, b):
    """The same, but that 0 to the power of what is below 0 is infinite."""
    return np.where((a < 0) & (b != np.trunc(b)), np.float32(0), np.power(a, b))


def root(a):
    """The square root, and 0 below 0."""
    return np.sqrt(np.maximum(a, 0))


def inverse_root(a):
    """1 / sqrt(a), and 0 up to 0."""
    return np.where(a > 0, 1 / np.sqrt(np.where(a > 0, a, 1)), np.float32(0))


def logarithm(a, base):
    """The logarithm, and 0 where there is none."""
    is_defined = (a > 0) & (base > 0)
    return divided(np.log(np.where(is_defined, a, 1)), np.log(np.where(is_defined, base, 1)))


def fraction(a):
    """What is above the whole number below, in [0, 1)."""
    return a - np.floor(a)


def modulo(a, b):
    """The remainder of a / b with the sign of a, and 0 where b is 0."""
    return np.where(b != 0, np.fmod(a, np.where(b != 0, b, 1)), np.float32(0))


def _less(a, b, c):
    """a - b c, rounded once, as processors have it: what is left of large numbers is small."""
    return (a - b.astype(np.float64) * c).astype(np.float32)


def floored_modulo(a, b):
    """The remainder of a / b with the sign of b, and 0 where b is 0."""
    return np.where(b != 0, _less(a, np.floor(divided(a, b)), b), np.float32(0))


def wrapped(a, top, bottom):
    """a plus that multiple of top - bottom which brings it there, and `bottom` where they are equal."""
    span = top - bottom
    return np.where(span != 0, _less(a, span, np.floor(divided(a - bottom, span))), bottom)


def snapped(a, step):
    """The multiple of `step` below a."""
    return np.floor(divided(a, step)) * step


def ping_pong(a, top):
    """a moved to and fro between 0 and `top`."""
    return np.where(top != 0, np.abs(fraction(divided(a - top, top * 2)) * top * 2 - top), np.float32(0))


def rounded(a):
    """The nearest whole number, upwards half way between two."""
    return np.floor(a + np.float32(0.5))


def smooth_minimum(a, b, width):
    """The smaller of a and b, eased by a cubic where they differ by less than `width` (Quilez 2013, "Smooth minimum")."""
    h = divided(np.maximum(width - np.abs(a - b), 0), width)
    return np.minimum(a, b) - h * h * h * width * np.float32(1 / 6)


def smooth_maximum(a, b, width):
    """The larger of a and b, likewise."""
    return -smooth_minimum(-a, -b, width)


def _choice(where):
    return np.asarray(where).astype(np.float32)


def _unit(a):
    size = length(a)
    return divided(a, size)


def _projected(a, b):
    return divided(dot(a, b), dot(b, b)) * b


def _reflected(a, b):
    n = _unit(b)
    return a - 2 * n * dot(a, n)


def _refracted(a, b, eta):
    """What goes on of the direction a through a surface with the normal b; 0 where all is reflected."""
    n = _unit(b)
    cos = dot(a, n)
    k = 1 - eta * eta * (1 - cos * cos)
    return np.where(k < 0, np.float32(0), eta * a - (eta * cos + root(k)) * n)


NUMBERS = {
    "add": lambda a, b: a + b,
    "subtract": lambda a, b: a - b,
    "multiply": lambda a, b: a * b,
    "divide": divided,
    "multiply add": lambda a, b, c: a * b + c,
    "power": power,
    "power before 5.0": old_power,
    "logarithm": logarithm,
    "sqrt": root,
    "inverse sqrt": inverse_root,
    "absolute": np.abs,
    "exponent": np.exp,
    "minimum": np.minimum,
    "maximum": np.maximum,
    "less than": lambda a, b: _choice(a < b),
    "greater than": lambda a, b: _choice(a > b),
    "sign": np.sign,
    "compare": lambda a, b, c: _choice((a == b) | (np.abs(a - b) <= np.maximum(c, _FINEST))),
    "smooth min": smooth_minimum,
    "smooth max": smooth_maximum,
    "round": rounded,
    "floor": np.floor,
    "ceil": np.ceil,
    "trunc": np.trunc,
    "fract": fraction,
    "modulo": modulo,
    "floored modulo": floored_modulo,
    "wrap": wrapped,
    "snap": snapped,
    "pingpong": ping_pong,
    "sine": np.sin,
    "cosine": np.cos,
    "tangent": np.tan,
    "arcsine": lambda a: np.arcsin(np.clip(a, -1, 1)),
    "arccosine": lambda a: np.arccos(np.clip(a, -1, 1)),
    "arctangent": np.arctan,
    "arctan2": np.arctan2,
    "sinh": np.sinh,
    "cosh": np.cosh,
    "tanh": np.tanh,
    "radians": lambda a: a * np.float32(np.pi / 180),
    "degrees": lambda a: a * np.float32(180 / np.pi),
}
"""Of numbers."""

_OF_BOTH = ("add subtract multiply divide minimum maximum modulo snap absolute floor ceil round sign sine cosine tangent power").split()
TRIPLES = {name: NUMBERS[name] for name in _OF_BOTH} | {
    "multiply add": NUMBERS["multiply add"],
    # It differs from `wrapped` by what it rounds.
    "wrap": lambda a, top, bottom: floored_modulo(a - bottom, top - bottom) + bottom,
    "wrap before 5.0": wrapped,
    "power before 5.0": old_power,
    "fraction": fraction,
    "scale": lambda a, b: a * b,
    "cross product": cross,
    "project": _projected,
    "reflect": _reflected,
    "refract": _refracted,
    "faceforward": lambda a, b, c: np.where(dot(c, b) < 0, a, -a),
    "dot product": lambda a, b: dot(a, b)[None],
    "distance": lambda a, b: length(a - b)[None],
    "length": lambda a: length(a)[None],
    "normalize": _unit,
}
"""Of vectors (3, N); the second operand of "scale" and the third of "refract", an index relative to what is beyond, are numbers (1, N)."""


def operands(function):
    """How many operands one of these takes."""
    return function.nin if isinstance(function, np.ufunc) else function.__code__.co_argcount
