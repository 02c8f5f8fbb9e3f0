"""What accuracy costs in a scene: error against time for a ladder of settings, measured against a long reference.

The mean squared error of a picture is that of its noise and of its bias: replicates, which are renders with other seeds, differ
by the noise alone, and what is left is the bias of an integrator that leaves out light, of few bounces, or none.
"""

import math
import time
from dataclasses import asdict, dataclass, replace
from itertools import product

import numpy as np

from ..engine import SceneError, gathered, prepare, render_plan, validate

SEEDS = 3
"""Renders of each setting: enough to tell noise from bias, as every pixel tells it."""
REFERENCE_SEED = 0x5EED
REPLICATES = 8
LONGER = 16
"""Times the most samples of the ladder: the reference's own error is a quarter of theirs, and taken off."""
LONGEST = 256
DARK = 0.01
"""What is added to the square of the reference where errors are relative to it, so that black pixels are none (Rousselle et al. 2011)."""


@dataclass(frozen=True)
class Rung:
    """One setting of the ladder, and what came of it.

    seconds     of rendering, the median; `prepared` are those before it, of compiling the scene
    rmse        root of the mean squared error over the mean of the reference
    relmse      mean squared error relative to the squared reference, see DARK
    flip        mean FLIP error (Andersson et al. 2021) in [0, 1]; None where the library is missing
    noise, bias  the parts of rmse^2, as roots; a bias below what the noise of the measurement hides is 0
    slope       of the noise over the samples in this rung's curve, as an exponent; None for a single number of samples
    is_best     whether nothing else has less error in less time: it is on the Pareto front
    """

    integrator: str
    sampler: str
    max_depth: int
    samples: int
    seconds: float
    prepared: float
    rmse: float
    relmse: float
    flip: float | None
    noise: float
    bias: float
    slope: float | None = None
    is_best: bool = False
    precision: str = "fast"

    @property
    def curve(self):
        """What it has in common with others that differ in samples."""
        return self.integrator, self.sampler, self.max_depth, self.precision

    @property
    def kind(self):
        """Which part of the error is the larger: "noise" or "bias", or both where neither is below a tenth."""
        whole = self.noise**2 + self.bias**2
        share = self.bias**2 / whole if whole else 0.0
        return "noise" if share < 0.1 else "bias" if share > 0.9 else "noise and bias"

    def as_dict(self):
        """{str: value}, for tables."""
        return asdict(self) | {"kind": self.kind}


def small(width, height):
    """(width, height) [px] of the same shape whose longer side has LONGEST at most: error per pixel does not depend on their number."""
    scale = min(1.0, LONGEST / max(width, height))
    return max(1, round(width * scale)), max(1, round(height * scale))


@dataclass(frozen=True)
class Reference:
    """What pictures are measured against: `truth` (H, W, 3), and its standard error `doubt`, of the same shape; float64."""

    truth: np.ndarray
    doubt: np.ndarray


def measure(scene, settings, integrators, samplers, depths, samples, on_progress, precisions=()):
    """[Rung] of all combinations, in this order, for the rest of `settings`; `on_progress` is called with the share done, in [0, 1].

    Without `precisions` there is that of the settings. Raises SceneError for what cannot be rendered.
    """
    ladder = [
        replace(plain(settings), integrator=integrator, sampler=sampler, max_depth=depth, precision=precision, samples=count)
        for integrator, sampler, depth, precision, count in product(
            integrators, samplers, depths, precisions or (settings.precision,), samples
        )
    ]
    for asked in ladder:
        # Before the work, not after it.
        validate(scene, asked)
    longest = LONGER * max(samples)
    whole = sum(asked.samples for asked in ladder) * SEEDS + longest
    done = 0

    def advance(share, count):
        on_progress((done + share * count) / whole)

    against = reference(scene, settings, max(*depths, settings.max_depth), longest, lambda share: advance(share, longest))
    done += longest
    rungs = []
    for asked in ladder:
        found = []
        for seed in range(SEEDS):
            seeded = replace(asked, seed=settings.seed + seed)
            found.append(rendered(scene, seeded, lambda share, count=asked.samples: advance(share, count)))
            done += asked.samples
        pictures = np.stack([passes["Combined"][..., :3] for passes, _, _ in found]).astype(np.float64)
        rungs.append(
            Rung(
                asked.integrator,
                asked.sampler,
                asked.max_depth,
                asked.samples,
                seconds=float(np.median([seconds for _, seconds, _ in found])),
                prepared=float(np.median([prepared for _, _, prepared in found])),
                flip=_flip(against.truth, pictures),
                precision=asked.precision,
                **errors(pictures, against.truth, against.doubt),
            )
        )
    return _ranked(rungs)


def plain(settings):
    """The same settings for the picture alone, with a number of samples that is known beforehand and the same in all pixels."""
    unbiased = replace(settings, passes=("Combined",), clamp_direct=0.0, clamp_indirect=0.0)
    return replace(unbiased, sample_range=(), adaptive_threshold=0.0, replicates=1, error_target=0.0, time_limit=0.0)


def reference(scene, settings, max_depth, samples, on_progress):
    """The `Reference` by path tracing of up to `max_depth` bounces, for the rest of `settings`. Raises SceneError for a black one."""
    deepest = replace(plain(settings), integrator="path", sampler="sobol", max_depth=max_depth, samples=samples, seed=REFERENCE_SEED)
    asked = replace(deepest, replicates=REPLICATES, passes=("Combined", "Standard Error"))
    passes, _, _ = rendered(scene, asked, on_progress)
    truth, doubt = passes["Combined"][..., :3], passes["Standard Error"]
    if not truth.mean() > 0:
        raise SceneError(f"scene '{scene.name}' is black: there is no error relative to its mean; is there any light?")
    return Reference(truth.astype(np.float64), doubt.astype(np.float64))


def errors(pictures, truth, doubt):
    """{"rmse", "relmse", "noise", "bias"} of pictures (R, H, W, 3), renders of one thing, against `truth` of standard error `doubt`."""
    away = pictures - truth
    squares = np.square(away).mean(axis=0) - np.square(doubt)
    noises = pictures.var(axis=0, ddof=1)
    # The mean of all renders is away from the truth by the bias, by a share of the noise and by the doubt.
    biases = np.square(away.mean(axis=0)) - noises / len(pictures) - np.square(doubt)
    bias = biases.mean()
    # Pixels are independent of each other: what their mean may be by chance.
    hidden = 4 * biases.std() / math.sqrt(biases.size)
    mean = truth.mean()
    return {
        "rmse": math.sqrt(max(squares.mean(), 0.0)) / mean,
        "relmse": max(float((squares / (np.square(truth) + DARK)).mean()), 0.0),
        "noise": math.sqrt(noises.mean()) / mean,
        "bias": math.sqrt(bias) / mean if bias > hidden else 0.0,
    }


def rendered(scene, settings, on_progress, clock=time.perf_counter):
    """({pass: (H, W, C)}, seconds of rendering, seconds of compiling) by a `clock`."""
    began = clock()
    plan, _ = prepare(scene, settings)
    prepared = clock()
    passes, _, _ = gathered(render_plan(plan), settings, lambda progress: on_progress(progress.done))
    return passes, clock() - prepared, prepared - began


def _flip(truth, pictures):
    try:
        import flip_evaluator
    except ImportError:
        return None
    # It knows no light below none, which filters with negative lobes leave.
    truth = np.maximum(truth, 0).astype(np.float32)
    found = [flip_evaluator.evaluate(truth, np.maximum(p, 0).astype(np.float32), "HDR", applyMagma=False)[1] for p in pictures]
    return float(np.mean(found))


def _ranked(rungs):
    """The same with slopes and the Pareto front."""
    result = []
    for rung in rungs:
        same = [other for other in rungs if other.curve == rung.curve and other.noise > 0]
        slope = None
        if len(same) > 1:
            slope = float(np.polyfit(np.log([s.samples for s in same]), np.log([s.noise for s in same]), 1)[0])
        own = rung.seconds, rung.rmse
        is_best = not any(o.seconds <= rung.seconds and o.rmse <= rung.rmse and (o.seconds, o.rmse) != own for o in rungs)
        result.append(replace(rung, slope=slope, is_best=is_best))
    return result
