"""The laws of BSDFs with a width (`interfaces.Bsdf`), as functions: they hold for every one, and refuse a broken one."""

import dataclasses
import math

import numpy as np

from glanz.engine.interfaces import albedo_of
from glanz.engine.maths.frames import to_world
from glanz.engine.maths.vectors import dot, reflect
from glanz.tests import chance, helpers as h

NORMAL = h.unit(0.3, -0.5, 0.8)
ANGLES = (0.0, 0.7, 1.3, np.pi / 2 - 1e-5)


def viewer(angle, dtype=np.float64):
    """wo (3, 1) at `angle` from NORMAL."""
    return to_world(NORMAL, h.at_angle(angle, 1.0)).astype(dtype)


def white(value):
    """`value` with a colour of 1: not always a physical one, see `check_no_more_leaves_than_albedo_says`."""
    return dataclasses.replace(value, **{"transmittance" if value.transmits else "reflectance": (1.0, 1.0, 1.0)})


def side(value):
    """The side of the surface on which light counts: 1 that of the viewer, -1 the other."""
    return -1 if value.transmits else 1


class About:
    """Directions by q = 1 - cos of the angle to `axis` (3, 1), and azimuth phi, counted from `start` (3, 1) or anywhere."""

    def __init__(self, axis, start=None):
        self.axis, self.frame = axis, h.frame_towards(axis[:, 0])
        if start is not None and np.linalg.norm(start - axis) > 1e-6:
            y = np.cross(axis[:, 0], start[:, 0])
            y /= np.linalg.norm(y)
            self.frame = np.stack((np.cross(y, axis[:, 0]), y, axis[:, 0]), axis=1)

    def at(self, q, phi):
        """Unit vectors (3, ...), and solid angle per dq dphi."""
        sin = np.sqrt(q * (2 - q))
        local = np.stack(np.broadcast_arrays(sin * np.cos(phi), sin * np.sin(phi), 1 - q))
        return (self.frame @ local.reshape(3, -1)).reshape(local.shape), 1.0

    def of(self, w):
        """(q, phi) of unit vectors (3, N)."""
        local = self.frame.T @ w
        difference = w - self.axis
        return 0.5 * (difference**2).sum(axis=0), np.arctan2(local[1], local[0])


class HalfWay(About):
    """The same of the half vector between directions and `wo`; mirrored about h they have 4 |wo . h| of its solid angle."""

    def __init__(self, axis, wo):
        super().__init__(axis)
        self.wo = wo

    def at(self, q, phi):
        half, _ = super().at(q, phi)
        cos = np.einsum("i,i...->...", self.wo[:, 0], half)
        # h and -h mirror alike: the lower half would count everything twice.
        return 2 * cos * half - self.wo.reshape(3, *[1] * (half.ndim - 1)), 4 * np.abs(cos) * (q <= 1)

    def of(self, w):
        half = w + self.wo
        half /= np.linalg.norm(half, axis=0) * np.copysign(1, dot(self.axis, half))
        return super().of(half)


def quadrature(function, coordinates, q_edges, phi_bins, order=12):
    """Integral of function(w) over each cell of solid angle between q_edges and phi_bins equal sectors of `coordinates`."""
    x, weight = np.polynomial.legendre.leggauss(order)
    phi_edges = np.linspace(-np.pi, np.pi, phi_bins + 1)
    half_q, half_phi = np.diff(q_edges) / 2, np.diff(phi_edges) / 2
    q = (q_edges[:-1] + half_q)[:, None] + half_q[:, None] * x
    phi = (phi_edges[:-1] + half_phi)[:, None] + half_phi[:, None] * x
    w, stretch = coordinates.at(q[:, None, :, None], phi[None, :, None, :])
    values = function(w.reshape(3, -1)).reshape(w.shape[1:]) * stretch
    return np.einsum("abij,i,j->ab", values, weight, weight) * half_q[:, None] * half_phi


LADDER = np.unique(np.concatenate(([0.0, 2.0], 2.0 ** -np.arange(0, 44), 1 - 2.0 ** -np.arange(1, 40), 1 + 2.0 ** -np.arange(1, 20))))
"""Edges that close in on 0, where sharp lobes live, and on 1, where lobes have their edge."""


def smooth_coordinates(value, k, wo):
    """Coordinates by how well they suit the pdf, best first: (error of its integral, which is 1, coordinates)."""
    candidates = [About(NORMAL, wo), About(reflect(wo, NORMAL)), About(-wo), HalfWay(NORMAL, wo)]
    integrals = [quadrature(lambda w: value.pdf(k, NORMAL, wo, w), c, LADDER, 4).sum() for c in candidates]
    return sorted(zip(np.abs(np.array(integrals) - 1), candidates), key=lambda pair: pair[0])


def check_density_integrates_to_one(value):
    k = h.table(value.row())
    for angle in ANGLES:
        error = smooth_coordinates(value, k, viewer(angle))[0][0]
        assert error <= 1e-8, (angle, error)


def check_samples_follow_the_density(value, n=100_000):
    k, n = h.table(value.row()), chance.times(n)
    for seed, angle in enumerate(ANGLES):
        wo = viewer(angle)
        coordinates = smooth_coordinates(value, k, wo)[0][1]

        def draw(seed, wo=wo, coordinates=coordinates):
            w = value.sample(k, np.repeat(NORMAL, n, 1), np.repeat(wo, n, 1), h.uniform(seed, n))
            assert np.isfinite(w).all()
            assert np.abs(np.linalg.norm(w, axis=0) - 1).max() <= 1e-12
            return w, *coordinates.of(w)

        # Bins of equal counts in an independent sample; then ever larger ones, with an edge where lobes end, for quadrature's sake.
        edges = np.quantile(draw(seed + 100)[1], np.linspace(0, 1, 33)[1:-1])
        edges = np.unique(np.concatenate(([0.0], edges, np.minimum(edges[-1] * 1.3 ** np.arange(1, 120), 2.0), [1.0, 2.0])))
        w, q, phi = draw(seed)
        observed = np.histogram2d(q, phi, (edges, np.linspace(-np.pi, np.pi, 33)))[0]
        expected = n * quadrature(lambda w, wo=wo: value.pdf(k, NORMAL, wo, w), coordinates, edges, 32, order=8)
        assert h.chi2_p(observed, expected) > h.ALPHA, angle
        assert (value.pdf(k, NORMAL, wo, w) > 0).all()


def check_density_is_never_negative(value):
    k = h.table(value.row())
    w = h.directions(3, 20_000)
    for angle in ANGLES:
        density = value.pdf(k, NORMAL, viewer(angle), w)
        assert density.shape == (20_000,)
        assert (density >= 0).all()
        assert (value.eval(k, NORMAL, viewer(angle), w) >= 0).all()


def pairs(value, k, n=10_000):
    """wo (3, n) above the horizon, some near to grazing, and wi (3, n) where light counts, half of them where the BSDF samples."""
    wo = h.directions(4, n)
    for i, grazing in enumerate((1e-3, 1e-5, 1e-7)):
        along = wo[:, i::8] - dot(NORMAL, wo[:, i::8]) * NORMAL
        wo[:, i::8] = math.sin(grazing) * NORMAL + math.cos(grazing) * along / np.linalg.norm(along, axis=0)
    wo *= np.sign(dot(NORMAL, wo))
    wi = value.sample(k, np.repeat(NORMAL, n, 1), wo, h.uniform(5, n))
    wi[:, ::2] = h.directions(6, n)[:, ::2]
    return wo, wi * np.sign(dot(NORMAL, wi)) * side(value)


def there_and_back(value):
    """f (3, n) of pairs of directions, and with the two exchanged."""
    k = h.table(value.row())
    wo, wi = pairs(value, k)
    there = value.eval(k, NORMAL, wo, wi)
    # Seen from the side of wi, whose normal is the other one where light passes the surface.
    back = value.eval(k, NORMAL * side(value), wi, wo)
    return np.broadcast_to(there, wo.shape), np.broadcast_to(back, wo.shape)


def check_reciprocity(value):
    there, back = there_and_back(value)
    assert there.max() > 0
    # Directions are rounded to 1e-16, which a sharp lobe sees n times larger, and a cosine near 0 not at all.
    is_reciprocal = (np.abs(there - back) <= 1e-11 * there.max(axis=0) + 1e-15 * there.max()).all()
    assert is_reciprocal == value.is_reciprocal


def check_no_more_leaves_than_albedo_says(value):
    value = white(value)
    k = h.table(value.row())
    for angle in (*np.linspace(0, 1.5, 9), *(np.pi / 2 - np.array([1e-2, 1e-3, 1e-5, 1e-7]))):
        wo = viewer(angle)

        def leaving(w, wo=wo):
            f = np.broadcast_to(value.eval(k, NORMAL, wo, w), w.shape)
            return f[0] * np.maximum(side(value) * dot(NORMAL, w), 0)

        # In those coordinates that do not miss the lobe, and in which the integral converges best.
        fitting = [c for error, c in smooth_coordinates(value, k, wo) if error <= 0.1]
        integrals = [[quadrature(leaving, c, LADDER, 24, order).sum() for order in (5, 6)] for c in fitting]
        albedo = min(integrals, key=lambda pair: abs(pair[1] - pair[0]))[1]
        assert 0 <= albedo <= albedo_of(value)[0] * (1 + 1e-9), (angle, albedo)


def check_dtype_is_kept(value):
    for dtype in (np.float32, np.float64):
        k, n, wo, u2 = h.table(value.row(), dtype), np.repeat(NORMAL, 5, 1).astype(dtype), h.directions(1, 5, dtype), h.uniform(2, 5, dtype)
        wi = value.sample(k, n, wo, u2)
        assert wi.dtype == dtype
        assert value.eval(k, n, wo, wi).dtype == dtype
        assert value.pdf(k, n, wo, wi).dtype == dtype


def check_lanes_are_independent(value):
    """One lane alone gives the bits that it gives among others."""
    n = 1_003
    k, normal, wo, u2 = (
        h.table(value.row(), np.float32),
        h.directions(1, n, np.float32),
        h.directions(2, n, np.float32),
        h.uniform(3, n, np.float32),
    )
    wi = value.sample(k, normal, wo, u2)
    f, pdf = np.broadcast_to(value.eval(k, normal, wo, wi), wi.shape), value.pdf(k, normal, wo, wi)
    for lane in (0, 1, 7, 500, n - 1):
        one = [np.ascontiguousarray(a[:, lane : lane + 1]) for a in (normal, wo, u2)]
        alone = value.sample(k, *one)
        assert h.same_bits(alone, wi[:, lane : lane + 1]), lane
        assert h.same_bits(np.broadcast_to(value.eval(k, one[0], one[1], alone), (3, 1)), f[:, lane : lane + 1]), lane
        assert h.same_bits(value.pdf(k, one[0], one[1], alone), pdf[lane : lane + 1]), lane
