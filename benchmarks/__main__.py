"""Run all measurements, print them with the bars they are held to, and write out/bench.json.

    python -m benchmarks [name ...]    of: speed error many_lights instances motion features memory extremes large; none: all but large,
    which takes minutes and gigabytes

Every measurement runs in a process of its own. Nothing here fails because of a time: numbers are to be read.
"""

import json
import os
import platform
import subprocess
import sys
import time
from pathlib import Path

from .table import show

ROOT = Path(__file__).resolve().parent.parent
OUT = ROOT / "out"
NAMES = ("speed", "error", "many_lights", "instances", "motion", "features", "memory", "extremes")
IF_ASKED = ("large",)


def main(names):
    unknown = set(names).difference(NAMES, IF_ASKED)
    if unknown:
        raise SystemExit(f"unknown: {', '.join(sorted(unknown))}; known: {', '.join(NAMES + IF_ASKED)}")
    OUT.mkdir(exist_ok=True)
    machine = describe_machine()
    print("   ".join(f"{key} {value}" for key, value in machine.items()), flush=True)
    results = {}
    for name in names or NAMES:
        print(f"measuring {name} ...", file=sys.stderr, flush=True)
        results[name] = measure(name)
    path = OUT / "bench.json"
    old = json.loads(path.read_text()) if path.exists() else {}
    path.write_text(json.dumps(old | results | {"machine": machine}, indent=2) + "\n")
    show(results)
    print(f"wrote {path.relative_to(ROOT)}")


def describe_machine():
    """What the numbers depend on."""
    load = os.getloadavg()[0] if hasattr(os, "getloadavg") else float("nan")
    return {
        "processor": processor(),
        "cores": os.cpu_count(),
        "load": round(load, 2),
        "python": platform.python_version(),
        "date": time.strftime("%Y-%m-%d"),
    }


def processor():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as lines:
            return next(line.partition(":")[2].strip() for line in lines if line.startswith("model name"))
    except (OSError, StopIteration):
        return platform.processor() or platform.machine()


def measure(name):
    """What the module `name` prints as its last line: JSON. Raises SystemExit with its output where it fails."""
    done = subprocess.run([sys.executable, "-m", f"benchmarks.{name}"], cwd=ROOT, capture_output=True, text=True, check=False)
    lines = [line for line in done.stdout.splitlines() if line.startswith("{")]
    if done.returncode != 0 or not lines:
        raise SystemExit(f"benchmarks.{name} failed with status {done.returncode}:\n{done.stdout[-2000:]}{done.stderr[-4000:]}")
    return json.loads(lines[-1])


if __name__ == "__main__":
    main(sys.argv[1:])
