"""The share of time in which the interpreter's lock (GIL) is held, as py-spy sees from outside while a rung renders again and again.

Looked at from outside nothing waits for the lock because of being looked at; a program that holds it half of the time is seen to
hold it in 0.50 of the samples.
"""

import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

from .measure import share_and_error
from .rung import READY

ROOT = Path(__file__).resolve().parents[2]
RATE, SECONDS = 97, 6
"""Samples per second, which keep no step with anything, and for how long."""
LONG = 10 * SECONDS
"""For so long a process renders, unless it is ended before."""
CURE = "py-spy is not installed, so the share of the time in which the GIL is held is left out: pip install py-spy"


def find():
    """The path of py-spy: beside Python, or anywhere it is looked for; None."""
    return shutil.which("py-spy", path=Path(sys.executable).parent) or shutil.which("py-spy")


def held(ladder, size):
    """{"share", "error"}: how much of the time some thread holds the GIL, and its standard error; {} where it cannot be seen."""
    spy = find()
    if spy is None:
        print(CURE, file=sys.stderr, flush=True)
        return {}
    command = [sys.executable, "-m", "benchmarks.growth.rung", ladder, str(size), str(LONG)]
    with tempfile.TemporaryDirectory() as folder, subprocess.Popen(command, cwd=ROOT, stdout=subprocess.PIPE, text=True) as process:
        try:
            if process.stdout.readline().strip() != READY:
                raise SystemExit(f"{ladder} {size} did not come to rendering again and again")
            path = Path(folder) / "stacks.txt"
            options = f"--gil --nonblocking --format raw --rate {RATE} --duration {SECONDS} --pid {process.pid}".split()
            done = subprocess.run([spy, "record", *options, "--output", str(path)], capture_output=True, text=True, check=False)
            if done.returncode or not path.exists():
                print(f"py-spy sees nothing: {done.stderr.strip()[-400:]}", file=sys.stderr, flush=True)
                return {}
            return dict(zip(("share", "error"), share_and_error(*counted(path.read_text(encoding="utf-8"), done.stdout + done.stderr))))
        finally:
            process.kill()


def counted(stacks, said):
    """(samples that found the GIL held, samples): from lines `stack count` of holders and what py-spy `said`: how many failed."""
    hits = sum(int(line.rpartition(" ")[2]) for line in stacks.splitlines() if line.strip())
    failed = re.search(r"Errors: (\d+)", said)
    return hits, RATE * SECONDS - (int(failed[1]) if failed else 0)
