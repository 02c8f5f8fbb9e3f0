"""What `render` yields while it works."""

import numpy as np

from glanz.engine import Settings, rendering
from glanz.tests import helpers as h

QUAD = h.scene([h.thing(h.quad(), h.lambert(0.5, emission=1.0))])


def tiles_of(settings, scene=QUAD):
    return [tile for progress in rendering.render(scene, settings) for tile in progress.tiles]


def test_long_tiles_are_shown_unfinished_and_end_with_the_whole_picture(monkeypatch):
    """Every tile comes last as final, with the pixels of a render that shows nothing in between."""
    settings = Settings(width=24, height=16, samples=40, tile_size=12)
    at_once = {(tile.x, tile.y): tile for tile in tiles_of(settings)}
    assert all(tile.is_final for tile in at_once.values())
    monkeypatch.setattr(rendering, "LANES", 12 * 12 * 8)
    monkeypatch.setattr(rendering, "SHOW_SECONDS", 0)
    tiles = tiles_of(settings)
    last = {(tile.x, tile.y): tile for tile in tiles}
    assert len(tiles) > len(last) == 4
    for place, tile in last.items():
        assert tile.is_final
        assert np.array_equal(tile.passes["Combined"], at_once[place].passes["Combined"])


def test_an_unfinished_tile_is_the_mean_of_its_samples_so_far(monkeypatch):
    """Pixels that have no sample yet are black and transparent, the others as bright as they will be."""
    monkeypatch.setattr(rendering, "LANES", 64)
    monkeypatch.setattr(rendering, "SHOW_SECONDS", 0)
    # In nothing but a world of radiance 1 every sample is 1, and so is the mean of however many.
    tiles = tiles_of(Settings(width=16, height=16, samples=4, tile_size=0), h.scene(world=1.0))
    first, final = tiles[0].passes["Combined"], tiles[-1].passes["Combined"]
    assert not tiles[0].is_final
    assert (first[:4] == 1).all()
    assert (first[4:] == 0).all()
    assert (final == 1).all()
