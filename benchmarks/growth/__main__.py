"""How time and memory of the engine grow with pixels, samples, triangles, lights, textures and threads; each rung in its own process.

    python -m benchmarks.growth [--quick] [ladder ...]

Prints the slopes. All ladders write docs/growth.md, its plot and docs/growth.json, and say there if they were the quick ones or the
machine was busy; some of them write to out/growth.
"""

import json
import subprocess
import sys
import time
from pathlib import Path

from ..__main__ import describe_machine
from ..words import asked
from . import gil, report
from .ladders import LADDERS

ROOT = Path(__file__).resolve().parents[2]


def main(arguments=None):
    without = "without the largest rungs, which take most of the time and gigabytes"
    names, is_quick = asked("benchmarks.growth", __doc__, "ladder", LADDERS, without, arguments)
    begun, results = time.monotonic(), {"facts": describe_machine() | {"quick": is_quick}, "ladders": {}}
    for name in names:
        results["ladders"][name] = climb(name, is_quick, begun)
    folder = ROOT / "docs" if set(names) == set(LADDERS) else ROOT / "out" / "growth"
    (folder / "images").mkdir(parents=True, exist_ok=True)
    text = report.page(results)
    (folder / "growth.json").write_text(json.dumps(results, indent=1) + "\n", encoding="utf-8")
    (folder / "growth.md").write_text(text, encoding="utf-8")
    if set(results["ladders"]) - {"threads"}:
        report.plot(results, folder / "images" / "growth.png")
    print(text)
    print(f"wrote {(folder / 'growth.md').relative_to(ROOT)} and growth.json beside it in {time.monotonic() - begun:.0f} s")


def climb(name, is_quick, begun):
    """The results of all rungs of a ladder, from the lowest."""
    ladder, rungs = LADDERS[name], []
    for size in ladder.sizes[: ladder.quick] if is_quick else ladder.sizes:
        print(f"{time.monotonic() - begun:5.0f} s  {name} {size:,}", file=sys.stderr, flush=True)
        found = rung(name, size)
        rungs.append(found | {"gil": gil.held(name, size)} if name == "threads" else found)
    return rungs


def rung(name, size):
    """What `benchmarks.growth.rung` says about one. Raises SystemExit with its output where it fails."""
    command = [sys.executable, "-m", "benchmarks.growth.rung", name, str(size)]
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode != 0 or not lines:
        raise SystemExit(f"{name} {size} failed with status {done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-4000:]}")
    return json.loads(lines[-1])


if __name__ == "__main__":
    main()
