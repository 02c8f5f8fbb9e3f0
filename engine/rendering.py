"""From a scene to pictures: tiles as they finish, from threads over the frame."""

import os
import time
from concurrent.futures import FIRST_COMPLETED, ThreadPoolExecutor, wait
from dataclasses import dataclass, field, replace
from itertools import pairwise

import numpy as np

from .constants import VERSION
from .ending import NOT_BEGUN, Ending, Reached
from .errors import FileError, SceneWarning
from .measured import Found
from .plan import Plan
from .registry import PASSES
from .requirements import Requirements
from .room import LANES, TOGETHER, require_room
from .saved import NO_CHECKPOINT
from .scene.validate import validate
from .switching import brisk_switching
from .wavefront.camera_rays import camera_rays
from .wavefront.loop import trace
from .wavefront.numbers import spread_at
from .wavefront.signed_filter import sample_weights
from .wavefront.witness import culprit
from .work import Work

POLL_SECONDS = 0.1
SHOW_SECONDS = 0.5
"""How often a tile that takes long is shown unfinished; what a user who cancels may lose of it."""


@dataclass(frozen=True, slots=True, eq=False)
class Tile:
    """A rectangle of the picture: x, y [px] from the top left of the full frame.

    passes    {name: (height, width, channels) float32}, row 0 at the top
    is_final  all samples are in; else it shows those so far, and comes again
    """

    x: int
    y: int
    width: int
    height: int
    passes: dict
    is_final: bool = True


@dataclass(frozen=True, slots=True, eq=False)
class Progress:
    """What has happened since the last one: the share `done` in [0, 1], tiles to show, each `SceneWarning` that came up.

    in_work  (x, y, width, height) [px] of the tiles that threads are at just now
    reached  how far the whole frame has come, a `Reached`; the last one says what has ended it
    """

    done: float
    tiles: tuple = ()
    warnings: tuple = ()
    in_work: tuple = ()
    reached: Reached = NOT_BEGUN


@dataclass(frozen=True, slots=True, eq=False)
class Image:
    """A picture: passes {name: (height, width, channels) float32}, row 0 at the top; metadata {str: str}."""

    width: int
    height: int
    passes: dict
    metadata: dict = field(default_factory=dict)
    warnings: tuple = ()


def render(scene, settings, ends=(), checkpoint=NO_CHECKPOINT):
    """Render, yielding `Progress` at least ten times a second until everything is done; `ends` and `checkpoint` as in `render_plan`.

    Tiles that take long are shown unfinished now and then. To cancel is to stop iterating: closing the generator stops
    the threads within a batch's bounce. The picture depends neither on threads, tiles nor border. Raises SceneError
    for what cannot be rendered.
    """
    scene, warnings = validate(scene, settings)
    yield Progress(0.0, warnings=warnings)
    plan = Plan.of(scene, settings, Requirements.of(scene, settings))
    yield Progress(0.0, warnings=_more(plan, warnings))
    yield from render_plan(plan, ends, checkpoint=checkpoint)


def prepare(scene, settings, before=None):
    """(plan, warnings): what `render_plan` renders a scene by, to be used again for other cameras, see `Plan.seen_from`.

    before  the plan of the scene as it was, if any: what has not changed is taken over from it
    Raises SceneError for what cannot be rendered.
    """
    scene, warnings = validate(scene, settings)
    plan = Plan.of(scene, settings, Requirements.of(scene, settings), before=before and before.world)
    return plan, (*warnings, *_more(plan, warnings))


def _more(plan, warnings):
    """What came up when a world was compiled, and was not known before."""
    return tuple(line for line in plan.world.warnings if line not in warnings)


def render_plan(plan, ends=(), cancelled=None, checkpoint=NO_CHECKPOINT):
    """`render` for a `Plan` that is made already. Raises SceneError if it would not fit into memory, or the checkpoint is of another plan.

    ends       numbers of samples, rising: the whole frame gets as many before any pixel gets more. Tiles come once for each,
               unfinished but for the last; without, each comes when it has all. Where pixels are divided `ends` count for nothing
    cancelled  a `threading.Event` that other threads may set: what is begun is given up within a batch's bounce, and it ends
    checkpoint where it goes on from, and what it saves now and then, see `saved`: the picture is to the bit what it would be without
    """
    settings = plan.settings
    require_room(plan, bool(ends), checkpoint.seconds > 0)
    places = _tiles(settings, plan.tile.longest_side(settings))
    ending = Ending(settings, ends if plan.tile.most_rounds(settings) == 1 else (), checkpoint.seconds)
    work = Work(places, ending, settings.error_measure, cancelled, keeps=checkpoint.seconds > 0)
    reached = work.restore(checkpoint.load(), plan)
    begin, lost = settings.rendered_samples[0], plan.world.lost.count
    if work.done_with:
        yield Progress(work.done, tuple(_tile(plan, place, values, is_final=True) for place, values in work.done_with.items()))
    workers = min(settings.threads or os.cpu_count() or 1, len(places))
    with brisk_switching(), ThreadPoolExecutor(workers, thread_name_prefix="glanz") as pool:
        try:
            while not (reached.ended_by or work.is_stopped()):
                samples = ending.following(reached.samples, reached.error, reached.scatter)
                goals = {place: goal for place, goal in ending.goals(work.found, samples).items() if place not in work.done_with}
                pending = {pool.submit(_work_on, plan, place, work, goal) for place, goal in goals.items()}
                while pending:
                    finished, pending = wait(pending, POLL_SECONDS, FIRST_COMPLETED)
                    # First the unfinished: a tile among them may be finished by now.
                    tiles = tuple(filter(None, (*work.take_unfinished(), *(future.result() for future in finished))))
                    yield Progress(ending.share(work.done, reached), tiles, work.take_warnings(), work.places, reached)
                    if reached.samples == begin and checkpoint.is_due():
                        _save(checkpoint, work, reached, has_tiles=False)
                # Without goals no pixel that has an error may get more.
                reached = work.reached(reached.samples, samples) if goals else replace(reached, ended_by="samples")
                if not (reached.ended_by or work.is_stopped()) and checkpoint.is_due():
                    _save(checkpoint, work, reached, has_tiles=True)
            # What ended early has not known that it would.
            tiles = tuple(_tile(plan, place, tile.result(not work.is_cut), is_final=True) for place, tile in work.tiles.items())
            done, tiles = (1.0, tiles) if reached.ended_by else (work.done, ())
            yield Progress(done, tiles, (*work.lost_in_all(), *plan.world.lost.since(lost)), reached=reached)
        finally:
            work.stop()
            pool.shutdown(wait=True, cancel_futures=True)


def _save(checkpoint, work, reached, has_tiles):
    """Keep a checkpoint; where that fails, as on a full disk, the picture is not lost for it."""
    try:
        checkpoint.save(work.saved(reached, has_tiles))
    except FileError as error:
        work.warn(SceneWarning(f"rendering goes on, but the last checkpoint is old or missing: {error}"))


def render_image(scene, settings, on_progress=None, checkpoint=NO_CHECKPOINT):
    """The whole `Image`; `on_progress`, if given, is called with each `Progress`; `checkpoint` as in `render_plan`."""
    x0, y0, x1, y1 = settings.region
    passes, warnings, reached = gathered(render(scene, settings, (), checkpoint), settings, on_progress)
    outcome = {f"glanz.reached.{name}": value for name, value in reached.facts().items()}
    return Image(x1 - x0, y1 - y0, passes, metadata(scene, settings) | outcome, warnings)


def gathered(steps, settings, on_progress=None):
    """(passes {name: (height, width, channels) float32}, warnings, the last `Reached`) of all `steps` of a render, each a `Progress`.

    `on_progress`, if given, is called with each.
    """
    x0, y0, x1, y1 = settings.region
    passes, warnings, reached = {}, [], NOT_BEGUN
    for progress in steps:
        warnings += progress.warnings
        reached = progress.reached
        for tile in progress.tiles:
            for name, values in tile.passes.items():
                if name not in passes:
                    passes[name] = np.zeros((y1 - y0, x1 - x0, values.shape[2]), np.float32)
                passes[name][tile.y - y0 : tile.y - y0 + tile.height, tile.x - x0 : tile.x - x0 + tile.width] = values
        if on_progress:
            on_progress(progress)
    return passes, tuple(warnings), reached


def metadata(scene, settings, layer="", requirements=None):
    """What a file should say about how its picture was made, {str: str}.

    layer         stands in front of the names of its channels
    requirements  those of the scene, if they are known
    """
    facts = {}
    for p in (PASSES[key] for key in settings.passes):
        facts |= p.facts(scene, layer) if hasattr(p, "facts") else {}
    return {
        "glanz.version": VERSION,
        "glanz.scene": scene.name,
        "glanz.camera": scene.camera.name,
        "glanz.integrator": settings.integrator,
        "glanz.sampler": settings.sampler,
        "glanz.precision": settings.precision,
        "glanz.samples": str(settings.samples),
        "glanz.sample_range": "{},{}".format(*settings.rendered_samples),
        "glanz.replicates": str(len(settings.replicate_sizes)),
        "glanz.error_target": f"{settings.error_target:g}",
        "glanz.error_measure": settings.error_measure,
        "glanz.adaptive_sampling": str(settings.adaptive_sampling),
        "glanz.time_limit": f"{settings.time_limit:g} s",
        "glanz.max_depth": str(settings.max_depth),
        "glanz.clamp_direct": f"{settings.clamp_direct:g}",
        "glanz.clamp_indirect": f"{settings.clamp_indirect:g}",
        "glanz.seed": str(settings.seed),
        "glanz.adaptive_threshold": f"{settings.adaptive_threshold:g}",
        "glanz.adaptive_levels": str(settings.adaptive_levels),
        "glanz.pixel_filter": settings.pixel_filter,
        "glanz.requirements": ", ".join((requirements or Requirements.of(scene, settings)).needs),
        **facts,
    }


def _tiles(settings, longest_side):
    """(x, y, width, height) of all tiles, from the middle outwards."""
    x0, y0, x1, y1 = settings.region
    size = min(settings.tile_size or max(x1 - x0, y1 - y0), longest_side)
    tiles = [(x, y, min(size, x1 - x), min(size, y1 - y)) for y in range(y0, y1, size) for x in range(x0, x1, size)]
    cx, cy = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
    return sorted(tiles, key=lambda tile: max(abs(tile[0] + 0.5 * tile[2] - cx), abs(tile[1] + 0.5 * tile[3] - cy)))


def _work_on(plan, place, work, goal):
    """`_render_tile`, seen by others while it lasts."""
    with work.at(place):
        return _render_tile(plan, place, work, goal)


def _render_tile(plan, place, work, goal):
    """The `Tile` at `place` when its pixels have `goal` samples, a number or (P,); None where it was cancelled."""
    if work.is_stopped():
        return None
    tile = work.tiles.pop(place, None) or plan.tile(plan, place)
    begin, end = plan.settings.rendered_samples
    weights = sample_weights(plan.filter, plan.settings.replicate_sizes)
    shown = time.monotonic()
    for number, (film, pixels) in enumerate(tile.rounds()):
        is_first = not film.samples.any()
        for window, first, count in _batches(begin + film.samples, goal, plan.replicates.edges, work):
            started = time.monotonic()
            # Every pixel has a sample before the time is over.
            if not is_first and work.ending.is_late():
                work.is_cut = True
                break
            film.open(count, window, weights[first : first + count], first)
            spread = spread_at(plan, first)
            if not trace(spread, _camera_batches(spread, pixels.part(window), first, count), film, work.is_stopped):
                return None
            film.close(is_first=first == begin)
            work.count_light(*film.light)
            if film.bad_samples:
                _report_bad(plan, film, pixels, work)
            # Nothing is shown, and no time limit seen, but between those that are together.
            work.pace(time.monotonic() - started, SHOW_SECONDS / 2, TOGETHER)
            work.finish(place, (number + film.samples.sum() / (pixels.px.size * (end - begin))) / tile.most_rounds(plan.settings))
            if time.monotonic() - shown > SHOW_SECONDS:
                work.show(_tile(plan, place, tile.result(is_whole=False), is_final=False))
                shown = time.monotonic()
    is_final = np.min(goal) == end and not work.is_cut
    values = tile.result(is_whole=is_final)
    work.found[place] = Found.of(values, tile.samples, work.measure) if plan.settings.is_measured else None
    if is_final:
        if work.keeps:
            work.done_with[place] = values
        work.finish(place, 1)
    else:
        work.tiles[place] = tile
    return _tile(plan, place, values, is_final)


def _report_bad(plan, film, pixels, work):
    """Tell `work` of the samples of a film that were not finite, and who made the first of them."""
    place, sample = film.first_bad
    pixel = pixels.part(np.array([place]))
    number = culprit(plan, pixel, sample)
    name = "" if number is None else plan.scene.objects[number].name
    work.report_bad(film.bad_samples, name, (int(pixel.px[0]), int(pixel.py[0])))
    film.bad_samples = 0


def _tile(plan, place, values, is_final):
    x, y, width, height = place
    passes = {name: np.ascontiguousarray(values[name].reshape(-1, height, width).transpose(1, 2, 0)) for name in plan.settings.passes}
    return Tile(x, y, width, height, passes, is_final)


def _camera_batches(plan, pixels, first, count):
    """`camera_rays` for samples first .. first + count - 1 of `pixels`, at most LANES of them at a time."""
    size = pixels.px.size
    step = max(1, LANES // size)
    for begin in range(0, count, step):
        rays = camera_rays(plan, pixels, first + begin, min(step, count - begin))
        rays.slot[...] += begin * size
        yield rays


def _batches(samples, goal, edges, work):
    """(window of pixels, first sample, samples) of as many batches as `work` has together, the samples of a window in order.

    They bring pixels that have `samples` (P,) to `goal`, a number or (P,). None goes on beyond the samples `edges`.
    """
    # Those from and to the same numbers together.
    ways = samples << np.int64(32) | goal
    for way in np.unique(ways).tolist():
        begin, end = way >> 32, way & 0xFFFFFFFF
        pixels = np.nonzero(ways == way)[0]
        at_once = min(pixels.size, LANES)
        count = max(1, LANES // at_once)
        bounds = (begin, *(int(edge) for edge in edges if begin < edge < end), end)
        for start in range(0, pixels.size, at_once):
            window = _window(pixels[start : start + at_once])
            for lower, upper in pairwise(bounds):
                first = lower
                while first < upper:
                    several = min(work.together * count, upper - first)
                    yield window, first, several
                    first += several


def _window(pixels):
    """Rising places as a slice, which is faster, where there are no gaps."""
    first, end = int(pixels[0]), int(pixels[-1]) + 1
    return slice(first, end) if end - first == pixels.size else pixels
