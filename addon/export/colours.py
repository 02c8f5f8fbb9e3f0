"""Values that are constants, numbers or (r, g, b), or vary from point to point, and what can be computed with them."""

import numpy as np

from ...engine import Coordinates, Gamma, LinearTexture, average_of, is_texture

WHITE, BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)


def varies(value):
    """Whether a value is known only point by point: a texture, or `Coordinates`."""
    return is_texture(value) or isinstance(value, Coordinates)


def as_texture(value):
    """A value that varies as a texture."""
    return LinearTexture((value,), (1.0,)) if isinstance(value, Coordinates) else value


def times(a, b):
    """The product of two values, as a colour."""
    if not varies(a) or not varies(b):
        a, b = (b, a) if varies(b) else (a, b)
        return _scaled(a, np.broadcast_to(np.asarray(b, np.float64), 3))
    return LinearTexture((a,), (b,))


def _scaled(value, factor):
    if not varies(value):
        return _computed(np.multiply, value, factor)
    if not factor.any():
        return BLACK
    if (factor == 1).all():
        return as_texture(value)
    terms = terms_of(value)
    return LinearTexture(terms.textures, tuple(times(f, factor) for f in terms.factors), times(terms.offset, factor))


def added(a, b):
    """The sum of two values, as a colour."""
    if not (varies(a) or varies(b)):
        return _computed(np.add, a, b)
    for one, other in ((a, b), (b, a)):
        if not varies(one) and not np.any(one):
            return as_texture(other)
    a, b = terms_of(a), terms_of(b)
    sums = {}
    for texture, factor in (*zip(a.textures, a.factors), *zip(b.textures, b.factors)):
        sums[texture] = added(sums[texture], factor) if texture in sums else factor
    return LinearTexture(tuple(sums), tuple(sums.values()), added(a.offset, b.offset))


def cut(value):
    """`value` cut off to [0, 1]."""
    if varies(value):
        return LinearTexture((value,), (1.0,), is_clipped=True)
    return _constant(np.clip(value, 0, 1)) if isinstance(value, tuple) else min(max(value, 0.0), 1.0)


def root(value):
    """The square root of a colour."""
    if varies(value):
        return Gamma(cut(value), 0.5)
    return _constant(np.sqrt(np.maximum(np.broadcast_to(value, 3), 0)))


def inverted(value):
    """1 - `value`, as a colour."""
    return added(WHITE, times(value, -1.0))


def typical(value):
    """`value`, or the average of what varies: a number or (r, g, b)."""
    if not varies(value):
        return value
    mean = average_of(as_texture(value)).tolist()
    return mean[0] if len(mean) == 1 else tuple(mean)


def terms_of(value):
    """A value as a `LinearTexture` that is a sum of textures."""
    if not varies(value):
        return LinearTexture(offset=_constant(np.broadcast_to(np.asarray(value, np.float64), 3)))
    is_sum = isinstance(value, LinearTexture) and not value.is_clipped
    return value if is_sum else LinearTexture((value,), (1.0,))


def _constant(colour):
    return tuple(float(c) for c in colour)


def _computed(function, a, b):
    """What may be infinite, or no number, is told once it is known what for."""
    with np.errstate(invalid="ignore", over="ignore"):
        return _constant(np.broadcast_to(function(a, b), 3))
