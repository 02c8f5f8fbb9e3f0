"""Glanz, Cycles and Mitsuba 3 on the same eight scenes, each in processes of its own, two threads, one after the other in turns.

    python -m benchmarks.peers [--quick] [scene ...]

Prints tables and the bars that Glanz is held to. A whole run writes docs/peers.md and docs/peers.json; one that is quick, or of
some scenes, or without Mitsuba, writes both to out/peers. Without Mitsuba only Cycles is measured.
"""

import importlib.metadata
import importlib.util
import json
import sys
import time
from dataclasses import asdict, dataclass

import numpy as np

from ..__main__ import describe_machine
from ..words import asked
from . import llvm, report
from .measure import Reference, agreement
from .work import ROOT, Worker

SCENES = ("cornell_box", "gloss", "glass", "many_lights", "million", "textured_interior", "environment", "depth_of_field")
THREADS = 2
OUT = ROOT / "out" / "peers"
MITSUBA = {"mitsuba": "multijitter", "mitsuba_independent": "independent"}
"""The names of Mitsuba's results, and its samplers."""


@dataclass(frozen=True)
class Effort:
    """How much is measured.

    side        longer one of the pictures for times [px]
    error_side  of those for errors, which do not depend on it
    samples     (few, most) for both
    seeds       pictures for an error
    reference   samples of each half of a reference
    rounds      in which all engines are timed
    """

    side: int = 256
    error_side: int = 128
    samples: tuple = (16, 64)
    seeds: int = 4
    reference: int = 512
    rounds: int = 5


QUICK = Effort(side=192, error_side=64, samples=(4, 16), seeds=2, reference=128, rounds=1)


def main(arguments=None):
    without = "small pictures, one round: to see that it works, and about where things are"
    names, is_quick = asked("benchmarks.peers", __doc__, "scene", SCENES, without, arguments)
    OUT.mkdir(parents=True, exist_ok=True)
    effort, begun = QUICK if is_quick else Effort(), time.monotonic()
    facts = describe_machine() | {"threads": THREADS, "effort": asdict(effort), "mitsuba": None, "blender": _version("bpy")} | _mitsuba()
    results = {"facts": facts, "scenes": {}}
    for name in names:
        _say(f"{time.monotonic() - begun:5.0f} s  {name}")
        results["scenes"][name] = measure(name, effort, facts)
        # What is measured is not lost if a later scene fails.
        (OUT / "peers.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    if "cornell_box" in results["scenes"]:
        _say(f"{time.monotonic() - begun:5.0f} s  first pixel")
        results["first_pixel"] = first_pixel(effort)
    facts["busy"] = report.busy(results)
    facts["seconds"] = round(time.monotonic() - begun)
    folder = OUT if is_quick or set(names) < set(SCENES) or not facts["mitsuba"] else ROOT / "docs"
    text = report.page(results)
    (folder / "peers.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    (folder / "peers.md").write_text(text, encoding="utf-8")
    print(text)
    print(f"wrote {(folder / 'peers.md').relative_to(ROOT)} and peers.json beside it in {facts['seconds']} s")


def _say(line):
    print(line, file=sys.stderr, flush=True)


def _mitsuba():
    """Which Mitsuba there is, as facts; says what is missing."""
    if importlib.util.find_spec("mitsuba") is None:
        _say("Mitsuba is not installed, so it is left out: pip install mitsuba")
        return {}
    library = llvm.find()
    if library is None:
        _say(llvm.CURE)
    return {
        "mitsuba": _version("mitsuba"),
        "variant": "llvm_ad_rgb" if library else "scalar_rgb",
        "llvm": str(library or ""),
    }


def _version(package):
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return "of a version unknown"


def measure(name, effort, facts):
    """All results of one scene: {engine: {...}} and {"agreement": {...}, "lit"}."""
    with (
        Worker("blender_worker", "GLANZ", name, str(OUT), log=f"{name}_glanz") as glanz,
        Worker("blender_worker", "CYCLES", name, str(OUT), log=f"{name}_cycles") as cycles,
    ):
        workers, results = {"glanz": glanz, "cycles": cycles}, {}
        # The first render of a process is its largest; it loads what later ones find loaded.
        for engine, worker in workers.items():
            results[engine] = {"cold": worker.f12(samples=effort.samples[-1], side=effort.side), "memory": worker.memory()}
        path = str(OUT / f"{name}.glanz")
        results["export"] = glanz.export(path=path, side=effort.side)
        if not facts["mitsuba"]:
            return results | _compare(name, workers, {}, results, effort)
        arguments = json.dumps([facts["variant"], path, [effort.side, effort.error_side], THREADS])
        with Worker("mitsuba_worker", arguments, log=f"{name}_mitsuba", **{llvm.VARIABLE: facts["llvm"]}) as mitsuba:
            load = mitsuba.load()
            for engine, sampler in MITSUBA.items():
                cold = mitsuba.render(sampler=sampler, samples=effort.samples[-1], side=effort.side)
                results[engine] = {"cold": cold, "memory": mitsuba.memory(), **load}
                # There is a kernel for each number of samples, too.
                mitsuba.render(sampler=sampler, samples=effort.samples[0], side=effort.side)
            return results | _compare(name, workers, dict.fromkeys(MITSUBA, mitsuba), results, effort)


def _compare(name, blenders, mitsubas, results, effort):
    """Errors against references, and times in turns."""
    counts = ~_array(blenders["glanz"].lit_pixels, "lit", side=effort.error_side)
    asks = {engine: worker.picture for engine, worker in blenders.items()}
    asks |= {engine: _with_sampler(worker.picture, MITSUBA[engine]) for engine, worker in mitsubas.items()}
    references = {}
    for engine in (engine for engine in asks if engine != "mitsuba_independent"):
        size = {"samples": effort.reference, "side": effort.error_side}
        references[engine] = Reference(*(_array(asks[engine], f"{name}_{engine}", seed=seed, **size) for seed in (101, 102)), counts)
    references |= {"mitsuba_independent": references["mitsuba"]} if mitsubas else {}
    for engine, ask in asks.items():
        results[engine]["mean"] = references[engine].mean
        results[engine]["error2"] = {
            str(n): [
                references[engine].squared_error(_array(ask, f"{name}_{engine}", samples=n, side=effort.error_side, seed=seed))
                for seed in range(1, 1 + effort.seeds)
            ]
            for n in effort.samples
        }
    timed = {engine: worker.f12 for engine, worker in blenders.items()}
    timed |= {engine: _with_sampler(worker.render, MITSUBA[engine]) for engine, worker in mitsubas.items()}
    for results_of in (results[engine] for engine in timed):
        results_of["times"] = {str(n): [] for n in effort.samples}
    for seed in range(effort.rounds):
        for n in effort.samples:
            for engine, ask in timed.items():
                results[engine]["times"][str(n)].append(ask(samples=n, side=effort.side, seed=seed))
    results["glanz"]["core"] = blenders["glanz"].core(samples=effort.samples[-1], side=effort.side)
    others = [engine for engine in ("cycles", "mitsuba") if engine in references]
    return {
        "agreement": {engine: agreement(references["glanz"], references[engine]) for engine in others},
        "lit": float(1 - counts.mean()),
    }


def _with_sampler(ask, sampler):
    return lambda **options: ask(sampler=sampler, **options)


def _array(ask, name, **options):
    """The array that a worker writes when asked."""
    path = OUT / f"{name}.npy"
    ask(path=str(path), **options)
    array = np.load(path)
    path.unlink()
    return array if array.dtype == bool else array.astype(np.float64)


def first_pixel(effort):
    """Seconds from a warm F12 on cornell_box, 1920 x 1080, 64 samples, to its first pixels: {engine: [...]}, in turns."""
    seconds = {"glanz": [], "cycles": []}
    for _ in range(effort.rounds):
        for engine, found in seconds.items():
            with Worker("blender_worker", engine.upper(), "cornell_box", str(OUT), log=f"pixel_{engine}") as worker:
                found.append(worker.first_pixel()["first_pixel"])
    return seconds


if __name__ == "__main__":
    main()
