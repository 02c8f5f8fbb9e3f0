"""Processes that serve one engine and one scene each: they are told what to do by lines of JSON, and answer by lines of JSON."""

import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
MARK = "answer: "
"""What Blender and Mitsuba print between is not an answer."""
_ANSWERS = os.dup(1)
"""Where they go also while Blender is silenced."""


class Worker:
    """A process that runs the module `benchmarks.peers.NAME`; its methods are those of the object that it serves."""

    def __init__(self, module, *arguments, log, **environment):
        self._module = module
        self._errors = (ROOT / "out" / "peers" / f"{log}.log").open("w+", encoding="utf-8")
        self._process = subprocess.Popen(
            [sys.executable, "-m", f"benchmarks.peers.{module}", *arguments],
            cwd=ROOT,
            env={**os.environ, **environment},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=self._errors,
            text=True,
        )

    def __getattr__(self, method):
        if method.startswith("_"):
            raise AttributeError(method)
        return lambda **options: self._ask(method, options)

    def _ask(self, method, options):
        try:
            self._process.stdin.write(json.dumps([method, options]) + "\n")
            self._process.stdin.flush()
        except BrokenPipeError:
            pass  # what it printed before says why
        for line in self._process.stdout:
            if line.startswith(MARK):
                return json.loads(line[len(MARK) :])
        self._errors.seek(0)
        raise SystemExit(f"benchmarks.peers.{self._module} ended in '{method}' {options}:\n{self._errors.read()[-4000:]}")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self._process.stdin.close()
        self._process.wait()
        self._process.stdout.close()
        self._errors.close()


def serve(target):
    """Answer until there is nothing more to be told; without Python's clean-up, which some versions of bpy do not survive."""
    for line in sys.stdin:
        method, options = json.loads(line)
        answer(getattr(target, method)(**options))
    os._exit(0)


def answer(result):
    """Tell the one who asked."""
    os.write(_ANSWERS, f"{MARK}{json.dumps(result)}\n".encode())
