"""How fast the error falls with the samples, for each sampler: writes docs/convergence.md and its plots.

    python -m benchmarks.convergence

In all cases but the edge every pixel sees the same point, so that pixels are replicates of one integral whose value is known.
"""

import math
from dataclasses import replace
from pathlib import Path

import matplotlib
import numpy as np

from glanz.engine import (
    SAMPLERS,
    AreaLight,
    Lambert,
    Lens,
    Material,
    Mesh,
    Object,
    OrthographicCamera,
    PerspectiveCamera,
    Phong,
    Scene,
    Settings,
    render_image,
)

matplotlib.use("Agg")
from matplotlib import pyplot as plt

DOCS = Path(__file__).resolve().parent.parent / "docs"
SAMPLES = (1, 4, 16, 64, 256, 1024)
SIDE, SEEDS = 24, 2
DEFAULT = Settings().sampler
ANGLE, AWAY = 0.4, 0.05
"""Edges that follow no axis: the direction of their normal [rad], and how far from the middle they are [m]."""
THEORY = {
    "smooth": "-1/2 random, -1 stratified, -3/2 multi-jittered (here), Sobol and blue noise, less for kinks",
    "square_light": "-1/2 random; scattered rays see the light's edge, with a small weight: between smooth and edge",
    "edge": "-1/2 random, -3/4 all others",
    "soft_shadow": "-1/2 random, -3/4 all others",
    "lens": "-1/2 random, -3/4 all others",
    "glossy": "-1/2 random; between an edge and smooth light for all others",
}
NAMES = {
    "smooth": "Smooth shading: a light that fades to its edges, over a diffuse point",
    "square_light": "Square light over a diffuse point",
    "edge": "Edge: pixels that a straight edge goes through",
    "soft_shadow": "Soft shadow: the same light behind a straight edge",
    "lens": "Lens: a straight edge out of focus",
    "glossy": "Glossy: a Phong lobe, n = 50, mirrors the light",
}


def plane(centre, x, y, name, emission=0.0, lobes=()):
    """A parallelogram with the full edges x and y as an `Object`."""
    centre, x, y = np.array(centre, float), np.array(x, float), np.array(y, float)
    corners = np.stack([centre + (a * x + b * y) / 2 for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)
    material = Material(name=name, lobes=lobes, emission=(emission,) * 3)
    mesh = Mesh(name=name, vertices=corners, triangles=np.array([[0, 1, 2], [0, 2, 3]]).T)
    return Object(name=name, mesh=mesh, materials=(material,), world_from_object=np.eye(4))


def half_plane(z, name, emission):
    """What lies beyond the edge at height z."""
    n = np.array((math.cos(ANGLE), math.sin(ANGLE), 0))
    return plane(n * (AWAY + 5) + (0, 0, z), 10 * n, (-20 * n[1], 20 * n[0], 0), name, emission)


def lit_point(lobe, objects=(), at=(0.0, 0.0), **light_values):
    """The origin under a light of 1 x 1 m, `at` x, y and the height of 1 m, seen from the side that `half_plane` leaves free."""
    n = np.array((math.cos(ANGLE), math.sin(ANGLE), 0))
    light = np.eye(4)
    light[:3, 3] = (*at, 1.0)
    camera = PerspectiveCamera.look_at(tuple(-0.5 * n + (0, 0, 1)), (0, 0, 0), fov=1e-6)
    floor = plane((0, 0, 0), (0.01, 0, 0), (0, 0.01, 0), "floor", lobes=(lobe,))
    return Scene(camera=camera, objects=(floor, *objects), lights=(AreaLight(world_from_light=light, **light_values),))


def cases():
    """{name: (scene, truth)}; a truth is a number, or an array of which NaN pixels do not count, or None: not known."""
    white = Lambert((1.0,) * 3)
    down = {"up": (0, 1, 0)}
    disk = AWAY / 0.1
    lens = PerspectiveCamera.look_at((0, 0, 1), (0, 0, 0), fov=1e-6, lens=Lens(radius=0.1, focus_distance=0.5), **down)
    return {
        # No edge at all: within 1.5 rad the light fades to nothing before it ends. Off the middle, or symmetry would help some.
        "smooth": (lit_point(white, at=(0.4, 0.3), size_x=3.0, size_y=3.0, spread=1.5), None),
        "square_light": (lit_point(white), irradiance(math.inf) / math.pi),
        "edge": (
            Scene(
                camera=OrthographicCamera.look_at((0, 0, 1), (0, 0, 0), height=1.0, **down),
                objects=(half_plane(0.0, "lit", 1.0),),
                lights=(),
            ),
            coverage(),
        ),
        "soft_shadow": (lit_point(white, (half_plane(0.5, "blind", 0.0),)), irradiance(2 * AWAY) / math.pi),
        "lens": (
            Scene(camera=lens, objects=(half_plane(0.0, "lit", 1.0),), lights=()),
            (math.acos(disk) - disk * math.sqrt(1 - disk**2)) / math.pi,
        ),
        "glossy": (lit_point(Phong((1.0,) * 3, 50.0)), None),
    }


def irradiance(away):
    """At the origin from the part of the light within `away` of the middle on the free side, by the midpoint rule."""
    x = (np.arange(4000) + 0.5) / 4000 - 0.5
    total = 0.0
    for y in x:
        seen = x * math.cos(ANGLE) + y * math.sin(ANGLE) < away
        total += (seen / (x**2 + y**2 + 1) ** 2).sum()
    return total / 4000**2


def coverage():
    """(SIDE, SIDE) share of each pixel beyond the edge; NaN where it is 0 or 1."""
    fine = 2000
    x = (np.arange(SIDE * fine) + 0.5) / (SIDE * fine) - 0.5
    edge = (AWAY - x * math.cos(ANGLE)) / math.sin(ANGLE)  # lit above this y
    rows = []
    for row in range(SIDE):
        top = 0.5 - row / SIDE
        rows.append(np.clip((top - edge) * SIDE, 0, 1).reshape(SIDE, fine).mean(axis=1))
    share = np.array(rows)
    return np.where((share > 0) & (share < 1), share, np.nan)


def picture(scene, samples, sampler, seed):
    """(SIDE, SIDE) float64 radiance."""
    settings = Settings(width=SIDE, height=SIDE, samples=samples, sampler=sampler, seed=seed, max_depth=0, pixel_filter="box")
    return render_image(scene, settings).passes["Combined"][..., 0].astype(np.float64)


def measure(scene, truth):
    """{sampler: RMSE (len(SAMPLES),)}, relative to the mean of what is true."""
    if truth is None:
        truth = picture(scene, 16384, "sobol", 1000).mean()
    scale = np.nanmean(truth)
    result = {}
    for sampler in SAMPLERS:
        errors = [[picture(scene, n, sampler, seed) - truth for seed in range(SEEDS)] for n in SAMPLES]
        result[sampler] = np.array([math.sqrt(np.nanmean(np.square(e))) / scale for e in errors])
    return result


def slope(errors):
    """Of log error over log samples, from 4 samples on, where rounding does not yet count; NaN where less than three are left."""
    counts = [i for i in range(1, len(SAMPLES)) if errors[i] > 1e-6]
    if len(counts) < 3:
        return math.nan
    return np.polyfit(np.log(np.array(SAMPLES)[counts]), np.log(errors[counts]), 1)[0]


def plot(name, errors):
    """docs/images/convergence_NAME.png"""
    figure, axes = plt.subplots(figsize=(5.2, 3.6), layout="constrained")
    for (sampler, values), marker in zip(errors.items(), "osd^vx"):
        axes.loglog(SAMPLES, values, marker=marker, ms=4, lw=1.2, label=SAMPLERS[sampler].label)
    axes.set(title=NAMES[name], xlabel="samples", ylabel="RMSE / mean", xticks=SAMPLES, xticklabels=SAMPLES)
    axes.title.set_fontsize(9)
    axes.minorticks_off()
    axes.grid(alpha=0.3)
    axes.legend(fontsize=7)
    figure.savefig(DOCS / "images" / f"convergence_{name}.png", dpi=80)
    plt.close(figure)


def adaptive(scene, truth):
    """Rows (levels, samples per pixel, relative RMSE, that of 4^levels even samples) of adaptive supersampling with one sample per cell."""
    rows = []
    for levels in range(1, 6):
        even, divided, taken = [], [], []
        for seed in range(4):
            settings = Settings(width=SIDE, height=SIDE, samples=1, seed=seed, max_depth=0, pixel_filter="box")
            settings = replace(settings, adaptive_threshold=0.1, adaptive_levels=levels, passes=("Combined", "Sample Count"))
            passes = render_image(scene, settings).passes
            divided.append(passes["Combined"][..., 0] - truth)
            taken.append(passes["Sample Count"].mean())
            even.append(picture(scene, 4**levels, "stratified", seed) - truth)
        errors = [math.sqrt(np.nanmean(np.square(e))) / np.nanmean(truth) for e in (divided, even)]
        rows.append((levels, np.mean(taken), *errors))
    return rows


def page(results, adaptive_rows):
    """The text of docs/convergence.md."""
    lines = [
        "# How the error falls",
        "",
        "`python -m benchmarks.convergence` renders small scenes with known answers, with each sampler and from 1 to 1,024 samples, and",
        "writes this page. The error is the RMSE over pixels, over the mean; the slope is that of its logarithm over the logarithm of the",
        "samples, from 4 samples on: -1/2 means four times the samples for half the error, -1 twice.",
        "",
        "The uniform grid is the same in every pixel, so its error is no noise but a wrong value, and depends on where the edge lies by",
        "chance. Blue noise looks better than its numbers at few samples: its error is spread between neighbouring pixels, where it is",
        "averaged by the eye or by any filter wider than the box that is used here. Correlated multi-jittering has the same permutation in",
        "all columns, so its error is as large as the difference of light between opposite borders of the square of random numbers: here",
        "light fades out to all of them and it is best; for exp(x + y) its slope is -3/4 only, and it is worse than stratified from about",
        "200 samples on (tests/contracts/test_sampler_patterns.py).",
        "",
        "## Slopes",
        "",
        "| case | " + " | ".join(s.label for s in SAMPLERS.values()) + " | theory |",
        "|---" * (len(SAMPLERS) + 2) + "|",
    ]
    lines += [f"| {n} | " + " | ".join(f"{slope(e):.2f}" for e in r.values()) + f" | {THEORY[n]} |" for n, r in results.items()]
    at = SAMPLES.index(64)
    lines += ["", "## Errors at 64 samples, in percent", "", "| case | " + " | ".join(s.label for s in SAMPLERS.values()) + " |"]
    lines += ["|---" * (len(SAMPLERS) + 1) + "|"]
    lines += [f"| {n} | " + " | ".join(f"{100 * e[at]:.2g}" for e in r.values()) + " |" for n, r in results.items()]
    lines += ["", *against_random(results, at)]
    lines += [
        "",
        "## Adaptive supersampling",
        "",
        "One sample per pixel, and one in each part where colours differ by 0.1, at the same edge; all pixels are counted in the samples,",
        "those that the edge goes through in the error. It is that of as many even samples as there are smallest parts, for a part of the",
        "price: the samples double with each level, where even ones are four times as many.",
        "",
        "| levels | samples per pixel | error in percent | even samples per pixel | their error in percent |",
        "|---|---|---|---|---|",
    ]
    lines += [f"| {n} | {taken:.1f} | {100 * error:.2g} | {4**n} | {100 * even:.2g} |" for n, taken, error, even in adaptive_rows]
    for name in results:
        lines += ["", f"## {NAMES[name]}", "", f"![Error against samples for each sampler](images/convergence_{name}.png)"]
    return "\n".join(lines) + "\n"


def against_random(results, at):
    """Lines that say what the default sampler is worth."""
    ratio = {name: errors["random"][at] / errors[DEFAULT][at] for name, errors in results.items()}
    return [
        f"{SAMPLERS[DEFAULT].label}, the default, has so many times less error at 64 samples than independent random numbers:",
        ", ".join(f"{name} {value:.1f}" for name, value in ratio.items()) + ". The bar is 2 for soft_shadow and lens.",
    ]


def main():
    results = {}
    for name, (scene, truth) in cases().items():
        results[name] = measure(scene, truth)
        plot(name, results[name])
        print(name, {s: round(float(slope(e)), 2) for s, e in results[name].items()}, flush=True)
        for sampler, errors in results[name].items():
            print(f"  {sampler:12}", " ".join(f"{e:.1e}" for e in errors), flush=True)
    (DOCS / "convergence.md").write_text(page(results, adaptive(*cases()["edge"])), encoding="utf-8")


if __name__ == "__main__":
    main()
