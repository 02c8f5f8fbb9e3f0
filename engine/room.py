"""What a picture takes of memory, told before it is rendered."""

import os

import numpy as np

from .memory import require
from .wavefront.loop import few_wait

LANES = 2**17
"""Paths in a batch: enough to hide Python, few enough for the cache."""
TOGETHER = 4
"""Batches that are on the film at a time at most: what is left of them after a few bounces is followed together."""
_LANE = 600
_LEVEL, _LEVELS = 180, 16
_TILE = 2500
_REPLICATES = 152
_RANKS = 128
_BOOKS = 40
"""Bytes of a path in single precision, of each depth at which its branches wait, for so many depths, as deeper trees are thin; of a tile
that waits, of what a pixel of a film has for replicates and for each pass of ranks, and of one in work."""
_CURE = "lower the resolution, render a border, or ask for fewer passes"
_DIVIDED = "; or for fewer adaptive levels, smaller tiles or fewer threads, as all pixels may be divided"
_KEPT = "; or do without an error target, a time limit, a checkpoint and rounds over the whole frame, for which all tiles are kept"


def require_room(plan, has_rounds, saves):
    """Raises MemoryShortage where the picture of a `Plan` would not fit, with all that is kept while it is rendered.

    has_rounds  whether the whole frame gets some samples before any pixel gets more
    saves       whether there are checkpoints
    """
    settings = plan.settings
    x0, y0, x1, y1 = settings.region
    keeps = bool(has_rounds or saves or settings.error_target or settings.time_limit)
    what = f"{x1 - x0}x{y1 - y0} px with {_channels(settings.passes, plan.passes)} channels"
    require(needed(plan, keeps, saves), what, _CURE + (_KEPT if keeps else "") + (_DIVIDED if settings.adaptive_threshold else ""))


def needed(plan, keeps, saves):
    """Bytes that the picture of a `Plan` takes at the most, if it `keeps` the films of all tiles, or `saves` them, or neither."""
    settings = plan.settings
    x0, y0, x1, y1 = settings.region
    width, height = x1 - x0, y1 - y0
    side = min(settings.tile_size or max(width, height), plan.tile.longest_side(settings))
    tiles = -(-width // side) * -(-height // side)
    workers = min(settings.threads or os.cpu_count() or 1, tiles)
    # All pixels may be divided.
    cells = 4**settings.adaptive_levels if settings.adaptive_threshold else 1
    in_work = workers * min(side, width) * min(side, height) * cells
    rows = sum(getattr(p, "rows", len(p.channels)) for p in plan.passes)
    ranks = sum(p.reduction == "ranks" for p in plan.passes)
    # With the numbers of its samples, their weight, and where its pixels are.
    film = 32 + 8 * rows + _RANKS * ranks + _REPLICATES * any(p.reduction == "replicates" for p in plan.passes)
    picture = 4 * _channels(settings.passes, plan.passes)
    kept = width * height if keeps else in_work
    number = np.dtype(settings.real).itemsize
    paths = min(LANES, in_work // workers) * settings.samples
    lane = (_LANE if plan.wait is few_wait else _LANE + _LEVEL * min(plan.last_depth, _LEVELS)) // 4
    batch = number * (min(TOGETHER * LANES, paths) * (4 + rows) + min(LANES, paths) * lane)
    # What is shown of a tile is divided, rounded and turned, when its samples are in.
    work = max(_BOOKS, 16 * rows)
    # Tiles wait until somebody takes them, and those that are kept come together in the end.
    return kept * film + in_work * work + width * height * picture * (2 + keeps + saves) + tiles * _TILE + workers * batch


def _channels(keys, passes):
    return sum(len(p.channels) for p in passes if p.key in keys)
