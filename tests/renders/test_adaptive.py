"""Adaptive supersampling: what is divided, what it is worth, and that nothing but the picture's own colours decides it."""

import math

import numpy as np
import pytest

from glanz.engine import (
    FILTERS,
    AreaLight,
    CheckerTexture,
    Coordinates,
    Lambert,
    Material,
    OrthographicCamera,
    PointLight,
    Requirements,
    rendering,
)
from glanz.engine.wavefront import adaptive
from glanz.engine.wavefront.adaptive import difference
from glanz.engine.wavefront.tiles import EvenTile
from glanz.tests import helpers as h, scenes

ANGLE, AWAY = 0.4, 0.05
"""An edge that follows no axis: the direction of its normal [rad], and how far from the middle it is [m]."""
BASE = h.settings(width=24, height=16, samples=1, max_depth=1, threads=2, passes=("Combined", "Sample Count"))
ADAPTIVE = h.replaced(BASE, adaptive_threshold=0.2, adaptive_levels=3)
ALL = {level: sum(4**k for k in range(level + 1)) for level in range(7)}
"""Cells in a pixel that is divided everywhere, those that were divided included."""


def render(scene, settings):
    """Red (H, W) and samples (H, W), float64."""
    passes = rendering.render_image(scene, settings).passes
    return passes["Combined"][..., 0].astype(np.float64), passes["Sample Count"][..., 0].astype(np.float64)


def strip(width=10.0, brightness=1.0, height=1.0):
    """Light from the edge on, `width` [m] across its normal, seen straight from above."""
    n = np.array((math.cos(ANGLE), math.sin(ANGLE), 0))
    mesh = h.quad(n * (AWAY + width / 2), width * n, (-20 * n[1], 20 * n[0], 0), name="lit")
    camera = OrthographicCamera.look_at((0, 0, 1), (0, 0, 0), up=(0, 1, 0), height=height)
    return h.scene([h.thing(mesh, h.lambert(0, "light", brightness))], camera=camera)


def covered(side, width=10.0, fine=1000):
    """(side, side) share of each pixel that the strip covers, along y exactly and along x by the midpoint rule."""
    x = (np.arange(side * fine) + 0.5) / (side * fine) - 0.5
    near = (AWAY - x * math.cos(ANGLE)) / math.sin(ANGLE)
    far = near + width / math.sin(ANGLE)
    top = 0.5 - np.arange(side)[:, None] / side
    share = np.clip(np.minimum(top, far) - np.maximum(top - 1 / side, near), 0, None) * side
    return share.reshape(side, side, fine).mean(axis=2)


# What is divided


def test_without_a_threshold_nothing_is_different(monkeypatch):
    """The same tiles, rays and bits as ever; with the largest threshold, that nothing exceeds, the same bits again."""
    scene = scenes.everything()
    assert h.plan_of(scene, BASE).tile is EvenTile
    assert "adaptive supersampling" not in Requirements.of(scene, BASE)
    assert Requirements.of(scene, ADAPTIVE).needs["adaptive supersampling"] == ("settings",)
    calls = h.spy(monkeypatch, rendering, "camera_rays")
    plain, count = render(scene, BASE)
    assert (count == 1).all()
    assert sum(call.result.slot.size for call in calls) == 24 * 16
    never, count = render(scene, h.replaced(ADAPTIVE, adaptive_threshold=1.0))
    assert (count == 1).all()
    assert h.same_bits(never, plain)


@pytest.mark.parametrize("samples", [1, 5])
def test_a_flat_region_takes_the_samples_of_the_settings(samples):
    """Far from the edge, and everywhere in a picture of one colour."""
    settings = h.replaced(ADAPTIVE, samples=samples, adaptive_threshold=0.01)
    picture, count = render(h.scene(world=0.7), settings)
    assert (count == samples).all()
    assert (picture == np.float32(0.7)).all()
    side = 24
    _, count = render(strip(), h.replaced(settings, width=side, height=side))
    x = (np.arange(side) + 0.5) / side - 0.5
    away = np.abs(x[None, :] * math.cos(ANGLE) - x[:, None] * math.sin(ANGLE) - AWAY) * side
    assert (count[away > 2 * math.sqrt(2)] == samples).all()
    assert (count[away < 0.5] > samples).all()


def check_an_edge_is_as_in_the_full_grid(sampler, monkeypatch, levels=3):
    """Bit for bit, though most cells are not divided: none that the edge goes through is missed."""
    settings = h.replaced(ADAPTIVE, width=24, height=24, sampler=sampler, adaptive_threshold=0.49, adaptive_levels=levels)
    picture, count = render(strip(), settings)
    with monkeypatch.context() as patch:
        patch.setattr(adaptive, "difference", lambda a, b: np.ones(a.shape[1]))
        full, full_count = render(strip(), settings)
    assert (full_count == ALL[levels]).all()
    assert count.mean() < 0.2 * ALL[levels]
    inside = (slice(1, -1), slice(1, -1))  # Beyond the frame there are no neighbours.
    assert h.same_bits(picture[inside], full[inside])
    return picture, count


@pytest.mark.parametrize("sampler", ["random", "stratified", "sobol", "grid"])
def test_an_edge_is_as_in_the_full_grid(sampler, monkeypatch):
    check_an_edge_is_as_in_the_full_grid(sampler, monkeypatch)


def test_the_full_grid_catches_neighbours_that_are_ignored(monkeypatch):
    """The mutant compares a cell with others of its own pixel only; another one has no diagonal neighbours."""

    def to_divide(self, level, x, y):
        everywhere = original(self, level, x, y)
        if level == 0:
            return everywhere
        # Parts of one cell stand four by four.
        own = self._tree.colours(level, x, y).reshape(4, -1, 4)
        apart = difference(own.max(axis=2), own.min(axis=2)) > self._threshold
        return np.intersect1d(everywhere, np.nonzero(np.repeat(apart, 4))[0])

    original = adaptive.AdaptiveTile._to_divide
    with monkeypatch.context() as patch:
        patch.setattr(adaptive.AdaptiveTile, "_to_divide", to_divide)
        with pytest.raises(AssertionError):
            check_an_edge_is_as_in_the_full_grid("random", patch)
    monkeypatch.setattr(adaptive, "_AROUND", ((1, 0), (0, 1)))
    with pytest.raises(AssertionError):
        check_an_edge_is_as_in_the_full_grid("random", monkeypatch)


# What it is worth


def check_always_divided_is_the_finer_picture(levels=2):
    """With the uniform grid, a picture divided everywhere is the mean of that with as many more pixels; to 1e-3.

    The footprints of textures too: those of a cell are those of a smaller pixel.
    """
    checkers = CheckerTexture(coordinates=Coordinates(source="object", matrix=np.diag((5.0, 5.0, 5.0, 1.0))))
    material = Material(name="checkers", lobes=(Lambert(checkers),))
    objects = [h.thing(h.icosphere(1, 1.0)), h.thing(h.quad((0, 0, -1), (99, 0, 0), (0, 99, 0)), material)]
    scene = h.scene(objects, [PointLight(position=(3, -2, 4))], h.PerspectiveCamera.look_at((2, -3, 6), (0, 0, 0)))
    settings = h.replaced(BASE, sampler="grid", max_depth=0, adaptive_levels=levels)
    picture, count = render(scene, h.replaced(settings, adaptive_threshold=1e-30))
    assert (count == ALL[levels]).mean() > 0.8
    n = 2**levels
    finer, _ = render(scene, h.replaced(settings, width=24 * n, height=16 * n))
    coarse = finer.reshape(16, n, 24, n).mean(axis=(1, 3))
    np.testing.assert_allclose(picture, coarse, rtol=2e-3, atol=1e-6)


def test_what_is_always_divided_is_the_finer_picture():
    check_always_divided_is_the_finer_picture()


def test_the_finer_picture_catches_parts_that_do_not_count_by_area(monkeypatch):
    """The mutants forget one part of four, count all samples of a pixel alike, or leave footprints as wide as a pixel's."""
    gathered = adaptive._gathered

    def without_the_last(reduction, levels, divided):
        return gathered(reduction, [levels[0], *(v * (np.arange(v.shape[1]) % 4 < 3) for v in levels[1:])], divided)

    def by_samples(reduction, levels, divided):
        counts = gathered("sum", [np.ones_like(v) for v in levels], divided)
        return gathered("sum", levels, divided) / (counts if reduction == "mean" else 1)

    for mutant in (without_the_last, by_samples):
        with monkeypatch.context() as patch:
            patch.setattr(adaptive, "_gathered", mutant)
            with pytest.raises(AssertionError):
                check_always_divided_is_the_finer_picture()
    monkeypatch.setattr(adaptive.Cells, "narrow", lambda self, carried: None)
    with pytest.raises(AssertionError):
        check_always_divided_is_the_finer_picture()


@pytest.mark.parametrize("plugin", FILTERS.values(), ids=lambda f: f.key)
def test_cells_weigh_the_same_under_every_filter(plugin, monkeypatch):
    """Divided everywhere, pixels across an edge are the filter's integral beyond it, as those of many samples are; to 4e-3."""
    monkeypatch.setattr(adaptive, "difference", lambda a, b: np.ones(a.shape[1]))
    lit = h.thing(h.quad((2, 0, 0), (4, 0, 0), (0, 4, 0), name="lit"), h.lambert(0.0, "light", emission=1.0))
    camera = OrthographicCamera.look_at((0, 0, 1), (0, 0, 0), up=(0, 1, 0), height=1.6)
    settings = h.replaced(BASE, width=16, height=16, pixel_filter=plugin.key, filter_width=3.0)
    many, _ = render(h.scene([lit], camera=camera), h.replaced(settings, samples=400, sampler="sobol"))
    divided, _ = render(h.scene([lit], camera=camera), h.replaced(settings, samples=9, adaptive_threshold=0.5, adaptive_levels=3))
    assert np.abs(divided.mean(axis=0) - many.mean(axis=0)).max() <= 4e-3
    flat, _ = render(h.scene(world=0.75), h.replaced(settings, samples=9, adaptive_threshold=0.5))
    assert np.abs(flat - 0.75).max() <= 3e-7


def errors(levels, seeds=4, side=24):
    """RMSE of pixels that the edge goes through: adaptive, and with as many samples as there are smallest cells."""
    truth = covered(side)
    crossed = (truth > 0) & (truth < 1)
    settings = h.replaced(BASE, width=side, height=side)
    both = []
    for changes in ({"adaptive_threshold": 0.2, "adaptive_levels": levels}, {"samples": 4**levels}):
        pictures = [render(strip(), h.replaced(settings, seed=seed, **changes))[0] for seed in range(seeds)]
        both.append(math.sqrt(np.mean([np.square(p - truth)[crossed] for p in pictures])))
    return both


def test_the_error_at_an_edge_falls_as_that_of_the_smallest_cells():
    """Where one jittered sample falls into each cell the error is N^-3/4; within a quarter of uniform supersampling's."""
    by_level = {levels: errors(levels) for levels in (1, 2, 3, 4)}
    for found, expected in by_level.values():
        assert abs(found / expected - 1) <= 0.25
    slope = np.polyfit(np.log([4.0**k for k in by_level]), np.log([e[0] for e in by_level.values()]), 1)[0]
    assert slope == pytest.approx(-0.75, abs=0.1)


@pytest.mark.parametrize(("width", "least", "most"), [(1.0, 0.995, 1.005), (0.25, 0.975, 1.005), (0.02, 0.0, 0.3)])
def test_a_line_is_drawn_where_it_is_met(width, least, most):
    """Of 4 samples per pixel: one of a pixel's width is complete, of a quarter nearly, and what no sample meets is missing."""
    side = 32
    settings = h.replaced(BASE, width=side, height=side, samples=4, adaptive_threshold=0.1, adaptive_levels=3)
    found = np.mean([render(strip(width / side), h.replaced(settings, seed=seed))[0].mean() for seed in range(6)])
    assert least <= found / covered(side, width / side).mean() <= most


def test_noise_is_kept_within_the_threshold():
    """The bias that comes from judging by the same samples: of a noisy flat region less than a tenth of the threshold."""
    scene = h.receiver([AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 1)))], distance=0.5)
    truth = 0.752274688 / np.pi
    settings = h.replaced(BASE, width=32, height=32, max_depth=0, sampler="random", adaptive_threshold=0.1, adaptive_levels=2)
    found = [render(scene, h.replaced(settings, seed=seed)) for seed in range(4)]
    assert 2 < np.mean([count.mean() for _, count in found]) < 20
    assert abs(np.mean([picture.mean() for picture, _ in found]) / truth - 1) <= 0.01
