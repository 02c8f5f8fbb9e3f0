"""Colours that are constants (r, g, b) or textures, and what can be computed with them before rendering."""

import numpy as np

from ...engine import TEXTURES, LinearTexture

WHITE, BLACK = (1.0, 1.0, 1.0), (0.0, 0.0, 0.0)
LUMINANCE = (0.2126, 0.7152, 0.0722)


def is_texture(colour):
    """Whether a colour is known only point by point."""
    return type(colour) in TEXTURES.values()


def times(colour, factor):
    """`colour` times a number or (r, g, b)."""
    factor = np.broadcast_to(np.asarray(factor, np.float64), 3)
    if not is_texture(colour):
        return _constant(np.multiply(colour, factor))
    if (factor == 1).all():
        return colour
    terms = _terms(colour)
    return LinearTexture(terms.textures, tuple(_constant(np.multiply(f, factor)) for f in terms.factors), _constant(terms.offset * factor))


def added(a, b):
    """The sum of two colours."""
    if not (is_texture(a) or is_texture(b)):
        return _constant(np.add(a, b))
    for one, other in ((a, b), (b, a)):
        if not is_texture(one) and not any(one):
            return other
    a, b = _terms(a), _terms(b)
    return LinearTexture(a.textures + b.textures, a.factors + b.factors, _constant(np.add(a.offset, b.offset)))


def cut(colour):
    """`colour` cut off to [0, 1]."""
    if not is_texture(colour):
        return _constant(np.clip(colour, 0, 1))
    low, high = colour.bounds()
    return colour if min(low) >= 0 and max(high) <= 1 else LinearTexture((colour,), (WHITE,), is_clipped=True)


def inverted(texture):
    """1 - `texture`."""
    return added(WHITE, times(texture, -1))


def typical(colour):
    """`colour`, or the average of a texture, (r, g, b)."""
    return colour.average() if is_texture(colour) else colour


def most(colour):
    """`colour`, or the largest value of a texture, (r, g, b)."""
    return colour.bounds()[1] if is_texture(colour) else colour


def _terms(colour):
    if not is_texture(colour):
        return LinearTexture(offset=_constant(colour))
    is_sum = isinstance(colour, LinearTexture) and not colour.is_clipped
    return colour if is_sum else LinearTexture((colour,), (WHITE,))


def _constant(colour):
    return tuple(float(c) for c in colour)
