"""Whether an error that is asked for is the error that is reached: every sample scene, twenty times.

    python -m benchmarks.targets [--quick] [scene ...]

Each scene is rendered to `TARGET` with `SEEDS` seeds, and each picture is held against the mean of all the others: that is a reference of
19 times as many samples, whose own error is known and taken off. So the noise is measured; that it is all, and there is no bias, other
tests say. Prints a table; a whole run writes docs/targets.md and docs/targets.json, others out/targets.
"""

import json
import math
import sys
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
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
SEEDS, SIDE, MOST = 20, 32, 2**16
QUICK = {"seeds": 4, "side": 16}


def main(words=None, workers=None):
    names, is_quick = asked(
        "benchmarks.targets", __doc__, "scene", small_scenes.NAMES, "16 pixels wide, 4 seeds: to see that it works", words
    )
    effort = {"seeds": SEEDS, "side": SIDE} | (QUICK if is_quick else {})
    folder = ROOT / "docs" if not is_quick and set(names) == set(small_scenes.NAMES) else ROOT / "out" / "targets"
    folder.mkdir(parents=True, exist_ok=True)
    results = {"facts": describe_machine() | effort | {"target": TARGET, "most": MOST}, "scenes": {}}
    # One thread each: what a picture costs does not matter here.
    with ProcessPoolExecutor(workers) as pool:
        for name, found in zip(names, pool.map(measured, names, *([effort[key]] * len(names) for key in effort)), strict=True):
            results["scenes"][name] = found
            print(row(name, found), file=sys.stderr, flush=True)
            # What is measured is not lost if a later scene fails.
            (folder / "targets.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
            (folder / "targets.md").write_text(page(results), encoding="utf-8")
    print(page(results))


def measured(name, seeds, side):
    """{"reached", "stated", "samples": lists over the seeds} of a sample scene, errors over `TARGET`; and "most", MOST.

    One that needs more than so many samples has one picture, and nothing "reached".
    """
    scene, settings = small_scenes.load(name, side, side * 3 // 4)
    settings = replace(curve.plain(settings), integrator="path", sampler="sobol", samples=MOST, replicates=0, error_target=TARGET)
    pictures, ends = [], []
    for seed in range(seeds):
        plan, _ = prepare(scene, replace(settings, seed=seed))
        passes, _, reached = gathered(render_plan(plan), settings)
        pictures.append(passes["Combined"][..., :3].astype(np.float64))
        ends.append(reached)
        if reached.ended_by != "error":
            break
    return {
        "reached": [error / TARGET for error in errors(np.stack(pictures))] if reached.ended_by == "error" else [],
        "stated": [end.error / TARGET for end in ends],
        "samples": [end.samples for end in ends],
        "most": MOST,
    }


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


def row(name, found):
    """A line of the table."""
    samples, stated = f"{np.mean(found['samples']):,.0f}", f"{np.mean(found['stated']):.2f}"
    if not found["reached"]:
        return f"| {name} | not within {found['most']:,} samples | | {stated} | | {samples} |"
    low, middle, high = np.percentile(found["reached"], (5, 50, 95))
    return f"| {name} | {middle:.2f} | {low:.2f} to {high:.2f} | {stated} | {inside(found)} of {len(found['reached'])} | {samples} |"


def page(results):
    """The text of docs/targets.md."""
    facts, scenes = results["facts"], results["scenes"]
    ended = [found for found in scenes.values() if found["reached"]]
    good = sum(inside(found) >= 0.95 * facts["seeds"] for found in ended)
    pictures = sum(inside(found) for found in ended), sum(len(found["reached"]) for found in ended)
    lines = [
        "# Errors that are asked for, and reached",
        "",
        f"`make bench-targets` path traces sample scenes, {facts['side']} pixels wide, with an error target of {100 * TARGET:g} %",
        f"and {facts['seeds']} seeds. {pictures[0]} of {pictures[1]} pictures reached {LOWEST} to {HIGHEST} times the target.",
        f"{len(ended)} of the {len(scenes)} scenes got that far with the samples they may have; in {good} of these 19 of 20 pictures did.",
        "Errors are in units of the target. Each picture is held against the mean of the others, a reference of 19 times as many",
        "samples whose own error is taken off: that is the noise; that there is no bias is for tests to say. In so small pictures a",
        "single pixel that light is rarely found for counts for much.",
        "",
        "| scene | reached (median) | 5 to 95 of 100 | stated (mean) | in the bounds | samples |",
        "|---|---|---|---|---|---|",
        *(row(name, found) for name, found in scenes.items()),
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    main()
