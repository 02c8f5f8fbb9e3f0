"""Whether an error that is asked for is the error that is reached: every sample scene, twenty times.

    python -m benchmarks.targets [--quick] [scene ...]

Each scene is rendered to `TARGET` with `SEEDS` seeds, and each picture is held against the mean of all the others: that is a reference of
19 times as many samples, whose own error is known and taken off. So the noise is measured; that it is all, and there is no bias, other
tests say. A scene that misses the bounds too often is rendered once more twice as wide, where luck should be less. Writes
docs/targets.md and docs/targets.json, in which scenes that are not named stay as they were measured last: so a night can be divided.
What is quick goes to out/targets.
"""

import json
import math
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from datetime import date
from pathlib import Path

import numpy as np

from ..cli import curve
from ..engine import gathered, prepare, render_plan
from . import small_scenes
from .__main__ import describe_machine
from .words import asked

ROOT = Path(__file__).resolve().parents[1]
TARGET = 0.01
LOWEST, HIGHEST = 0.7, 1.05
"""Times the target: where the reached error is to be."""
SEEDS, SIDE, MOST = 20, 32, 2**18
QUICK = {"seeds": 4, "side": 16}


def main(words=None, workers=None):
    names, is_quick = asked(
        "benchmarks.targets", __doc__, "scene", small_scenes.NAMES, "16 pixels wide, 4 seeds: to see that it works", words
    )
    effort = {"seeds": SEEDS, "side": SIDE} | (QUICK if is_quick else {})
    folder = ROOT / "out" / "targets" if is_quick else ROOT / "docs"
    folder.mkdir(parents=True, exist_ok=True)
    # One thread each: what a picture costs does not matter here.
    with ProcessPoolExecutor(workers) as pool:
        for name in names:
            found = measured(pool, name, **effort)
            if found["reached"] and not is_good(found):
                found["wider"] = measured(pool, name, effort["seeds"], 2 * effort["side"])
            print(*rows(name, found, effort["side"]), sep="\n", file=sys.stderr, flush=True)
            # What is measured is not lost if a later scene fails.
            results = keep(folder / "targets.json", name, found, effort)
            (folder / "targets.md").write_text(page(results), encoding="utf-8")
    print(page(results))


def keep(path, name, found, effort):
    """Everything measured with this effort, with what is `found` for the scene `name`, which is written to `path`."""
    old = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    is_alike = all(old.get("facts", {}).get(key) == value for key, value in effort.items())
    scenes = dict(sorted(((old["scenes"] if is_alike else {}) | {name: found}).items()))
    results = {"facts": describe_machine() | effort | {"target": TARGET}, "scenes": scenes}
    path.write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    return results


def measured(pool, name, seeds, side):
    """{"reached", "stated", "samples": lists over the seeds} of a sample scene, errors over `TARGET`; "most", MOST; and the "date".

    One that needs more than so many samples has no further pictures, and nothing "reached".
    """
    pictures, ends = [], []
    for pixels, end in pool.map(picture, [name] * seeds, range(seeds), [side] * seeds):
        pictures.append(pixels)
        ends.append(end)
        if end.ended_by != "error":
            break
    return {
        "reached": [error / TARGET for error in errors(np.stack(pictures))] if end.ended_by == "error" else [],
        "stated": [end.error / TARGET for end in ends],
        "samples": [end.samples for end in ends],
        "most": MOST,
        "date": date.today().isoformat(),
    }


def picture(name, seed, side):
    """(the pixels (H, W, 3) float64 of a sample scene rendered to `TARGET`, how that ended)."""
    scene, settings = small_scenes.load(name, side, side * 3 // 4)
    settings = replace(curve.plain(settings), integrator="path", sampler="sobol", samples=MOST, replicates=0, error_target=TARGET)
    plan, _ = prepare(scene, replace(settings, seed=seed))
    passes, _, reached = gathered(render_plan(plan), settings)
    return passes["Combined"][..., :3].astype(np.float64), reached


def errors(pictures):
    """The relative RMSE of each of pictures (S, H, W, C) against the mean of the others, less what that is itself away from the truth.

    With S - 1 pictures of equal noise the square is too large by 1 / (S - 1) of it.
    """
    count, whole = len(pictures), pictures.sum(axis=0)
    squares = [np.square(p - (whole - p) / (count - 1)).mean() * (count - 1) / count for p in pictures]
    return [math.sqrt(square) * count / whole.mean() for square in squares]


def inside(found):
    """How many pictures are as near to the truth as they are to be, and no nearer."""
    return sum(LOWEST <= error <= HIGHEST for error in found["reached"])


def is_good(found):
    """Whether 19 of 20 pictures are."""
    return bool(found["reached"]) and inside(found) >= 0.95 * len(found["reached"])


def rows(name, found, side):
    """The lines of the table for a scene: one, or another for pictures twice as wide."""
    yield row(name, found)
    if "wider" in found:
        yield row(f"{name}, {2 * side} px", found["wider"])


def row(name, found):
    """A line of the table."""
    samples, stated = f"{np.mean(found['samples']):,.0f}", f"{np.mean(found['stated']):.2f}"
    if not found["reached"]:
        return f"| {name} | not within {found['most']:,} samples | | {stated} | | {samples} | {found['date']} |"
    low, middle, high = np.percentile(found["reached"], (5, 50, 95))
    reached = f"{middle:.2f} | {low:.2f} to {high:.2f} | {stated} | {inside(found)} of {len(found['reached'])}"
    return f"| {name} | {reached} | {samples} | {found['date']} |"


def page(results):
    """The text of docs/targets.md."""
    facts, scenes = results["facts"], results["scenes"]
    ended = [found for found in scenes.values() if found["reached"]]
    good = sum(map(is_good, ended))
    wider = [is_good(found["wider"]) for found in ended if "wider" in found]
    pictures = sum(inside(found) for found in ended), sum(len(found["reached"]) for found in ended)
    lines = [
        "# Errors that are asked for, and reached",
        "",
        f"`make bench-targets` path traces sample scenes, {facts['side']} pixels wide, with an error target of {100 * TARGET:g} %",
        f"and {facts['seeds']} seeds. {pictures[0]} of {pictures[1]} pictures reached {LOWEST} to {HIGHEST} times the target.",
        f"{len(ended)} of the {len(scenes)} scenes got that far with the samples they may have; in {good} of these 19 of 20 pictures did.",
        "Errors are in units of the target. Each picture is held against the mean of the others, a reference of 19 times as many",
        "samples whose own error is taken off: that is the noise; that there is no bias is for tests to say. In so small pictures a",
        "single pixel that light is rarely found for counts for much, and a picture's own luck is a larger share of its error.",
        f"Scenes that missed the bounds were rendered once more twice as wide: {len(wider)}, of which {sum(wider)} kept to them there.",
        "Samples are those that the engine took on the day that the scene was measured.",
        "",
        "| scene | reached (median) | 5 to 95 of 100 | stated (mean) | in the bounds | samples | measured |",
        "|---|---|---|---|---|---|---|",
        *(line for name, found in scenes.items() for line in rows(name, found, facts["side"])),
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
