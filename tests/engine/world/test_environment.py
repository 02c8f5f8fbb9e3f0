"""The picture around a scene as a light: what is sampled, what is told, what is seen (catalogue B10)."""

import math

import numpy as np
import pytest

from glanz.engine import EnvironmentMap, World
from glanz.engine.constants import LUMINANCE
from glanz.engine.maths import interpolation
from glanz.engine.maths.texels import Texels
from glanz.engine.world import environment as module
from glanz.engine.world.environment import Environment
from glanz.tests import chance, helpers as h

N = 400_000


def picture(height, width, seed=1, power=4):
    return (np.random.default_rng(seed).random((3, height, width)) ** power).astype(np.float32)


def hot(height=8, width=16, at=(2, 11), value=1e30):
    pixels = np.full((3, height, width), 0.01, np.float32)
    pixels[:, at[0], at[1]] = value
    return pixels


PICTURES = {
    "noise": picture(32, 64),
    "1x1": np.full((3, 1, 1), 2.0, np.float32),
    "one row": picture(1, 9),
    "one column": picture(7, 1),
    "hot pixel": hot(),
    "hot pole": hot(at=(0, 3), value=1e4),
    "hot seam": hot(at=(5, 15), value=1e4),
    "half": np.repeat(np.repeat(np.float32([1, 0])[None, :, None], 3, 0), 4, 2).repeat(4, 1),
    "only a pole": hot(at=(7, 5), value=3.0) * (hot(at=(7, 5), value=3.0) > 1),
}
WAYS = ("linear", "closest")


def environment(name, way="linear", radiance=0.0, **changes):
    pixels = PICTURES[name]
    return Environment.of(World(radiance=h.grey(radiance), environment=EnvironmentMap(pixels=pixels, interpolation=way, **changes)))


def luminance(pixels, u, v, way):
    """What a picture shows at u, v, in float64 and by other means than the engine's: repeated in u, held in v."""
    grey = np.tensordot(LUMINANCE, pixels.astype(float), 1)
    grey = np.concatenate((grey[:1], grey, grey[-1:]))
    grey = np.concatenate((grey[:, -1:], grey, grey[:, :1]), axis=1)
    height, width = pixels.shape[1:]
    x, y = u * width + 0.5, v * height + 0.5
    if way == "closest":
        return grey[np.rint(y).astype(int), np.rint(x).astype(int)]
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    a, b = x - i, y - j
    return (1 - b) * ((1 - a) * grey[j, i] + a * grey[j, i + 1]) + b * ((1 - a) * grey[j + 1, i] + a * grey[j + 1, i + 1])


def square_of(d):
    return 0.5 - np.arctan2(d[1], d[0]) / (2 * math.pi), np.arccos(np.clip(d[2], -1, 1)) / math.pi


def direction_at(u, v):
    theta, phi = math.pi * v, math.pi * (1 - 2 * u)
    return np.stack((np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)))


def grid(height, width):
    v, u = ((np.arange(m) + 0.5) / m for m in (height, width))
    return (x.ravel() for x in np.meshgrid(u, v))


def check_samples_follow_the_picture(way):
    """chi2 of directions in 16 x 32 bins against luminance times sin theta."""
    wi, _, _, _ = environment("noise", way).sample(None, h.uniform(2, N, np.float32))
    u, v = square_of(wi.astype(float))
    observed = np.histogram2d(v, u, (16, 32), ((0, 1), (0, 1)))[0]
    u, v = grid(16 * 16, 32 * 16)
    expected = (luminance(PICTURES["noise"], u, v, way) * np.sin(math.pi * v)).reshape(16, 16, 32, 16).sum(axis=(1, 3))
    assert h.chi2_p(observed, N * expected / expected.sum()) > h.ALPHA


@pytest.mark.parametrize("way", WAYS)
@chance.fresh
def test_samples_follow_the_picture_times_the_solid_angle(way):
    """Detects 4 % in half of the bins, and a picture that is shifted by a tenth of a pixel."""
    check_samples_follow_the_picture(way)


def _without_solid_angle(world, flux):
    return iter([np.tensordot(LUMINANCE, world.environment.pixels.astype(float), 1)])


def _half_a_pixel_off(row, column, u2, shape):
    u, v = interpolation.linear_place(row, column, u2, shape)
    return (u + np.float32(0.5 / shape[1])) % 1, v


def _column_of_another_row(self, u2, choose=Texels.choose):
    return choose(h.replaced(self, columns=np.roll(self.columns, 1, axis=0)), u2)


@pytest.mark.parametrize(
    ("owner", "name", "mutant"),
    [
        (module, "_weights", _without_solid_angle),
        (module, "_WAYS", {"linear": (interpolation.linear_texels, _half_a_pixel_off)}),
        (module, "_WAYS", {"linear": (interpolation.linear_texels, interpolation.nearest_place)}),
        (Texels, "choose", _column_of_another_row),
    ],
    ids=["no sin theta", "half a pixel off", "places of another way", "wrong distribution"],
)
def test_following_catches_a_broken_part(monkeypatch, owner, name, mutant):
    monkeypatch.setattr(owner, name, mutant)
    with pytest.raises(AssertionError):
        check_samples_follow_the_picture("linear")


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", PICTURES)
def test_the_density_is_told_alike_by_sample_and_hit_and_integrates_to_one(name, way):
    """B10, B3, B4; also for one hot pixel of 1e30, at the poles, and for a single row, column or pixel."""
    sky = environment(name, way, world_from_map=h.rotation(3))
    wi, distance, E, pdf = sky.sample(None, h.uniform(4, N, np.float32))
    assert [x.dtype for x in (wi, distance, E, pdf)] == [np.float32] * 4
    assert np.isposinf(distance).all()
    assert np.abs(np.linalg.norm(wi.astype(float), axis=0) - 1).max() <= 1e-6
    assert np.isfinite(E).all()
    assert np.isfinite(pdf).all()
    assert (pdf > 0).all()
    L, met = sky.hit(wi)
    # Rounding of wi counts where the picture is steep, and at the edges of pixels.
    assert np.mean(np.abs(met / pdf - 1) <= 1e-3) > 0.99
    assert np.mean((np.abs(L - E * pdf) <= 1e-3 * L.max(axis=0)).all(axis=0)) > 0.99
    u, v = grid(504, 1008)
    density = sky.hit((sky.world_from_map @ direction_at(u, v)).astype(np.float32))[1].astype(float)
    assert (density * np.sin(math.pi * v)).mean() * 2 * math.pi**2 == pytest.approx(1, abs=2e-3)


@pytest.mark.parametrize("way", WAYS)
def test_a_direction_at_the_pole_has_no_light_and_no_end_of_density(way):
    """There the density [sr^-1] is beyond float32."""
    u2 = np.stack((np.full(4, 0.5), (0.0, 1e-45, 1e-40, 1e-20))).astype(np.float32)
    _, _, E, pdf = environment("hot pole", way).sample(None, u2)
    assert np.isfinite(E).all() and (pdf > 0).all()


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize("name", PICTURES)
@chance.fresh
def test_the_mean_of_samples_is_the_light_of_the_whole_sky(name, way):
    """The integral of L over the sphere, by E = L / pdf and by quadrature; detects 1 %. Samples are bounded."""
    sky = environment(name, way)
    E = sky.sample(None, h.uniform(5, N, np.float32))[2].astype(float)
    u, v = grid(640, 1440)
    truth = (luminance(PICTURES[name], u, v, way) * np.sin(math.pi * v)).mean() * 2 * math.pi**2
    samples = np.tensordot(LUMINANCE, E, 1)
    assert h.mean_is(samples, truth, floor=2e-3)
    assert samples.max() <= 3 * truth


@pytest.mark.parametrize("name", ["1x1", "noise", "hot pixel"])
def test_flux_tells_how_much_light_comes_from_where(name):
    """Sum and vector of all light, to what a coarse picture is off by: 2 % of the sum, 3 % of it in direction."""
    turn = h.rotation(7)
    sky = environment(name, world_from_map=turn)
    u, v = grid(640, 1440)
    L = luminance(PICTURES[name], u, v, "linear") * np.sin(math.pi * v) * 2 * math.pi**2
    assert sky.flux[3] == pytest.approx(L.mean(), rel=0.02)
    np.testing.assert_allclose(sky.flux[:3], turn @ (L * direction_at(u, v)).mean(axis=1), atol=0.03 * sky.flux[3])
    assert sky.power(2.0) == pytest.approx((4 * math.pi * sky.flux[3],) * 3)


def test_an_even_sky_weighs_the_irradiance_that_it_gives():
    """A quarter of 4 pi L; a spot weighs all that it gives to a surface that faces it."""
    assert environment("1x1").weight(h.UNIT_FRAME)["power"][0] == pytest.approx(2 * math.pi)
    spot = environment("hot pixel")
    assert spot.weight(h.UNIT_FRAME)["power"][0] == pytest.approx(spot.flux[3], rel=0.01)


def test_lanes_are_independent():
    sky = environment("noise", world_from_map=h.rotation(2))
    n = 1_003
    u2, d = h.uniform(6, n, np.float32), h.directions(7, n, np.float32)
    sample, hit = sky.sample(None, u2.copy()), sky.hit(d)
    for lane in (0, 1, 500, n - 1):
        one = slice(lane, lane + 1)
        for a, b in zip(sky.sample(None, u2[:, one].copy()), sample):
            assert h.same_bits(a, b[..., one])
        for a, b in zip(sky.hit(np.ascontiguousarray(d[:, one])), hit):
            assert h.same_bits(a, b[..., one])


def test_strength_tints_and_background_adds():
    d = h.directions(8, 100, np.float32)
    plain = environment("noise").radiance(d)
    tinted = environment("noise", radiance=(0.1, 0.2, 0.3), strength=(2.0, 1.0, 0.0)).radiance(d)
    np.testing.assert_allclose(tinted, plain * np.array([[2], [1], [0]]) + np.array([[0.1], [0.2], [0.3]]), rtol=1e-5)


def test_what_adds_is_sampled_too():
    """A picture with holes over an even background: nothing of it is left to chance."""
    sky = environment("half", radiance=0.5)
    E = sky.sample(None, h.uniform(9, N, np.float32))[2]
    assert h.mean_is(E[0], 4 * math.pi * 0.5 + 2 * math.pi, floor=2e-3)
    assert E.max() <= 3 * 4 * math.pi
