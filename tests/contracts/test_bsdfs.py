"""What every BSDF promises (`interfaces.Bsdf`), checked for every class in the registry.

A new BSDF is checked with its default parameters without asking; EXAMPLES adds extremes of the known ones. Each law
is a function, so that the same function can be shown to refuse a broken BSDF.
"""

import dataclasses

import numpy as np
import pytest

from glanz.engine import BlinnPhong, Lambert, Phong, PhongLecture, SceneError
from glanz.engine.interfaces import Bsdf
from glanz.engine.maths.frames import to_world
from glanz.engine.maths.vectors import cosine_power, dot, reflect
from glanz.engine.maths.warps import square_to_cosine_power
from glanz.engine.registry import BSDFS
from glanz.tests import helpers as h

EXPONENTS = (0.0, 0.5, 1.0, 10.0, 1e3, 1e6)
EXAMPLES = {
    "lambert": [Lambert((1.0, 0.5, 0.25))],
    **{bsdf.key: [bsdf((0.5, 0.25, 0.125), n) for n in EXPONENTS] for bsdf in (Phong, PhongLecture, BlinnPhong)},
}
ALL = [value for key, plugin in BSDFS.items() if not plugin.is_specular for value in EXAMPLES.get(key, [plugin()])]
NORMAL = h.unit(0.3, -0.5, 0.8)
ANGLES = (0.0, 0.7, 1.3, np.pi / 2 - 1e-5)

each = pytest.mark.parametrize("value", ALL, ids=lambda v: f"{v.key}-{getattr(v, 'exponent', '')}")


def viewer(angle, dtype=np.float64):
    """wo (3, 1) at `angle` from NORMAL."""
    return to_world(NORMAL, h.at_angle(angle, 1.0)).astype(dtype)


def white(value):
    """`value` with a colour of 1: not always a physical one, see `check_no_more_leaves_than_albedo_says`."""
    return dataclasses.replace(value, reflectance=(1.0, 1.0, 1.0))


def side(value):
    """The side of the surface on which light counts: 1 that of the viewer, -1 the other."""
    return -1 if value.transmits else 1


class About:
    """Directions by q = 1 - cos of the angle to `axis` (3, 1), and azimuth phi."""

    def __init__(self, axis):
        self.axis, self.frame = axis, h.frame_towards(axis[:, 0])

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
    candidates = [About(NORMAL), About(reflect(wo, NORMAL)), About(-wo), HalfWay(NORMAL, wo)]
    integrals = [quadrature(lambda w: value.pdf(k, NORMAL, wo, w), c, LADDER, 4).sum() for c in candidates]
    return sorted(zip(np.abs(np.array(integrals) - 1), candidates), key=lambda pair: pair[0])


def check_density_integrates_to_one(value):
    k = h.table(value.row())
    for angle in ANGLES:
        error = smooth_coordinates(value, k, viewer(angle))[0][0]
        assert error <= 1e-8, (angle, error)


def check_samples_follow_the_density(value, n=100_000):
    k = h.table(value.row())
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
    """wo (3, n) above the horizon and wi (3, n) where light counts, half of them where the BSDF samples."""
    wo = h.directions(4, n)
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
    # Directions are rounded to 1e-16, which a sharp lobe sees n times larger.
    is_reciprocal = (np.abs(there - back) <= 1e-11 * there.max(axis=0)).all()
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
        assert 0 <= albedo <= value.albedo()[0] * (1 + 1e-9), (angle, albedo)


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


@each
def test_a_bsdf_offers_the_interface(value):
    assert isinstance(value, Bsdf)
    assert BSDFS[value.key] is type(value)
    assert value.__doc__.strip()
    value.check("wood")
    assert len(value.albedo()) == 3


@each
def test_density_integrates_to_one_with_its_part_below_the_horizon(value):
    """Detects 1e-8 of the whole."""
    check_density_integrates_to_one(value)


@each
def test_samples_follow_the_density(value):
    """chi2 in 32 x 32 bins, 1e5 samples for each of 4 viewers; detects 4 % of the density in half of the bins."""
    check_samples_follow_the_density(value)


@each
def test_density_and_value_are_never_negative(value):
    check_density_is_never_negative(value)


@each
def test_light_may_travel_either_way_where_declared(value):
    """C6, and what is declared irreciprocal really is."""
    check_reciprocity(value)


@each
def test_no_more_light_leaves_than_albedo_says(value):
    """C7: by quadrature up to 1e-7 from grazing; detects a gain of 1e-9. That materials sum up to 1 is for `validate`."""
    check_no_more_leaves_than_albedo_says(value)


@each
def test_dtype_is_kept(value):
    check_dtype_is_kept(value)


@each
def test_lanes_are_independent(value):
    check_lanes_are_independent(value)


@each
def test_nothing_is_nan_at_the_corners_of_the_unit_square(value):
    """Numbers 0 and the largest float32 below 1, seen straight, grazing and from the horizon itself."""
    u = np.array([0, 2.0**-24, 0.5, 1 - 2.0**-24], np.float32)
    u2 = np.stack(np.meshgrid(u, u)).reshape(2, -1)
    for angle in (*ANGLES, np.pi / 2):
        k, n = h.table(value.row(), np.float32), np.repeat(NORMAL, 16, 1).astype(np.float32)
        wo = np.repeat(viewer(angle, np.float32), 16, 1)
        wi = value.sample(k, n, wo, u2)
        assert np.isfinite(wi).all()
        assert np.isfinite(value.eval(k, n, wo, wi)).all()
        assert np.isfinite(value.pdf(k, n, wo, wi)).all()


@pytest.mark.parametrize("bsdf", [b for b in BSDFS.values() if "exponent" in {f.name for f in dataclasses.fields(b)}])
def test_parameters_out_of_range_are_refused_by_name(bsdf):
    for exponent in (-1.0, 1e7, float("nan")):
        with pytest.raises(SceneError, match=r"material 'brass': Phong exponent is (-1.0|10000000.0|nan)"):
            bsdf(exponent=exponent).check("brass")


# Mutants: what each law must refuse.


def phong_with(**changes):
    return mutant_of(Phong((1.0, 1.0, 1.0), 10.0), **changes)


def mutant_of(value, **changes):
    functions = {name: staticmethod(f) if callable(f) else f for name, f in changes.items()}
    return type("Mutant", (type(value),), functions)(**vars(value))


def _pdf_of_another_exponent(k, n, wo, wi):
    return Phong.pdf(h.table({"exponent": 11.0}), n, wo, wi)


def _sample_about_normal(k, n, wo, u2):
    return to_world(n, square_to_cosine_power(u2, k.exponent))


def _sample_of_half_the_turn(k, n, wo, u2):
    return Phong.sample(k, n, wo, u2 * np.array([[1.0], [0.5]]))


def _unnormalised(k, n, wo, wi):
    return k.exponent * cosine_power(reflect(wo, n), wi, k.exponent) / (2 * np.pi)


def _one_way(k, n, wo, wi):
    return Phong.eval(k, n, wo, wi) * dot(n, wo)


def _a_little_more(k, n, wo, wi):
    return Phong.eval(k, n, wo, wi) * (1 + 1e-6)


def _double(k, n, wo, wi):
    return Phong.pdf(k, n, wo, wi) * np.ones(1)


def _of_the_batch(k, n, wo, wi):
    return Phong.pdf(k, n, wo, wi) + wi[0].mean()


def _without_the_jacobian(k, n, wo, wi):
    return BlinnPhong.pdf(k, n, wo, wi) * (2 * np.linalg.norm(wo + wi, axis=0))


def _jacobian_of_the_other_cosine(k, n, wo, wi):
    return BlinnPhong.pdf(k, n, wo, wi) * np.linalg.norm(wo + wi, axis=0) / 2 / np.abs(dot(n, wi))


def _below_zero(k, n, wo, wi):
    return (k.exponent + 1) / (2 * np.pi) * dot(reflect(wo, n), wi) ** 11


@pytest.mark.parametrize(
    ("law", "mutant"),
    [
        (check_density_integrates_to_one, {"pdf": _unnormalised}),
        (check_samples_follow_the_density, {"pdf": _pdf_of_another_exponent}),
        (check_samples_follow_the_density, {"sample": _sample_about_normal}),
        (check_samples_follow_the_density, {"sample": _sample_of_half_the_turn}),
        (check_density_is_never_negative, {"pdf": _below_zero}),
        (check_reciprocity, {"eval": _one_way}),
        (check_reciprocity, {"is_reciprocal": False}),
        (check_no_more_leaves_than_albedo_says, {"eval": _a_little_more}),
        (check_dtype_is_kept, {"pdf": _double}),
        (check_lanes_are_independent, {"pdf": _of_the_batch}),
    ],
    ids=lambda x: x.__name__ if callable(x) else "-".join(getattr(f, "__name__", str(f)) for f in x.values()),
)
def test_the_contract_catches_a_broken_bsdf(law, mutant):
    with pytest.raises(AssertionError):
        law(phong_with(**mutant))


BLINN, LECTURE = BlinnPhong((1.0, 1.0, 1.0), 10.0), PhongLecture((0.5, 0.5, 0.5), 10.0)


def _one_percent_more(k, n, wo, wi):
    return BlinnPhong.eval(k, n, wo, wi) * 1.01


@pytest.mark.parametrize(
    ("law", "value", "mutant"),
    [
        (check_density_integrates_to_one, BLINN, {"pdf": _without_the_jacobian}),
        (check_density_integrates_to_one, BLINN, {"pdf": _jacobian_of_the_other_cosine}),
        (check_samples_follow_the_density, BLINN, {"pdf": Phong.pdf}),
        (check_no_more_leaves_than_albedo_says, BLINN, {"eval": _one_percent_more}),
        (check_no_more_leaves_than_albedo_says, LECTURE, {"albedo": lambda: (1.0, 1.0, 1.0)}),
        (check_reciprocity, LECTURE, {"eval": Phong.eval}),
    ],
    ids=lambda x: x.__name__ if callable(x) else None,
)
def test_the_contract_catches_a_broken_variant(law, value, mutant):
    law(value)
    with pytest.raises(AssertionError):
        law(mutant_of(value, **mutant))
