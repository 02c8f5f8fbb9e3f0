"""What rough surfaces of GGX's microfacets reflect on the whole, and lobes as wide as theirs.

alpha = roughness^2, as Blender's. Microfacets are seen with the density of visible normals (Heitz 2018, "Sampling the GGX
Distribution of Visible Normals", JCGT 7(4)), and what they reflect is masked by w = G2 / G1 = (1 + L(wo)) / (1 + L(wo) + L(wi))
with Smith's L (Walter et al. 2007, eq. 34; Heitz 2014, eq. 99). Means over the visible normals h, with c = wo . h:

    A = E[w]    P = E[w (1 - c)^5]    Q = E[w c (1 - c)^6]    F = E[w F(c)], exact Fresnel    V = E[F(c)]

    B = E[w F(c) + w' (1 - F(c))]        a boundary: w' is w of the refracted direction, 0 where that comes back

Whatever is linear in them (Schlick's Fresnel, its F82 tint, glass) has its albedo by them.

A lobe cos^n about an axis has half of its light within the angle d of it where cos(d)^(n + 1) = 1 / 2. Seen from above, half of
what GGX reflects into the hemisphere has tan(h)^2 <= alpha^2 / (1 + 2 alpha^2), and d = 2 h:

    n = ln 2 / ln((1 + 3 alpha^2) / (1 + alpha^2)) - 1                   0 for alpha = 1, (ln 2 / 2) / alpha^2 for small ones

and half of what it refracts has tan(h)^2 <= alpha^2, and d = h - asin(sin(h) / eta) by Snell's law.
"""

from functools import lru_cache

import numpy as np

from .fresnel import fresnel_dielectric, refracted_cosine
from .lobes import LARGEST_EXPONENT

COSINES, _ROUGHNESSES, _STRATA = 24, 17, 24
"""Entries of the tables; those of the cosine are at even steps of its root, from 0 to 1."""
_NAMES = ("A", "P", "Q")
_INDEX_STEPS = 49
_MOST_F0 = 0.75
"""sqrt(F0) of the largest index in the table, 7, and of the smallest, 1 / 7."""


def exponent_of_reflection(roughness):
    """The exponent n of the reflected lobe, for Blender's roughness in [0, 1]; at most LARGEST_EXPONENT."""
    a2 = np.square(np.square(np.clip(roughness, 0, 1)))
    return _exponent(-np.log1p(2 * a2 / (1 + a2)))


def alpha2_of_exponent(exponent):
    """Roughness^4 of the reflected lobe with this exponent: the inverse of `exponent_of_reflection`."""
    turn = np.expm1(np.log(2) / (exponent + 1))
    # cos of the median angle is 2^(-1 / (n + 1)), and (1 + a^2) / (1 + 3 a^2).
    return (turn / (2 - turn)).astype(exponent.dtype)


def exponent_of_refraction(roughness, eta):
    """The exponent n of the refracted lobe; eta is the index behind the surface over that before it."""
    alpha = np.square(np.clip(roughness, 0, 1))
    h = np.arctan(alpha)
    turn = np.minimum(np.abs(h - np.arcsin(np.minimum(np.sin(h) / eta, 1))), np.pi / 3)
    return _exponent(np.log1p(-2 * np.sin(turn / 2) ** 2))


def _exponent(log_cos):
    with np.errstate(divide="ignore"):
        return np.clip(-np.log(2) / log_cos - 1, 0, LARGEST_EXPONENT).astype(np.float32)


def moment(name, cos, roughness):
    """A, P or Q float32 (N,) at cosines (N,) of wo to the normal."""
    return _looked_up(_moments()[name], (_place(np.sqrt(np.abs(cos)), COSINES), _place(roughness, _ROUGHNESSES)))


def fresnel_moment(name, cos, roughness, eta):
    """F or V float32 (N,) for the index eta (N,) behind the surface over that before it."""
    index, table = _around(_index_place(eta), lambda i: _fresnel_row(i)[name])
    return _looked_up(table, (index, _place(np.sqrt(np.abs(cos)), COSINES), _place(roughness, _ROUGHNESSES)))


def mean_albedo(roughness):
    """The mean (N,) of A over all wo, weighted by their cosines."""
    return _looked_up(_mean_a(), (_place(roughness, _ROUGHNESSES),))


def boundary(cos, roughness, eta):
    """B float32 (N,), and its mean (N,) over all wo, weighted by their cosines."""
    rough, place = _place(roughness, _ROUGHNESSES), _index_place(eta)
    index, table = _around(place, _boundary_row)
    _, means = _around(place, _mean_b)
    return _looked_up(table, (index, _place(np.sqrt(np.abs(cos)), COSINES), rough)), _looked_up(means, (index, rough))


def _around(place, row):
    """A place among the indices of refraction, and the part of a table around it: `row`(i) each, worked out when first asked for."""
    low, share = place
    first, last = (int(low.min()), int(low.max())) if low.size else (0, 0)
    return (low - first, share), np.stack([row(i) for i in range(first, last + 2)])


def _index_place(eta):
    return _place((eta - 1) / (eta + 1) / np.float32(2 * _MOST_F0) + np.float32(0.5), _INDEX_STEPS)


def _place(x, count):
    """Indices and shares of the two entries beside x, 0 to 1, in a row of `count` entries."""
    x = np.clip(np.nan_to_num(x), 0, 1) * np.float32(count - 1)
    low = np.minimum(x.astype(np.int32), count - 2)
    return low, (x - low).astype(np.float32)


def _looked_up(table, places):
    """Multilinear interpolation."""
    total = 0
    for corner in range(2 ** len(places)):
        index, share = (), np.float32(1)
        for axis, (low, t) in enumerate(places):
            up = corner >> axis & 1
            index, share = (*index, low + up), share * (t if up else 1 - t)
        total = total + table[index] * share
    return total


@lru_cache(maxsize=1)
def _visible():
    """c, cosines of wo, cosines of the normals, and w as a function of the cosine of wi, of stratified visible normals.

    Arrays broadcast to (cosines, roughnesses, samples).
    """
    u = (np.arange(_STRATA) + 0.5) / _STRATA
    u1, u2 = (a.reshape(1, 1, -1) for a in np.meshgrid(u, u))
    cos = np.square(np.linspace(0.5 / COSINES**2, 1, COSINES)).reshape(-1, 1, 1)
    alpha = np.square(np.linspace(0, 1, _ROUGHNESSES)).reshape(1, -1, 1)
    sin = np.sqrt(1 - cos * cos)
    # Heitz 2018, listing 1, with wo in the plane of x and z.
    v = np.stack(np.broadcast_arrays(alpha * sin, 0 * alpha, cos))
    v /= np.linalg.norm(v, axis=0)
    r, phi = np.sqrt(u1), 2 * np.pi * u2
    t1, t2, s = r * np.cos(phi), r * np.sin(phi), 0.5 * (1 + v[2])
    t2 = (1 - s) * np.sqrt(1 - t1 * t1) + s * t2
    t3 = np.sqrt(np.maximum(1 - t1 * t1 - t2 * t2, 0))
    # T1 = y and T2 = v x T1.
    x, z = v[0] * t3 - v[2] * t2, v[0] * t2 + v[2] * t3
    h = np.stack(np.broadcast_arrays(alpha * x, alpha * t1, np.maximum(z, 0)))
    h /= np.maximum(np.linalg.norm(h, axis=0), np.finfo(float).tiny)
    c = np.clip(sin * h[0] + cos * h[2], 0, 1)

    def smith(z):
        z2 = np.square(np.maximum(z, np.finfo(np.float32).tiny))
        return 0.5 * (np.sqrt(1 + alpha * alpha * (1 - np.minimum(z2, 1)) / z2) - 1)

    return c, cos, h[2], lambda z: np.where(z > 0, (1 + smith(cos)) / (1 + smith(cos) + smith(z)), 0)


@lru_cache(maxsize=1)
def _reflected():
    """c and w of what the visible normals reflect."""
    c, cos, up, masked = _visible()
    return c, masked(2 * c * up - cos)


@lru_cache(maxsize=1)
def _moments():
    c, w = _reflected()
    values = (w, w * (1 - c) ** 5, w * c * (1 - c) ** 6)
    return {name: value.mean(axis=-1).astype(np.float32) for name, value in zip(_NAMES, values)}


@lru_cache(maxsize=1)
def _mean_a():
    return _mean(_moments()["A"])


@lru_cache(maxsize=_INDEX_STEPS)
def _fresnel_row(i):
    """F and V (COSINES, _ROUGHNESSES) float32 for an index of refraction."""
    c, w = _reflected()
    share = _share(c, _index(i))
    return {"F": (w * share).mean(axis=-1).astype(np.float32), "V": share.mean(axis=-1).astype(np.float32)}


@lru_cache(maxsize=_INDEX_STEPS)
def _boundary_row(i):
    """B (COSINES, _ROUGHNESSES) float32 for an index of refraction."""
    (c, cos, up, masked), (_, reflected), eta = _visible(), _reflected(), _index(i)
    share = _share(c, eta)
    down = cos / eta + (refracted_cosine(c, eta) - c / eta) * up
    return (reflected * share + masked(down) * (1 - share)).mean(axis=-1).astype(np.float32)


@lru_cache(maxsize=_INDEX_STEPS)
def _mean_b(i):
    return _mean(_boundary_row(i))


def _mean(values):
    """The mean (_ROUGHNESSES,) of A or B (COSINES, _ROUGHNESSES) over all wo, weighted by their cosines."""
    # The tables' steps are those of the root of the cosine: d(cos^2) is in proportion to its cube.
    return np.average(values, axis=0, weights=np.linspace(0, 1, COSINES) ** 3).astype(np.float32)


def _index(i):
    root = np.linspace(-_MOST_F0, _MOST_F0, _INDEX_STEPS)[i]
    return (1 + root) / (1 - root)


def _share(c, eta):
    """What a boundary reflects at cosines c; one between equal media nothing."""
    return fresnel_dielectric(c, eta) if eta != 1 else (c <= 0) * 1.0
