"""What it costs that replicates do not complement each other: their noise over that of one even set.

    python -m benchmarks.replicates [--quick] [scene ...]

Prints the table of docs/speed_and_accuracy.md: of all pixels, by which an error target goes; of those in which the camera sees no lamp
and no world; and of the middle one of them, which says more where rare bright paths are most of the noise, and their number is chance.
For the same noise time grows by the square.
"""

import math
import os
from dataclasses import replace

import numpy as np

from glanz.cli import curve

from . import small_scenes
from .words import asked

SCENES = ("cornell_box", "depth_of_field", "environment", "soft_shadow")
SIZE = 32, 24
SAMPLES = 64, 512
SETS = {"2": {"replicates": 2}, "4": {"replicates": 4}, "8": {"replicates": 8}, "16": {"replicates": 16}}
SETS["growing"] = {"replicates": 0, "error_target": 1e-9, "adaptive_sampling": False}
"""Those of an error target that is never reached, all pixels alike."""
SEEDS = 4
"""Renders of each: ratios are known to a tenth, where no few bright paths are most of the noise."""


def main(words=None):
    names, is_quick = asked("benchmarks.replicates", __doc__, "scene", SCENES, "two renders of each", words)
    print("| scene | samples | pixels | " + " | ".join(SETS) + " |", "|---" * (len(SETS) + 3) + "|", sep="\n")
    for name in names:
        scene, settings = small_scenes.load(name, *SIZE)
        every, counts = np.ones(SIZE[::-1], bool), small_scenes.lighted(scene, settings)
        for count in SAMPLES:
            seeds = range(2 if is_quick else SEEDS)
            even = renders(scene, settings, count, seeds, {})
            found = {key: renders(scene, settings, count, seeds, changes) for key, changes in SETS.items()}
            for label, pixels, told in (("all", every, noise), ("lit", counts, noise), ("middle of lit", counts, middle_noise)):
                ratios = (told(pictures[:, pixels]) / told(even[:, pixels]) for pictures in found.values())
                print(f"| {name} | {count} | {label} | " + " | ".join(f"{ratio:.2f}" for ratio in ratios) + " |", flush=True)
    os._exit(0)


def renders(scene, settings, count, seeds, changes):
    """Pictures (R, H, W, 3) of the `seeds`, by Sobol, of `count` samples with the `changes` of settings."""
    changed = replace(curve.plain(settings), sampler="sobol", samples=count, **changes)
    passes = [curve.rendered(scene, replace(changed, seed=seed), lambda done: None)[0]["Combined"] for seed in seeds]
    return np.stack(passes)[..., :3].astype(np.float64)


def noise(pictures):
    """That of pictures (R, N, 3), renders of one thing, relative to their mean."""
    mean = pictures.mean(axis=0)
    return curve.errors(pictures, mean, np.zeros_like(mean))["noise"]


def middle_noise(pictures):
    """That of the middle one of the pixels of `pictures`, relative to nothing."""
    return math.sqrt(np.median(pictures.var(axis=0, ddof=1).mean(axis=-1)))


if __name__ == "__main__":
    main()
