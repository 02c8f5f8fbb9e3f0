"""The numbers of one scene."""

import time
from dataclasses import dataclass, replace
from itertools import product

import numpy as np

from glanz.cli import curve
from glanz.engine import INTEGRATORS
from glanz.engine.rendering import LANES

from .. import small_scenes


@dataclass(frozen=True)
class Effort:
    """How much is measured.

    size          pictures for errors, and for times as long as they fill a batch [px]
    timed_size    for the times of few samples: a tile as large as most are, so that its batches are as full as they [px]
    whitted_size  where pixels are divided: the larger the picture, the fewer of them have edges [px]
    depths, samples  the ladder
    deepest, longest  bounces and samples of the reference
    ladder_seeds  renders of a rung
    paced, rounds  samples, and how often, for the time of a sample at each depth
    seeds         rounds in which all presets are rendered, one after the other, as machines are faster now and then
    """

    size: tuple = (32, 24)
    timed_size: tuple = (64, 48)
    whitted_size: tuple = (96, 72)
    depths: tuple = (2, 4, 8, 16, 32)
    samples: tuple = (4, 16, 64, 256)
    deepest: int = 256
    longest: int = 4096
    ladder_seeds: int = 2
    paced: int = 64
    rounds: int = 5
    seeds: int = 3


QUICK = Effort((16, 12), (16, 12), (32, 24), samples=(4, 16, 64), longest=256, rounds=2, seeds=2)


def measure(name, presets, effort):
    """{"ladder": [{"depth", "samples", "rmse", "noise", "bias"}], "paces": {depth: microseconds of a sample in a pixel},
    "presets": {key: {"microseconds", "rmse", "noise", "bias"}}}, of `presets` {key: {setting: value}}.

    Microseconds are of a pixel with all of its samples. Errors are relative to the mean brightness of the pixels that count, see
    `small_scenes.lighted`; what has another model of light than the reference has noise alone, relative to its own mean.
    """
    scene, settings = small_scenes.load(name, *effort.size)
    counts = small_scenes.lighted(scene, settings)
    long = reference(scene, settings, counts, effort)
    return {
        "ladder": climbed(scene, settings, counts, long, effort),
        "paces": paced(scene, settings, effort),
        "presets": rated(scene, settings, counts, long, presets, effort),
    }


def reference(scene, settings, counts, effort):
    """The `Reference` of the pixels that count."""
    long = curve.reference(scene, settings, effort.deepest, effort.longest, _silent)
    return curve.Reference(long.truth[counts], long.doubt[counts])


def climbed(scene, settings, counts, long, effort):
    """The rungs of the ladder."""
    rungs = []
    for depth, samples in product(effort.depths, effort.samples):
        asked = replace(curve.plain(settings), integrator="path", sampler="sobol", max_depth=depth, samples=samples)
        pictures = np.stack([_render(scene, asked, seed, effort.size)[0] for seed in range(effort.ladder_seeds)])
        rungs.append({"depth": depth, "samples": samples} | _told(pictures[:, counts], long))
    return rungs


def paced(scene, settings, effort):
    """{depth: microseconds of a sample in a pixel}: the least of some rounds, as a machine that has else to do is slower now and then."""
    found = {str(depth): [] for depth in effort.depths}
    for seed in range(effort.rounds):
        for depth, paces in found.items():
            asked = replace(curve.plain(settings), integrator="path", sampler="sobol", max_depth=int(depth), samples=effort.paced)
            paces.append(_render(scene, asked, seed, effort.size)[1] / effort.paced)
    return {depth: _rounded(min(paces)) for depth, paces in found.items()}


def rated(scene, settings, counts, long, presets, effort):
    """What there is to say of each preset."""
    plain = {key: replace(curve.plain(settings), **changes) for key, changes in presets.items()}
    large = replace(settings, width=effort.whitted_size[0], height=effort.whitted_size[1])
    found = {key: ([], []) for key in presets}
    for seed in range(effort.seeds):
        for key, asked in plain.items():
            size = effort.size if INTEGRATORS[asked.integrator].is_complete else effort.whitted_size
            picture, pace = _render(scene, asked, seed, size)
            if size[0] * size[1] * asked.samples < LANES and size < effort.timed_size:
                # Its own batches are not full.
                _, pace = _render(scene, asked, seed, effort.timed_size)
            found[key][0].append(picture)
            found[key][1].append(pace)
    result = {}
    for key, (pictures, paces) in found.items():
        pictures, told = np.stack(pictures), {"microseconds": _rounded(np.median(paces))}
        if INTEGRATORS[plain[key].integrator].is_complete:
            result[key] = told | _told(pictures[:, counts], long)
        else:
            pictures = pictures[:, small_scenes.lighted(scene, large, samples=64)]
            own = curve.Reference(pictures.mean(axis=0), np.zeros(pictures.shape[1:]))
            result[key] = told | {"noise": _told(pictures, own)["noise"]}
    return result


def _render(scene, asked, seed, size):
    """(picture (H, W, 3), microseconds of the processor for a pixel)."""
    width, height = size
    sized = replace(asked, width=width, height=height, seed=seed)
    passes, seconds, _ = curve.rendered(scene, sized, _silent, time.process_time)
    return passes["Combined"][..., :3].astype(np.float64), 1e6 * seconds / width / height


def _told(pictures, against):
    found = curve.errors(pictures, against.truth, against.doubt)
    return {key: _rounded(found[key]) for key in ("rmse", "noise", "bias")}


def _rounded(value):
    """To four digits: more are noise."""
    return float(f"{value:.4g}")


def _silent(done):
    pass
