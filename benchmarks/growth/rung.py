"""One rung in a process of its own: python -m benchmarks.growth.rung LADDER SIZE [SECONDS]; the last line is its result, JSON.

With SECONDS it says READY and renders again and again for about so long, for others to look at.
"""

import dataclasses
import json
import os
import sys
import time
from pathlib import Path

from glanz.engine import prepare, render_image, render_plan

from ..memory import peak
from .ladders import BASE, LADDERS

READY = "ready"
ROUNDS, ENOUGH = 3, 2.0
"""A rung is measured so often, but not again once it took so many seconds of processor time in all."""


def measure(ladder, size):
    """{"size", "prepare", "render": processor time [s], "wall": of rendering [s], "memory" [MB], "rounds"}.

    Memory is the most of the first round over what a tiny render left, scene and picture included. Times are
    the smallest of the rounds: what the machine does besides only ever adds.
    """
    warm_up(ladder)
    before, rounds = forget_highest(), []
    while len(rounds) < ROUNDS and sum(first + second for first, second, _ in rounds) < ENOUGH:
        # Anew each time, as scenes keep what was computed from them.
        scene, settings = LADDERS[ladder].rung(size)
        start = time.process_time()
        plan, _ = prepare(scene, settings)
        ready, wall = time.process_time(), time.perf_counter()
        picture = [tile for progress in render_plan(plan) for tile in progress.tiles if tile.is_final]
        rounds.append((ready - start, time.process_time() - ready, time.perf_counter() - wall))
        if len(rounds) == 1:
            memory = highest() - before
        del scene, plan, picture
    return {"size": size, **dict(zip(("prepare", "render", "wall"), map(min, zip(*rounds)))), "memory": memory, "rounds": len(rounds)}


def warm_up(ladder):
    """The smallest rung with few pixels: libraries are loaded, kernels chosen, tables made."""
    scene, settings = LADDERS[ladder].rung(LADDERS[ladder].sizes[0])
    render_image(scene, dataclasses.replace(settings, width=16, height=16, samples=1, threads=BASE.threads))


def forget_highest():
    """The resident set as it is [MB], from which `highest` begins anew where the system can do that: Linux."""
    try:
        Path("/proc/self/clear_refs").write_text("5", encoding="ascii")
    except OSError:
        return highest()
    return status("VmRSS")


def highest():
    """Largest resident set of this process so far [MB]."""
    try:
        return status("VmHWM")
    except (OSError, StopIteration):
        return peak()


def status(key):
    """A memory of this process [MB] as Linux tells it; `peak` would count the process that started this one, if that was larger."""
    with open("/proc/self/status", encoding="ascii") as lines:
        return next(float(line.split()[1]) for line in lines if line.startswith(f"{key}:")) * 1.024e-3


def main(ladder, size, seconds=0.0):
    if not seconds:
        print(json.dumps(measure(ladder, size)), flush=True)
        return
    warm_up(ladder)
    plan, _ = prepare(*LADDERS[ladder].rung(size))
    print(READY, flush=True)
    end = time.monotonic() + seconds
    while time.monotonic() < end:
        for _ in render_plan(plan):
            pass


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), *map(float, sys.argv[3:]))
    os._exit(0)
