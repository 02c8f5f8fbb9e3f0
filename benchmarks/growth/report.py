"""Results as a page of tables and a plot."""

import math

from .ladders import BASE, LADDERS
from .measure import LARGE, amdahl, behind_a_lock, serial_share, slope, slope_at_the_end

CORES = (2, 4, 8, 16, 32, 64)
BUSY = 0.5
"""Other work per core above which wall times say more about the machine than about Glanz."""
KINDS = {"prepare": "prepare [s]", "render": "render [s]", "memory": "memory [MB]"}


def page(results):
    """The text of docs/growth.md."""
    facts, ladders = results["facts"], results["ladders"]
    lines = ["# How time and memory grow", "", *_introduction(facts), ""]
    grown = {name: rungs for name, rungs in ladders.items() if name != "threads"}
    if grown:
        lines += ["## Slopes", "", *_slopes_text(), "", *_table(*_slopes(grown)), ""]
        lines += ["![Time and memory of each ladder](images/growth.png)"]
    for name, rungs in grown.items():
        rows = [(f"{r['size']:,}", *(_number(r[kind]) for kind in KINDS)) for r in rungs]
        lines += ["", f"## {name.capitalize()}", "", *_table((LADDERS[name].label, *KINDS.values()), rows)]
    if "threads" in ladders:
        lines += ["", "## Threads", "", *_threads(ladders["threads"], facts)]
    return "\n".join(lines) + "\n"


def is_busy(facts):
    """Whether the machine had much else to do."""
    return facts["load"] / facts["cores"] > BUSY


def _introduction(facts):
    lines = [
        "`make bench-growth` measures the engine without Blender, each rung of each ladder in a process of its own, and writes this page",
        "and growth.json beside it. Where nothing else is said: "
        f"{BASE.width} x {BASE.height} pixels, {BASE.samples} samples, {BASE.max_depth} bounces, {BASE.threads} threads.",
        "*Prepare* is all before the first ray: checks, Embree's tree, tables of lights, mip maps. Both times are processor time of",
        "all threads, the least of up to three rounds. *Memory* is the largest resident set over that after a tiny render.",
        "",
        f"{facts['processor']}, {facts['cores']} cores, Python {facts['python']}, {facts['date']}.",
    ]
    if facts["quick"]:
        lines += ["", "**The quick ladders**: the largest rungs are left out."]
    if is_busy(facts):
        lines += ["", f"**Measured on a busy machine** (load {facts['load']:g} on {facts['cores']} cores): wall times, and with them the"]
        lines += ["speed-up by threads, are not to be trusted; processor time is less disturbed. Measure again where nothing else runs."]
    return lines


def _slopes_text():
    return [
        "Of the logarithm of time or memory over that of the size, by least squares: 1 is linear, 0 is constant. What is paid once",
        f"flattens the lower end, so the second number, of the {LARGE} largest rungs, is nearer to how it goes on.",
    ]


def _slopes(ladders):
    rows = []
    for name, rungs in ladders.items():
        sizes, row = [r["size"] for r in rungs], [f"{name}, to {rungs[-1]['size']:,}"]
        for kind in KINDS:
            values = [r[kind] for r in rungs]
            row.append(f"{_number(slope(sizes, values))}, {_number(slope_at_the_end(sizes, values))}")
        rows.append(row)
    return ("ladder", *(kind.partition(" ")[0] for kind in KINDS.values())), rows


def _threads(rungs, facts):
    walls = {r["size"]: r["wall"] for r in rungs}
    _, settings = LADDERS["threads"].rung(1)
    rows = [(r["size"], f"{r['wall']:.2f}", f"{r['render']:.2f}", f"{walls[1] / r['wall']:.2f}", _held(r.get("gil", {}))) for r in rungs]
    lines = _table(("threads", "wall [s]", "processor [s]", "speed-up", "GIL held [%]"), rows)
    lines += [
        "",
        "The GIL is held by Python between the calls to Embree and to NumPy's loops, which let go of it; py-spy looks from outside whether",
        "some thread holds it; ± is the standard error of its samples as if they were independent.",
        f"Larger batches hold it for less. Here it is that of {settings.width} x {settings.height} pixels with {settings.samples} samples.",
        "",
        f"**A projection, not a measurement**, from up to {max(walls)} threads to {CORES[-1]} cores. By Amdahl's law all wait while one",
        "does what is serial. The lock is modelled by threads that wait for it only when they need it while another has it (the machine",
        "repairman's model): the limit is 1 / the share held. The smaller of both is the one to expect. Neither knows of shared caches, of",
        "the bandwidth of memory, nor of fewer tiles than threads.",
        "",
    ]
    projected = []
    if is_busy(facts):
        lines += ["Amdahl's law is left out here: wall times of a busy machine tell no serial share. The share held is less disturbed.", ""]
    else:
        serial = serial_share(walls)
        projected.append(_projection(f"Amdahl's law, serial share {serial:.3f} by the measured times", amdahl, serial))
    if share := rungs[0].get("gil", {}).get("share"):
        projected.append(_projection(f"the GIL, held for {share:.3f} of the time of one thread", behind_a_lock, share))
    return lines + _table(("speed-up by", *(f"{n} cores" for n in CORES), "limit"), projected)


def _projection(label, law, share):
    limit = f"{1 / share:.1f}" if share > 0 else "none"
    return label, *(f"{law(share, n):.1f}" for n in CORES), limit


def _held(gil):
    return f"{100 * gil['share']:.1f} ± {100 * gil['error']:.1f}" if gil else "not measured"


def _number(value):
    return "-" if math.isnan(value) else "0" if abs(value) < 5e-4 else f"{value:,.0f}" if abs(value) >= 100 else f"{value:.2g}"


def _table(head, rows):
    return ["| " + " | ".join(head) + " |", "|---" * len(head) + "|", *("| " + " | ".join(map(str, row)) + " |" for row in rows)]


def plot(results, path):
    """Time and memory of every ladder but that of threads, over its sizes, at `path`."""
    import matplotlib

    matplotlib.use("agg")
    import matplotlib.pyplot as plt

    ladders = {name: rungs for name, rungs in results["ladders"].items() if name != "threads"}
    figure, rows = plt.subplots(2, len(ladders), figsize=(2.6 * len(ladders), 5), layout="constrained", squeeze=False, sharey="row")
    for (name, rungs), upper, lower in zip(ladders.items(), *rows):
        sizes = [r["size"] for r in rungs]
        for axes, kinds in ((upper, ("prepare", "render")), (lower, ("memory",))):
            for kind, marker in zip(kinds, "os"):
                axes.loglog(sizes, [r[kind] or math.nan for r in rungs], marker=marker, ms=4, lw=1.2, label=KINDS[kind])
            axes.grid(alpha=0.3)
            axes.legend(fontsize=7)
        upper.set_title(name, fontsize=9)
        lower.set_xlabel(LADDERS[name].label, fontsize=8)
    figure.savefig(path, dpi=80)
    plt.close(figure)
