"""The Cornell box by Glanz and by Cycles in turns, so that whatever else the machine does meets both; medians of five."""

import time
from statistics import median

from glanz.addon.capture import capture
from glanz.engine import render_image

from . import blender
from .embree_time import timed

SAMPLES, ROUNDS = 16, 5


def main():
    blender.open_cornell_box(samples=1)
    for engine in ("GLANZ", "CYCLES"):
        blender.press_f12(engine)  # libraries are loaded, kernels are chosen
    blender.set_samples(SAMPLES)
    times = {"GLANZ": [], "CYCLES": []}
    for _ in range(ROUNDS):
        for engine, seconds in times.items():
            seconds.append(blender.press_f12(engine))
    with blender.quiet():
        scene, settings, _ = capture()
    wall = {engine: median(w for w, _ in seconds) for engine, seconds in times.items()}
    cpu = {engine: median(c for _, c in seconds) for engine, seconds in times.items()}
    result = {
        "samples": SAMPLES,
        "threads": settings.threads,
        "bounces": settings.max_depth,
        "glanz": wall["GLANZ"],
        "cycles": wall["CYCLES"],
        "ratio": median(g / c for (g, _), (c, _) in zip(times["GLANZ"], times["CYCLES"])),
        "glanz_cpu": cpu["GLANZ"],
        "cycles_cpu": cpu["CYCLES"],
        "cpu_ratio": median(g / c for (_, g), (_, c) in zip(times["GLANZ"], times["CYCLES"])),
        "rounds": times,
    }
    blender.finish(result | engine_alone(scene, settings))


def engine_alone(scene, settings):
    """The core without Blender around it, and how much of it is Embree."""
    walls, shares = [], []
    for _ in range(3):
        start = time.perf_counter()
        render_image(scene, settings)
        walls.append(time.perf_counter() - start)
    with timed() as scenes:
        for _ in range(3):
            start = time.process_time()
            render_image(scene, settings)
            shares.append(100 * scenes[-1].seconds / (time.process_time() - start))
    rays = scenes[-1].rays * 1e-6
    return {"core": median(walls), "embree_share": median(shares), "rays": rays, "rays_per_second": rays / median(walls)}


if __name__ == "__main__":
    main()
