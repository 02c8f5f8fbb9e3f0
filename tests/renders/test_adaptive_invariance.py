"""Which cells are divided depends on the picture alone: not on tiles, threads, borders, batches or passes (catalogue G10, H3)."""

import numpy as np
import pytest

from glanz.engine import INTEGRATORS, PASSES, SAMPLERS, rendering
from glanz.engine.wavefront import adaptive
from glanz.engine.wavefront.adaptive import AdaptiveTile, Cells, difference
from glanz.engine.wavefront.camera_rays import camera_rays
from glanz.engine.wavefront.film import Film
from glanz.engine.wavefront.loop import trace
from glanz.engine.wavefront.tiles import Pixels
from glanz.tests import helpers as h, scenes

SETTINGS = h.settings(
    width=24,
    height=16,
    samples=2,
    max_depth=1,
    threads=2,
    pixel_filter="blackman_harris",
    adaptive_threshold=0.15,
    adaptive_levels=3,
    passes=("Combined", "Sample Count", "Depth", "Normal"),
)


def passes_of(settings, scene=None):
    return rendering.render_image(scene or scenes.everything(), settings).passes


def all_passes(settings):
    passes = passes_of(settings)
    return np.concatenate([passes[name] for name in sorted(passes)], axis=2)


@pytest.fixture(scope="module")
def reference():
    return all_passes(SETTINGS)


@pytest.mark.parametrize(("tile_size", "threads"), [(0, 1), (16, 2), (8, 3), (5, 2), (3, 2)])
def test_tiles_and_threads_change_no_bit(reference, tile_size, threads):
    """H3; some pixels are divided three times, some not at all."""
    counts = reference[..., -1]
    assert counts.min() == 2
    assert counts.max() > 2 * 50
    assert h.same_bits(all_passes(h.replaced(SETTINGS, tile_size=tile_size, threads=threads)), reference)


@pytest.mark.parametrize("border", [(3, 5, 17, 9), (23, 15, 24, 16), (0, 0, 1, 1), (10, 0, 14, 16)], ids=str)
def test_a_border_renders_the_same_pixels(reference, border):
    """G10: what lies beyond it is looked at as if it were rendered."""
    x0, y0, x1, y1 = border
    assert h.same_bits(all_passes(h.replaced(SETTINGS, border=border)), reference[y0:y1, x0:x1])


@pytest.mark.parametrize("levels", [1, 2, 4])
def test_every_number_of_levels_looks_far_enough_beyond_a_tile(levels):
    settings = h.replaced(SETTINGS, width=12, height=12, adaptive_levels=levels)
    assert h.same_bits(all_passes(h.replaced(settings, tile_size=3)), all_passes(h.replaced(settings, tile_size=0)))


@pytest.mark.parametrize("lanes", [7, 384, 10**6])
def test_batches_change_no_bit(reference, monkeypatch, lanes):
    monkeypatch.setattr(rendering, "LANES", lanes)
    settings = h.replaced(SETTINGS, border=(8, 4, 12, 8)) if lanes == 7 else SETTINGS
    assert h.same_bits(all_passes(settings), reference[4:8, 8:12] if lanes == 7 else reference)


def test_tiles_that_would_need_too_much_memory_are_cut(reference, monkeypatch):
    monkeypatch.setattr(adaptive, "_MOST_CELLS", 40**2)
    tiles = h.spy(monkeypatch, rendering, "_tile")
    assert h.same_bits(all_passes(h.replaced(SETTINGS, tile_size=0)), reference)
    assert {max(call.args[1][2:]) for call in tiles} == {5, 4}


@pytest.mark.parametrize("margin", [0, 1])
def test_bits_catch_a_margin_that_is_too_narrow(margin, monkeypatch):
    """The mutants sample no pixels beyond the tile, or one only; what is not there is taken from its neighbour."""
    grown = AdaptiveTile._grown
    colours = adaptive._Tree.colours

    def nearest(self, level, x, y):
        left, top, width, height = self._roots
        x = np.clip(x, left << level, ((left + width) << level) - 1)
        return colours(self, level, x, np.clip(y, top << level, ((top + height) << level) - 1))

    monkeypatch.setattr(AdaptiveTile, "_grown", lambda self, place, wide: grown(self, place, min(wide, margin)))
    monkeypatch.setattr(adaptive._Tree, "colours", nearest)
    pairs = [[all_passes(h.replaced(SETTINGS, width=8, height=8, seed=seed, tile_size=size)) for size in (2, 0)] for seed in range(8)]
    assert not all(h.same_bits(*pair) for pair in pairs)


REPLICATES = h.replaced(SETTINGS, replicates=2)
"""Some passes ask for them; pictures are the same where all have as many."""


@pytest.fixture(scope="module")
def every_pass():
    return passes_of(h.replaced(REPLICATES, passes=tuple(PASSES)))


@pytest.mark.parametrize("key", PASSES)
def test_a_pass_renders_alone_as_beside_others(key, every_pass):
    """Colours decide, whether they are asked for or not."""
    alone = passes_of(h.replaced(REPLICATES, passes=(key,)))
    assert list(alone) == [key]
    assert h.same_bits(alone[key], every_pass[key])


def test_a_pass_of_the_first_sample_is_that_of_the_picture_without():
    even = passes_of(h.replaced(SETTINGS, adaptive_threshold=0.0))
    assert h.same_bits(passes_of(SETTINGS)["Depth"], even["Depth"])
    assert (passes_of(SETTINGS)["Combined"][..., 3] == 1).all()


@pytest.mark.parametrize("sampler", SAMPLERS)
def test_samplers_of_all_kinds_can_be_divided(sampler):
    """And seeds give noise of their own."""
    settings = h.replaced(SETTINGS, sampler=sampler, threads=1)
    picture = passes_of(settings)["Combined"]
    assert np.isfinite(picture).all()
    if sampler != "grid":
        assert not h.same_bits(passes_of(h.replaced(settings, seed=1))["Combined"], picture)


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_integrators_of_all_kinds_can_be_divided(integrator):
    """The mean of the picture is that of many even samples; to 3 %."""
    scene = h.scene([h.thing(h.box(), h.lambert(0.5, emission=1.0))], camera=h.PerspectiveCamera.look_at((0.3, 0.4, 0.5), (0.9, 0.8, 0.2)))
    settings = h.replaced(SETTINGS, integrator=integrator, width=6, height=4, samples=16, max_depth=0, adaptive_threshold=0.02)
    passes = passes_of(settings, scene)
    even = passes_of(h.replaced(settings, adaptive_threshold=0.0, samples=1024), scene)
    assert abs(passes["Combined"][..., :3].mean() / even["Combined"][..., :3].mean() - 1) <= 0.03
    assert (passes["Sample Count"] >= 16).all()


# Seen from outside


def twin(scene, settings):
    """The same picture the slow way: one cell at a time, in dictionaries, over the whole frame. Red and samples (H, W)."""
    plan = h.plan_of(scene, h.replaced(settings, passes=("Combined",)))

    def sampled(level, x, y):
        one = np.array([x]), np.array([y])
        film = Film(1, plan.passes)
        film.open(settings.samples, slice(0, 1))
        trace(plan, [camera_rays(plan, Cells(level, *one) if level else Pixels(*one), 0, settings.samples)], film)
        film.close(is_first=True)
        return film.pixels()["Combined"][:3]

    cells = {(0, x, y): sampled(0, x, y) for y in range(settings.height) for x in range(settings.width)}

    def found(level, x, y):
        while (level, x, y) not in cells:
            level, x, y = level - 1, x // 2, y // 2
        return cells[level, x, y]

    divided = set()
    newest = list(cells)
    for level in range(settings.adaptive_levels):
        right, bottom = settings.width * 2**level, settings.height * 2**level
        apart = []
        for _, x, y in newest:
            around = [(x + i, y + j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
            others = [found(level, *place) for place in around if 0 <= place[0] < right and 0 <= place[1] < bottom]
            if max(difference(cells[level, x, y], other)[0] for other in others) > settings.adaptive_threshold:
                apart.append((level, x, y))
        divided |= set(apart)
        newest = [(level + 1, 2 * x + i, 2 * y + j) for _, x, y in apart for i in (0, 1) for j in (0, 1)]
        cells |= {cell: sampled(*cell) for cell in newest}

    def value(level, x, y):
        """Mean radiance, and samples."""
        if (level, x, y) not in divided:
            return np.array((cells[level, x, y][0, 0], settings.samples))
        parts = [value(level + 1, 2 * x + i, 2 * y + j) for i in (0, 1) for j in (0, 1)]
        return np.array((np.mean([part[0] for part in parts]), settings.samples + sum(part[1] for part in parts)))

    return np.moveaxis([[value(0, x, y) for x in range(settings.width)] for y in range(settings.height)], 2, 0)


def test_a_slow_twin_divides_the_same_cells():
    """In tiles of 5 px, with the same samples in every pixel and the same values to rounding."""
    settings = h.replaced(SETTINGS, width=10, height=8, tile_size=5, adaptive_levels=2, threads=1, sampler="sobol")
    passes = passes_of(settings)
    picture, count = twin(scenes.everything(), settings)
    assert 2 < count.mean() < 2 * 21
    assert (passes["Sample Count"][..., 0] == count).all()
    np.testing.assert_allclose(passes["Combined"][..., 0], picture, rtol=1e-6)


def test_samples_are_camera_rays(monkeypatch):
    """Of a picture in one tile there are as many as the pass counts; other tiles cost what lies around them."""
    calls = h.spy(monkeypatch, rendering, "camera_rays")
    count = passes_of(h.replaced(SETTINGS, tile_size=0))["Sample Count"]
    assert sum(call.result.slot.size for call in calls) == count.sum()
    calls.clear()
    passes_of(h.replaced(SETTINGS, tile_size=12, border=(0, 0, 12, 12)))
    assert sum(call.result.slot.size for call in calls) < 1.5 * count[:12, :12].sum()


def test_progress_rises_to_one_and_unfinished_tiles_come_first(monkeypatch):
    monkeypatch.setattr(rendering, "SHOW_SECONDS", 0.0)
    monkeypatch.setattr(rendering, "LANES", 64)
    items = list(rendering.render(scenes.everything(), h.replaced(SETTINGS, tile_size=8)))
    done = [progress.done for progress in items]
    assert done == sorted(done)
    assert done[-1] == 1
    tiles = [tile for progress in items for tile in progress.tiles]
    unfinished = [tile for tile in tiles if not tile.is_final]
    assert len(tiles) - len(unfinished) == 6
    assert unfinished
    for tile in unfinished:
        assert tile.passes["Combined"].shape == (tile.height, tile.width, 4)
        assert np.isfinite(tile.passes["Combined"]).all()
