"""Results as a page of tables, and the bars that Glanz is held to: they are printed, nothing fails by them."""

import math
from statistics import median

from .measure import Point, busy_share, equal_error

TITLES = {
    "cornell_box": "Cornell box",
    "gloss": "Mirrors and lacquer",
    "glass": "Glass",
    "many_lights": "1,024 point lamps",
    "million": "A million triangles",
    "textured_interior": "Textured interior",
    "environment": "Environment",
    "depth_of_field": "Depth of field",
}
NAMES = {"glanz": "Glanz", "cycles": "Cycles", "mitsuba": "Mitsuba", "mitsuba_independent": "Mitsuba, independent"}
BUSY = 0.85
"""Below this share of its threads a wall time says more about the machine than about the renderer."""


def seconds(times, kind):
    """One time of a render: "wall", of all; "alone", of tracing; "cpu", "cpu_alone" of all processors. Mitsuba's are of tracing anyway."""
    return times.get(kind, times["cpu" if kind.startswith("cpu") else "wall"])


def at_equal_samples(scene, engine, kind):
    """Glanz' time over that of `engine` with the most samples, median of the rounds."""
    most = max(scene["glanz"]["times"], key=int)
    pairs = zip(scene["glanz"]["times"][most], scene[engine]["times"][most])
    return median(seconds(mine, kind) / seconds(other, kind) for mine, other in pairs)


def at_equal_error(scene, engine, kind):
    """Glanz' time with the most samples over the time that `engine` takes for the same error, median of the rounds."""
    few, most = sorted(scene["glanz"]["times"], key=int)
    target, ratios = mean_error2(scene, "glanz", most), []
    for number, mine in enumerate(scene["glanz"]["times"][most]):
        points = [Point(int(n), seconds(scene[engine]["times"][n][number], kind), mean_error2(scene, engine, n)) for n in (few, most)]
        _, needed = equal_error(points, target)
        ratios.append(seconds(mine, kind) / needed if needed > 0 else math.nan)
    return median(ratios)


def mean_error2(scene, engine, samples):
    """The mean squared error of all seeds."""
    errors = scene[engine]["error2"][samples]
    return sum(errors) / len(errors)


def relative_error(scene, engine, samples):
    """RMSE over the mean, in percent; NaN where the reference's own noise hides it."""
    error2 = mean_error2(scene, engine, samples)
    return 100 * math.sqrt(error2) / scene[engine]["mean"] if error2 > 0 else math.nan


def busy(results):
    """The share of its threads that Glanz and Cycles got, over all renders."""
    shares = [
        busy_share(times["cpu"], times["wall"], results["facts"]["threads"])
        for scene in results["scenes"].values()
        for engine in ("glanz", "cycles")
        for times in scene[engine]["times"][max(scene[engine]["times"], key=int)]
    ]
    return median(shares)


def bars(results):
    """Lines (what, value, bar, whether it is held) of all that has a bar."""
    scenes, facts = results["scenes"], results["facts"]
    lines = _counted("Cycles", _ratios(scenes, "cycles", "wall"), len(scenes), (0.4, 6), 0.8)
    if facts["mitsuba"]:
        lines += _counted(f"Mitsuba ({facts['variant']})", _ratios(scenes, "mitsuba", "alone"), len(scenes), (1.0, 5), 2.0)
    if "cornell_box" in scenes:
        box = scenes["cornell_box"]
        lines.append(_upper("Cornell box at equal samples, Glanz / Cycles", at_equal_samples(box, "cycles", "wall"), 0.55))
        lines.append(_lower("Cornell box, threads' time inside Embree [%]", box["glanz"]["core"]["embree_share"], 65))
    least = min(scenes, key=lambda name: scenes[name]["glanz"]["core"]["embree_share"])
    lines.append(_lower(f"least of all scenes, {TITLES[least]} [%]", scenes[least]["glanz"]["core"]["embree_share"], 50))
    if "first_pixel" in results:
        pixel = {engine: median(found) for engine, found in results["first_pixel"].items()}
        lines.append(_upper("Cornell box 1920x1080, first pixel after Cycles' own [s]", pixel["glanz"] - pixel["cycles"], 0.3))
    return lines


def _ratios(scenes, engine, kind):
    """At equal error, of the scenes that both render alike."""
    return [at_equal_error(scene, engine, kind) for scene in scenes.values() if scene["agreement"][engine]["agrees"]]


def _counted(peer, ratios, count, most, every):
    bar, needed = most
    held = sum(ratio <= bar for ratio in ratios)
    worst = max(ratios, default=math.nan, key=lambda r: math.inf if math.isnan(r) else r)
    return [
        (f"scenes at equal error within {bar:g} of the time of {peer}", f"{held} of {count}", f"at least {needed} of 8", held >= needed),
        (f"the slowest of them against {peer}", f"{worst:.2f}", f"at most {every:g}", worst <= every and len(ratios) == count),
    ]


def _upper(what, value, bar):
    return what, f"{value:.2f}", f"at most {bar:g}", value <= bar


def _lower(what, value, bar):
    return what, f"{value:.0f}", f"at least {bar:g}", value >= bar


def page(results):
    """The text of docs/peers.md."""
    facts, scenes = results["facts"], results["scenes"]
    peers = [engine for engine in NAMES if engine != "glanz" and all(engine in s for s in scenes.values())]
    effort = facts["effort"]
    few, most = effort["samples"]
    sections = [
        "# Glanz beside Cycles and Mitsuba",
        "",
        *_introduction(facts, effort),
        "",
        "## Bars",
        "",
        *_table(("", "measured", "bar", ""), [(*line[:3], "held" if line[3] else "**missed**") for line in bars(results)]),
        "",
        "## At equal error",
        "",
        f"What an engine takes until its RMSE is that of Glanz with {most} samples, by its own errors and times with {few} and {most}.",
        "Errors are RMSE over mean, in percent; the ratios are Glanz' time over the other's: below 1 Glanz is faster. F12 is all that a",
        "user waits for; alone is tracing, without export, loading and building. In brackets: ratios of processor time.",
        "",
        *_table(*_equal_error(scenes, peers, str(most))),
        "",
        f"## At equal samples: {most} per pixel",
        "",
        "Seconds of tracing alone; in brackets those of the whole: F12 in Blender, for Mitsuba loading and compiling its kernels.",
        "",
        *_table(*_equal_samples(scenes, peers, str(most))),
        "",
        "## Memory, first pixels, Embree",
        "",
        "Peaks are those of the process after its first render, over what importing Blender or Mitsuba took of them. First pixels are",
        "those of F12: Glanz' first tile, Cycles' first sample of the whole frame; Mitsuba shows nothing before it is through.",
        "Embree's is the share of the threads' time inside it, in percent.",
        "",
        *_table(*_rest(scenes, peers, str(most))),
        "",
        "## Do they render the same picture?",
        "",
        "Means of long references over Glanz', with their standard deviation; and by how much more than noise pixels differ, over it.",
        "A scene whose pictures differ does not count above.",
        "",
        *_table(*_agreement(scenes)),
    ]
    return "\n".join(sections) + "\n"


def _introduction(facts, effort):
    lines = [
        "`make bench-peers` renders eight scenes with each, in processes of their own, in turns, and writes this page. The scenes are made",
        "by benchmarks/peers/scenes.py of what all of them have in the same form. Cycles cuts nothing off: no clamping, no adaptive",
        "sampling, no denoising, no light threshold, no filter of caustics. All have equal samples, bounces, threads and the box as pixel",
        "filter; Russian roulette and the choice of lights are their own. Errors are taken against a long reference of the same engine,",
        "whose own noise is taken off; pixels in which a light or the world is seen directly do not count.",
        "",
        f"{facts['processor']}, {facts['threads']} threads, Python {facts['python']}, Blender {facts['blender']}, {facts['date']}. Pictures"
        f" of {effort['side']} px for times, {effort['error_side']} px for errors, medians of {effort['rounds']}.",
    ]
    if facts["mitsuba"]:
        lines.append(f"Mitsuba {facts['mitsuba']}, {facts['variant']}, with its sampler multijitter unless another is named.")
    else:
        lines.append("Mitsuba was not installed.")
    if facts.get("variant") == "scalar_rgb":
        lines.append("This is its slow variant: see what the command prints.")
    if facts.get("busy", 1.0) < BUSY:
        lines.append(
            f"**The machine was busy with other things: the renderers got {100 * facts['busy']:.0f} % of their threads. Ratios of processor"
            " time, in brackets, are nearer to the truth than those of wall time.**"
        )
    return lines


def _table(head, rows):
    return ["| " + " | ".join(head) + " |", "|---" * len(head) + "|", *("| " + " | ".join(map(str, row)) + " |" for row in rows)]


def _equal_error(scenes, peers, most):
    head = ["scene", *(f"error: {NAMES[engine]}" for engine in ("glanz", *peers))]
    head += [f"Glanz / {NAMES[engine]}: {kind}" for engine in peers for kind in _kinds(engine)]
    rows = []
    for name, scene in scenes.items():
        row = [TITLES[name], *(f"{relative_error(scene, engine, most):.2f}" for engine in ("glanz", *peers))]
        row += [_with_cpu(at_equal_error, scene, engine, kind) for engine in peers for kind in _kinds(engine)]
        rows.append(row)
    return head, rows


def _kinds(engine):
    return {"cycles": ("F12", "alone")}.get(engine, ("alone",))


def _with_cpu(ratio, scene, engine, kind):
    """The ratio of wall times, and in brackets that of processor time."""
    wall, cpu = ("wall", "cpu") if kind == "F12" else ("alone", "cpu_alone")
    return f"{ratio(scene, engine, wall):.2f} ({ratio(scene, engine, cpu):.2f})"


def _equal_samples(scenes, peers, most):
    head = ["scene", *(NAMES[engine] for engine in ("glanz", *peers)), *(f"Glanz / {NAMES[engine]}" for engine in peers)]
    rows = []
    for name, scene in scenes.items():
        row = [TITLES[name]]
        for engine in ("glanz", *peers):
            times = scene[engine]["times"][most]
            alone, whole = (median(seconds(t, kind) for t in times) for kind in ("alone", "wall"))
            whole = scene[engine]["load"] + scene[engine]["cold"]["wall"] if engine in ("mitsuba", "mitsuba_independent") else whole
            row.append(f"{alone:.2f} ({whole:.2f})")
        rows.append(row + [_with_cpu(at_equal_samples, scene, engine, _kinds(engine)[0]) for engine in peers])
    return head, rows


def _rest(scenes, peers, most):
    engines = [engine for engine in ("glanz", *peers) if engine != "mitsuba_independent"]
    head = ["scene", *(f"{NAMES[e]} [MB]" for e in engines)]
    head += [*(f"{NAMES[e]}: first pixel [s]" for e in ("glanz", "cycles")), "Embree", "rays [M]"]
    rows = []
    for name, scene in scenes.items():
        memory = [f"{scene[e]['memory']['peak'] - scene[e]['memory']['imported']:.0f}" for e in engines]
        pixel = [f"{median(t['first_pixel'] for t in scene[e]['times'][most]):.2f}" for e in ("glanz", "cycles")]
        core = scene["glanz"]["core"]
        rows.append((TITLES[name], *memory, *pixel, f"{core['embree_share']:.0f}", f"{core['rays']:.0f}"))
    return head, rows


def _agreement(scenes):
    rows = []
    for name, scene in scenes.items():
        for engine, found in scene["agreement"].items():
            verdict = "alike" if found["agrees"] else "**differ**"
            ratio, excess = f"{found['ratio']:.4f} ± {found['sigma']:.4f}", f"{100 * found['excess']:.2f} %"
            rows.append((TITLES[name], NAMES[engine], ratio, excess, verdict))
    return ("scene", "", "mean / Glanz'", "more than noise", ""), rows
