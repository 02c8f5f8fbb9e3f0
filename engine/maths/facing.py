"""How surfaces face who looks at them, and directions along them."""

import numpy as np

from .fresnel import fresnel_dielectric
from .vectors import cross, dot, length

_TINY = np.finfo(np.float32).tiny
_LEAST = np.float32(2.0**-17)
"""Of an index of refraction: about Cycles' 1e-5, below which it would be divided by 0. Above its inverse all is reflected, to 3e-5."""


def schlick_facing(cos, blend):
    """1 - |cos|^e (N,), 0 where a surface faces the viewer and 1 at its rim: Cycles' Facing of a layer weight.

    e is 2 b for a blend b below 1/2 and 1 / (2 (1 - b)) above: from all over the surface to the rim alone.
    """
    blend = np.clip(blend, 0, 1 - _LEAST)
    exponent = np.where(blend < 0.5, 2 * blend, 0.5 / (1 - blend))
    with np.errstate(over="ignore"):
        return 1 - np.abs(cos) ** exponent


def facing_fresnel(cos, ior, is_front):
    """The share (N,) of light that a dielectric of index `ior` reflects, seen from outside where it is_front, else from inside."""
    ior = np.clip(ior, _LEAST, 1 / _LEAST)
    return fresnel_dielectric(np.abs(cos), np.where(is_front, ior, 1 / ior))


def mirrored(d, n):
    """The direction (3, N) into which a mirror of normal n sends the ray along d (3, N)."""
    return d - (2 * dot(d, n)) * n


def upright(tangent, n):
    """Vectors (3, N) as unit tangents of surfaces with normals n (3, N); 0 where they are along the normal."""
    return unit(tangent - dot(tangent, n) * n)


def around(p, axis):
    """Vectors (3, N) around the middle (1/2, 1/2, 1/2) of points p (3, N) of the unit cube, about the axis "x", "y" or "z"."""
    x, y, z = p - np.float32(0.5)
    none = np.zeros_like(x)
    return np.stack({"x": (none, -z, y), "y": (-z, none, x), "z": (-y, x, none)}[axis])


def unit(a):
    """Unit vectors along a (3, N); 0 stays 0."""
    return a / np.maximum(length(a), _TINY)


def turned(rows, a):
    """a (3, N) times the transposed linear part of matrices, whose rows of four are `rows` (12, N).

    Of world_from_object: what carries normals into the object's space, of object_from_world: back.
    """
    return rows[0:3] * a[0] + rows[4:7] * a[1] + rows[8:11] * a[2]


def across(n):
    """Two unit vectors (3, N) at right angles to the unit vectors n (3, N) and to each other, as Cycles has them."""
    x, y, z = n
    # What has three equal components would have none.
    is_even = (x == y) & (x == z)
    right = unit(np.stack((z - y, np.where(is_even, x + z, x - z), np.where(is_even, -y - x, y - x))))
    return right, cross(n, right)


def raised(ns, right, up, slopes, strength):
    """Normals (3, N) of surfaces with normals ns that rise by `slopes`, two (N,), along `right` and `up`, unit (3, N).

    By the surface gradient of the height (Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU", eq. 4), mixed
    with ns by 1 - strength. Where nothing rises ns, to the bit.
    """
    sides = cross(up, ns), cross(ns, right)
    determinant = dot(right, sides[0])
    gradient = slopes[0] * sides[0] + slopes[1] * sides[1]
    normal = unit(np.abs(determinant) * ns - np.sign(determinant) * gradient)
    normal = unit(strength * normal + (1 - strength) * ns)
    return np.where((slopes[0] != 0) | (slopes[1] != 0), normal, ns)
