"""Results as numbers relative to Balanced, and as a page."""

import json
import math

import numpy as np

from .. import small_scenes
from ..growth.report import BUSY

BASE = "BALANCED"
PATHS = ("PREVIEW", "BALANCED", "FINAL")
"""The presets that differ in samples and depth alone."""
QUANTITIES = ("time", "error", "noise")


def relative(scene, presets):
    """{preset: {"time", "error", "noise": over Balanced's, "bias": over the picture's mean}} of one scene; what is unknown is left out."""
    base = scene["presets"][BASE]
    result = {}
    biases = {rung["depth"]: rung["bias"] for rung in scene["ladder"]}
    for key, found in scene["presets"].items():
        over = {"time": "microseconds", "error": "rmse", "noise": "noise"}
        result[key] = {name: found[own] / base[own] for name, own in over.items() if found.get(own) is not None and base[own]}
        if "bias" in found:
            # The ladder knows it best, of the most samples.
            result[key]["bias"] = biases[presets[key]["max_depth"]] if key in PATHS else found["bias"]
    return result


def summary(scenes, presets):
    """{preset: {quantity: [median, least, most over the scenes]}} of `relative`; four digits."""
    every = [relative(scene, presets) for scene in scenes.values()]
    result = {}
    for key in every[0]:
        values = {name: [found[key][name] for found in every if name in found[key]] for name in (*QUANTITIES, "bias")}
        result[key] = {name: [float(f"{f(own):.4g}") for f in (np.median, min, max)] for name, own in values.items() if own}
    return result


def at_equal_time(scene, samples, depth):
    """{other depth: (error, noise, bias)} in the time that `samples` of the `depth` take.

    Noise goes along the ladder, straight in logarithms; time grows with the samples; the bias of few bounces is that of the most samples,
    by which it is known best.
    """
    result = {}
    for name, pace in scene["paces"].items():
        curve = [rung for rung in scene["ladder"] if rung["depth"] == int(name)]
        noise, bias = _along(curve, samples * scene["paces"][str(depth)] / pace), curve[-1]["bias"]
        result[int(name)] = math.hypot(noise, bias), noise, bias
    return result


def _along(curve, samples):
    """Noise after so many samples; beyond the ends as between the last two rungs."""
    x, y = (np.log([max(rung[key], 1e-9) for rung in curve]) for key in ("samples", "noise"))
    i = int(np.clip(np.searchsorted(x, math.log(samples)), 1, len(x) - 1))
    slope = (y[i] - y[i - 1]) / (x[i] - x[i - 1])
    return float(np.exp(y[i] + slope * (math.log(samples) - x[i])))


def as_text(results):
    """JSON with a line for each rung and each preset."""
    text = json.dumps(results, indent=1)
    decoder, lines = json.JSONDecoder(), []
    # Whatever holds numbers and words alone goes into one line.
    i = 0
    while i < len(text):
        if text[i] in "{[":
            value, end = decoder.raw_decode(text, i)
            inner = value.values() if isinstance(value, dict) else value
            if not any(isinstance(part, (dict, list)) for part in inner):
                lines.append(json.dumps(value))
                i = end
                continue
        lines.append(text[i])
        i += 1
    return "".join(lines) + "\n"


def summary_table(results, labels):
    """Lines of the table of medians and ranges."""
    rows = []
    for key, found in results["summary"].items():
        cells = (_range(found[name], _times) if name in found else "-" for name in QUANTITIES)
        rows.append((labels[key], _what(results["presets"][key]), *cells, _range(found["bias"], _percent) if "bias" in found else "-"))
    return _table(("preset", "settings", "time", "error", "noise", "bias of few bounces"), rows)


def page(results, labels):
    """The text of docs/presets.md."""
    scenes, presets = results["scenes"], results["presets"]
    parts = (
        ("", _introduction(results)),
        ("## Relative to Balanced", [*_SUMMARY, "", *summary_table(results, labels), "", *_LECTURE]),
        ("## Whether neither bounces nor samples are wasted", [*_CRITERION, "", *_depth_table(scenes, presets, labels)]),
        ("", _reasons(scenes, presets, labels)),
        ("## Bias beside noise", [*_BIAS, "", *_bias_table(scenes, presets, labels)]),
        ("## Every scene", _scene_table(scenes, presets, labels)),
    )
    lines = ["# What the presets cost"]
    for head, text in parts:
        lines += ["", head, "", *text] if head else ["", *text]
    return "\n".join(lines) + "\n"


def _introduction(results):
    effort, scenes = results["effort"], results["scenes"]
    facts = sorted({f"{scene['facts']['processor']}, Python {scene['facts']['python']}" for scene in scenes.values()})
    dates = sorted({scene["facts"]["date"] for scene in scenes.values()})
    size, timed = ("{} x {}".format(*effort[key]) for key in ("size", "timed_size"))
    longest, seeds = f"{effort['longest']:,}", effort["seeds"]
    return [
        "`make bench-presets` renders sample scenes with the presets of the Sampling panel and with a ladder of samples and depths, and",
        "writes this page, and presets.json, which the numbers in the presets' tooltips are held against.",
        f"Measured so far are {len(scenes)} of {len(small_scenes.NAMES)} scenes: {', '.join(scenes)}.",
        "",
        f"*Error* is the root of the mean squared error over the mean, at {size} pixels, against path tracing of {longest} samples",
        f"and up to {effort['deepest']} bounces, whose own standard error is taken off. *Noise* and *bias* are its parts: noise is what",
        f"{seeds} renders with other seeds differ by, bias what is left, 0 where noise hides it. Pixels in which the camera sees",
        "a lamp or the world do not count: they are so bright that what all others receive would hardly weigh beside their edges.",
        f"*Time* is processor time of one thread, after compiling, the presets in turns; of few samples at {timed} pixels, as batches",
        "would be smaller than in other pictures else. Error in a pixel does not depend on the number of pixels, time is in proportion",
        "to it.",
        "",
        f"{'; '.join(facts)}; {', '.join(dates)}.",
        *_warning(scenes),
    ]


def _warning(scenes):
    """What to think of the times, if the machine had much else to do."""
    loads = [scene["facts"]["load"] / scene["facts"]["cores"] for scene in scenes.values()]
    if max(loads) <= BUSY:
        return []
    return [
        "",
        f"**Measured on a busy machine** (up to {max(loads):.0f} processes for each core): processor time is less disturbed by that",
        "than wall time is, but not undisturbed.",
    ]


_SUMMARY = ["Medians over the scenes, and the range from the least to the most. Bias is relative to the mean of the picture."]
_LECTURE = """\
Lecture: Whitted has another model of light, so how it differs from path tracing is no error of its own: only its time and its
noise are told, noise relative to its own mean. Its pixels are divided at edges, of which larger pictures have fewer in proportion:
it is measured at more pixels, and takes less time than told in pictures that are larger yet. Lecture: Distributed sees the same
light as path tracing, but for three bounces alone, which is its bias.""".splitlines()
_CRITERION = """\
Few bounces leave out light, the same in every picture; many take time that samples could have had. So every depth of the ladder
gets as many samples as the preset's time allows, and what counts is the error, of noise and bias together, over that of the best
depth: the mean over the scenes (geometric), and the worst of them. The preset's own depth is in bold.

Further bounces take little time, as Russian roulette ends most paths before. What they cost is noise: light that comes by many
bounces adds noise of its own. So few samples are best spent on few bounces, as the noise of the rest would be more than the light that
is left out; the more samples, the more bounces are worth their noise.""".splitlines()
_BIAS = """\
Noise of each preset and, after the +, the bias of its bounces, in percent of the mean; and the fewest bounces of the ladder
whose bias is below the noise.""".splitlines()


def losses(scenes, settings):
    """{depth: [error over that of the best depth, in each scene]} in the time of a preset's `settings`."""
    result = {}
    for scene in scenes.values():
        found = at_equal_time(scene, settings["samples"], settings["max_depth"])
        best = min(error for error, _, _ in found.values())
        for depth, (error, _, _) in found.items():
            result.setdefault(depth, []).append(error / best if best else 1.0)
    return result


def _depth_table(scenes, presets, labels):
    rows = []
    for key in PATHS:
        found = losses(scenes, presets[key])
        cells = []
        for depth, values in found.items():
            cell = f"{np.exp(np.mean(np.log(values))):.2f}, {max(values):.2f}"
            cells.append(f"**{cell}**" if depth == presets[key]["max_depth"] else cell)
        rows.append((labels[key], *cells))
    return _table(("mean, worst at depth", *map(str, found)), rows)


def _reasons(scenes, presets, labels):
    lines = []
    for key in PATHS:
        depth, found = presets[key]["max_depth"], losses(scenes, presets[key])
        means = {d: float(np.exp(np.mean(np.log(values)))) for d, values in found.items()}
        best = min(means, key=means.get)
        worst, where = max(zip(found[depth], scenes))
        more = 100 * (means[depth] / means[best] - 1)
        lines += [
            f"- **{labels[key]}**, {depth} bounces: {more:.0f} % more error on average than with the {best} that are best for all",
            f"  scenes together; at worst, in {where}, {worst:.2f} times the error of the depth that is best there.",
        ]
    return lines


def _bias_table(scenes, presets, labels):
    rows = []
    for name, scene in scenes.items():
        row = [name]
        biases = {rung["depth"]: rung["bias"] for rung in scene["ladder"]}
        for key in PATHS:
            found = scene["presets"][key]
            enough = [depth for depth, bias in biases.items() if bias <= found["noise"]]
            row.append(f"{100 * found['noise']:.2g} + {100 * biases[presets[key]['max_depth']]:.2g}, {enough[0] if enough else 'none'}")
        rows.append(row)
    return _table(("scene", *(labels[key] for key in PATHS)), rows)


def _scene_table(scenes, presets, labels):
    rows = []
    for name, scene in scenes.items():
        found = relative(scene, presets)
        cells = ((found[key].get("time"), found[key].get("error", found[key].get("noise"))) for key in labels if key != BASE)
        base = scene["presets"][BASE]
        own = f"{base['microseconds']:,.0f} us, {100 * base['rmse']:.2g} %"
        rows.append((name, own, *(f"{_times(a)}, {_times(b)}" for a, b in cells)))
    heads = (f"{label}: time, {'noise' if key == 'WHITTED' else 'error'}" for key, label in labels.items() if key != BASE)
    return _table(("scene", f"{labels[BASE]}: a pixel's time, error", *heads), rows)


def _what(settings):
    depth = f"{settings['max_depth']} bounces"
    return f"{settings['integrator']}, {settings['samples']} samples, {depth}"


def _range(values, text):
    middle, least, most = map(text, values)
    return f"{middle} ({least} to {most})"


def _times(value):
    return "-" if value is None else f"{value:.2g}" if value < 100 else f"{value:.0f}"


def _percent(value):
    return f"{100 * value:.2g} %"


def _table(head, rows):
    return ["| " + " | ".join(head) + " |", "|---" * len(head) + "|", *("| " + " | ".join(map(str, row)) + " |" for row in rows)]
