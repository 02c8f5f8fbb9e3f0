"""What every light promises (`interfaces.Light`), checked for every class in the registry, and for what it is made with.

A new light is checked with its default parameters without asking; EXAMPLES adds the forms of the known ones.
"""

import math

import numpy as np
import pytest

from glanz.engine import AreaLight, CosineSpotLight, PointLight, SpotLight, SunLight
from glanz.engine.interfaces import Light
from glanz.engine.maths import bulbs
from glanz.engine.maths.vectors import dot
from glanz.engine.registry import LIGHTS
from glanz.tests import chance, helpers as h

ABOVE = (0.4, -0.3, 2.0)
DOWN = h.affine(h.frame_towards((0.1, 0.2, 1.0)), ABOVE)
COLOUR = (3.0, 2.0, 1.0)
EXAMPLES = {
    "point": [
        PointLight(position=ABOVE, intensity=COLOUR),
        PointLight(position=ABOVE, intensity=COLOUR, radius=0.7),
        PointLight(position=ABOVE, intensity=COLOUR, radius=1e-3),
        PointLight(position=ABOVE, intensity=COLOUR, radius=0.7, soft_falloff=False),
        PointLight(position=ABOVE, intensity=COLOUR, radius=1e-4, soft_falloff=False),
        PointLight(position=ABOVE, intensity=COLOUR, radius=9.0, soft_falloff=False),
    ],
    "spot": [
        SpotLight(world_from_light=DOWN, intensity=COLOUR, angle=1.0, blend=0.5),
        SpotLight(world_from_light=DOWN, intensity=COLOUR, angle=1.0, blend=0.5, radius=0.3),
        SpotLight(world_from_light=DOWN, intensity=COLOUR, angle=1.0, blend=0.0, radius=0.3, soft_falloff=False),
    ],
    "cosine_spot": [
        CosineSpotLight(world_from_light=DOWN, intensity=COLOUR, exponent=0.0, radius=0.3),
        CosineSpotLight(world_from_light=DOWN, intensity=COLOUR, exponent=0.5),
        CosineSpotLight(world_from_light=DOWN, intensity=COLOUR, exponent=1e3),
        CosineSpotLight(world_from_light=DOWN, intensity=COLOUR, exponent=1e3, radius=0.3, soft_falloff=False),
    ],
    "sun": [SunLight(towards=(0.0, 0.6, 0.8), irradiance=COLOUR, angle=a) for a in (0.0, 1e-4, 0.0093, 1.0, math.pi)],
    "area": [
        AreaLight(world_from_light=DOWN, size_x=2.0, size_y=0.5, radiance=COLOUR),
        AreaLight(world_from_light=DOWN, size_x=2.0, size_y=0.5, radiance=COLOUR, is_ellipse=True),
        AreaLight(world_from_light=DOWN, size_x=1.0, size_y=1.0, radiance=COLOUR, spread=2.0),
        AreaLight(world_from_light=DOWN, size_x=0.01, size_y=0.01, radiance=COLOUR),
    ],
}
ALL = [value for key, plugin in LIGHTS.items() for value in EXAMPLES.get(key, [plugin()])]
EXTENDED = [value for value in ALL if value.has_extent()]
DELTA = [value for value in ALL if not value.has_extent()]
P = np.array([[0.1], [0.2], [-0.3]])
N = 40_000


def name(value):
    size = [getattr(value, f, None) for f in ("radius", "angle", "exponent", "size_x", "spread", "soft_falloff", "is_ellipse")]
    return "-".join([value.key, *(f"{s:.3g}" if isinstance(s, float) else str(s)[0] for s in size if s is not None)])


each = pytest.mark.parametrize("value", ALL, ids=name)
each_extended = pytest.mark.parametrize("value", EXTENDED, ids=name)
each_delta = pytest.mark.parametrize("value", DELTA, ids=name)


def sampled(value, n=N, seed=1, dtype=np.float64, p=P):
    """The table of `value`, points (3, n), numbers, and a sample for each."""
    k, p, u2 = h.table(value.row(h.UNIT_FRAME), dtype), np.repeat(p, n, 1).astype(dtype), h.uniform(seed, n, dtype)
    return k, p, u2, value.sample(k, p, u2)


def check_rays_meet_what_was_sampled(value):
    """C: a ray along wi meets the light at `distance`, with the density and the radiance that the sample claims."""
    k, p, _, (wi, distance, E, pdf) = sampled(value)
    assert np.abs(np.linalg.norm(wi, axis=0) - 1).max() <= 1e-12
    t, L, met_pdf = (np.broadcast_to(x, y.shape) for x, y in zip(value.hit(k, p, wi), (distance, E, pdf)))
    # Samples on the very rim may be missed by rounding.
    met = np.isfinite(t)
    assert met.mean() > 1 - 1e-3
    if np.isfinite(distance).any():
        assert (np.abs(t - distance)[met] <= 1e-6 * distance[met]).all()
    assert (np.abs(met_pdf / pdf - 1)[met] <= 1e-9).all()
    assert (np.abs(L - E * pdf)[:, met] <= 1e-9 * (E * pdf)[:, met] + 1e-300).all()
    assert (pdf > 0).all()


def check_samples_follow_the_density(value, n=N):
    """B2: sampled directions against the density that `hit` tells, in bins about the middle of the light."""
    k, p, _, (wi, _, _, _) = sampled(value, n, seed=2)
    middle = wi.mean(axis=1, keepdims=True)
    middle = middle / np.linalg.norm(middle) if np.linalg.norm(middle) > 0.01 else h.unit(0, 0, 1)
    frame = h.frame_towards(middle[:, 0])
    # In the plane across the middle, by gnomonic projection where the light fits into it, else by angle.
    local = frame.T @ wi
    q, phi = 0.5 * ((wi - middle) ** 2).sum(axis=0), np.arctan2(local[1], local[0])
    q_edges = np.unique(np.append(np.quantile(q, np.linspace(0, 1, 13)) * np.append(np.ones(12), 1.02), 0.0).clip(0, 2))
    phi_edges = np.linspace(-np.pi, np.pi, 13)
    observed = np.histogram2d(q, phi, (q_edges, phi_edges))[0]
    m = 48
    at = (np.arange(m) + 0.5) / m
    fine_q = (q_edges[:-1, None] + np.diff(q_edges)[:, None] * at).ravel()
    fine_phi = (phi_edges[:-1, None] + np.diff(phi_edges)[:, None] * at).ravel()
    sin = np.sqrt(fine_q * (2 - fine_q))[:, None]
    w = np.stack(np.broadcast_arrays(sin * np.cos(fine_phi), sin * np.sin(fine_phi), (1 - fine_q)[:, None])).reshape(3, -1)
    t, _, pdf = value.hit(k, p[:, :1], frame @ w)
    density = np.where(np.isfinite(t), np.broadcast_to(pdf, t.shape), 0).reshape(q_edges.size - 1, m, phi_edges.size - 1, m)
    expected = n * density.mean(axis=(1, 3)) * np.diff(q_edges)[:, None] * np.diff(phi_edges)
    # Bins that the outline crosses are integrated by midpoints: to about m^-1.5 = 0.3 %, far below their noise.
    assert h.chi2_p(observed, expected) > h.ALPHA
    assert abs(expected.sum() / n - 1) <= 0.01


def check_dtype_is_kept(value):
    for dtype in (np.float32, np.float64):
        k, p, _, sample = sampled(value, 9, dtype=dtype)
        assert [x.dtype for x in sample] == [dtype] * 4
        assert [x.dtype for x in value.hit(k, p, sample[0])] == [dtype] * 3
        assert [np.shape(x) for x in sample] == [(3, 9), (9,), (3, 9), (9,)]


def check_lanes_are_independent(value):
    n = 1_001
    k, _, u2, _ = sampled(value, n, dtype=np.float32)
    p = np.ascontiguousarray(P.astype(np.float32) + 0.2 * h.directions(5, n, np.float32))
    sample = value.sample(k, p, u2)
    d = np.where(np.arange(n) % 2, sample[0], h.directions(6, n, np.float32))
    hit = [np.broadcast_to(x, y.shape) for x, y in zip(value.hit(k, p, d), (sample[1], p, sample[1]))]
    for lane in (0, 1, 500, n - 1):
        one = slice(lane, lane + 1)
        alone = value.sample(k, np.ascontiguousarray(p[:, one]), np.ascontiguousarray(u2[:, one]))
        for a, b in zip(alone, sample):
            assert h.same_bits(a, b[..., one]), lane
        met = value.hit(k, np.ascontiguousarray(p[:, one]), np.ascontiguousarray(d[:, one]))
        for a, b in zip(met, hit):
            assert h.same_bits(np.broadcast_to(a, b[..., one].shape), b[..., one]), lane


@each
def test_a_light_offers_the_interface(value):
    assert isinstance(value, Light)
    assert LIGHTS[value.key] is type(value)
    assert isinstance(value.is_visible, bool)
    value.check()
    assert len(value.power()) == 3
    assert min(value.power()) > 0


@each_delta
def test_a_light_without_size_cannot_be_met(value):
    k, p, _, (wi, distance, E, pdf) = sampled(value, 100)
    assert np.isposinf(np.broadcast_to(pdf, 100)).all()
    assert (distance > 0).all()
    assert np.isfinite(E).all()
    assert np.isposinf(value.hit(k, p, wi)[0]).all()


@each_extended
@chance.fresh
def test_rays_meet_what_was_sampled(value):
    check_rays_meet_what_was_sampled(value)


@each_extended
@chance.fresh
def test_samples_follow_the_density(value):
    """4e4 samples in 12 x 12 bins; detects 10 % of the density in half of the bins, and 1 % of the whole."""
    check_samples_follow_the_density(value)


@each
def test_dtype_is_kept(value):
    check_dtype_is_kept(value)


@each
def test_lanes_are_independent(value):
    check_lanes_are_independent(value)


@each
def test_rows_of_many_lights_give_what_each_gives_alone(value):
    """The same table with one row per lane, as when a light is chosen for each."""
    k, p, u2, sample = sampled(value, 50)
    rows = k.take(np.zeros(50, int))
    for a, b in zip(value.sample(rows, p, u2), sample):
        np.testing.assert_allclose(a, np.broadcast_to(b, a.shape), rtol=1e-12)


@each
def test_nothing_is_nan_at_the_corners_of_the_unit_square_or_at_the_light_itself(value):
    u = np.array([0, 2.0**-24, 0.5, 1 - 2.0**-24], np.float32)
    u2 = np.stack(np.meshgrid(u, u)).reshape(2, -1)
    k = h.table(value.row(h.UNIT_FRAME), np.float32)
    for p in (P, np.array(ABOVE)[:, None], np.array(ABOVE)[:, None] + 1e-30, np.full((3, 1), 1e5)):
        with np.errstate(all="ignore"):
            wi, distance, E, pdf = value.sample(k, np.repeat(p, 16, 1).astype(np.float32), u2)
        assert np.isfinite(wi).all()
        assert not np.isnan(distance).any()
        assert not np.isnan(E).any()
        assert (E >= 0).all()
        # Seen from its own centre a bulb has no direction and no density; shadow rays drop such lanes.
        assert not np.isnan(pdf).any() or distance.min() == 0


# Mutants


def mutant_of(value, **changes):
    """`value` with static functions replaced."""
    return type("Mutant", (_Stand,), {name: staticmethod(f) for name, f in changes.items()})(value)


class _Stand:
    def __init__(self, value):
        self._value = value

    def __getattr__(self, attribute):
        return getattr(self._value, attribute)


RECTANGLE = EXAMPLES["area"][0]
BALL = EXAMPLES["point"][3]


def _no_light_cosine(k, p, u2):
    wi, distance, E, pdf = AreaLight.sample(k, p, u2)
    return wi, distance, E / -dot(wi, k.normal), pdf


def _pdf_per_area(k, p, u2):
    wi, distance, E, pdf = AreaLight.sample(k, p, u2)
    return wi, distance, E, 1 / k.area * np.ones_like(pdf)


def _through_the_centre(k, o, d):
    t, L, pdf = bulbs.hit(k, o, d)
    return t + k.radius, L, pdf


def _half_the_light(k, p, u2):
    return AreaLight.sample(k, p, u2 * np.array([[0.9], [1.0]]))


def _ellipse_instead(k, p, u2):
    return AreaLight.sample(h.table({**{n: c[..., 0] for n, c in vars(k).items()}, "ellipse": 1.0}), p, u2)


def _wider(k, p, u2):
    wi, distance, E, pdf = AreaLight.sample(k, p, u2)
    return wi.astype(np.float64), distance, E, pdf


def _mean_of_batch(k, p, u2):
    wi, distance, E, pdf = AreaLight.sample(k, p, u2)
    return wi, np.full_like(distance, distance.mean()), E, pdf


@pytest.mark.parametrize(
    ("law", "value", "changes"),
    [
        (check_rays_meet_what_was_sampled, RECTANGLE, {"sample": _no_light_cosine}),
        (check_rays_meet_what_was_sampled, RECTANGLE, {"sample": _pdf_per_area}),
        (check_rays_meet_what_was_sampled, BALL, {"hit": _through_the_centre}),
        (check_samples_follow_the_density, RECTANGLE, {"sample": _half_the_light}),
        (check_samples_follow_the_density, RECTANGLE, {"sample": _ellipse_instead}),
        (check_dtype_is_kept, RECTANGLE, {"sample": _wider}),
        (check_lanes_are_independent, RECTANGLE, {"sample": _mean_of_batch}),
    ],
    ids=lambda x: x.__name__ if callable(x) else None if hasattr(x, "key") else "-".join(f.__name__ for f in x.values()),
)
def test_the_contract_catches_a_broken_light(law, value, changes):
    law(value)
    with pytest.raises(AssertionError):
        law(mutant_of(value, **changes))


def test_emissive_meshes_offer_what_lights_do():
    """What emits is no plug-in; what it shares with lights is checked here, its irradiance among the area lights."""
    meshes = [h.thing(h.quad(), h.lambert(0.5, emission=1.0)), h.thing(h.icosphere(0, centre=(2, 1, 0)), h.lambert(0.5, emission=2.0))]
    world = h.plan_of(h.scene(meshes), h.settings()).world
    n = 1_001
    p = h.directions(1, n, np.float32) + world.triangles.shape[:3, :1]
    u2 = h.uniform(2, n, np.float32)
    index, probability, rest = world.lights.choice.choose(p, u2.copy())
    sample = world.lights.sample(index, p, rest.copy())
    assert [x.dtype for x in sample] == [np.float32] * 4
    assert np.abs(h.dots(sample[0], sample[0]) - 1).max() <= 1e-6
    assert 1 < np.unique(index).size <= 22
    for lane in (0, 1, 777, n - 1):
        one = slice(lane, lane + 1)
        there = np.ascontiguousarray(p[:, one])
        alone_index, alone_probability, alone_rest = world.lights.choice.choose(there, u2[:, one].copy())
        assert alone_index[0] == index[lane]
        assert h.same_bits(alone_probability, probability[one])
        for a, b in zip(world.lights.sample(alone_index, there, alone_rest), sample):
            assert h.same_bits(a, b[..., one])
