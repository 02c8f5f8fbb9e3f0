"""Where the shared library of LLVM is that Mitsuba's llvm_* variants compile their kernels with."""

import os
import re
import subprocess
import sys
from itertools import product
from pathlib import Path

VARIABLE = "DRJIT_LIBLLVM_PATH"
FOLDERS = tuple(
    "usr/lib/*-linux-gnu usr/lib64 usr/lib usr/lib/llvm-*/lib usr/local/lib opt/homebrew/opt/llvm/lib usr/local/opt/llvm/lib".split()
)
NAMES = ("libLLVM*.so*", "libLLVM*.dylib")
OLDEST = 16
"""LLVM 15 is taken by Mitsuba 3.9, but fails to compile its kernels for processors with AVX-512."""
CURE = (
    f"Mitsuba runs in its slow variant scalar_rgb, for no LLVM works with it: install a shared library of LLVM {OLDEST} or newer, as "
    f"Debian 12 has in libllvm19, Ubuntu 24.04 in libllvm18 and Homebrew in llvm, or name it in {VARIABLE}"
)
_PROBE = """
import mitsuba
mitsuba.set_variant("llvm_ad_rgb")
print(mitsuba.render(mitsuba.load_dict(mitsuba.cornell_box()), spp=1).array[0])
"""


def candidates():
    """Paths, the newest version first; what `VARIABLE` names stands before all."""
    found = {}
    for folder, name in product(FOLDERS, NAMES):
        found |= {path.resolve(): version(path.resolve().name) for path in Path("/").glob(f"{folder}/{name}")}
    named = [Path(os.environ[VARIABLE])] if os.environ.get(VARIABLE) else []
    return [*named, *sorted((path for path, number in found.items() if number >= OLDEST), key=found.get, reverse=True)]


def version(name):
    """The major version in a file's name; 0 where it has none."""
    numbers = re.findall(r"\d+", name)
    return int(numbers[0]) if numbers else 0


def find():
    """The path of the first library with which Mitsuba renders a picture, or None."""
    for path in candidates():
        if path.exists() and _renders(path):
            return path
    return None


def _renders(path):
    # An LLVM that cannot compile what Mitsuba writes ends the process.
    done = subprocess.run([sys.executable, "-c", _PROBE], env={**os.environ, VARIABLE: str(path)}, capture_output=True, check=False)
    return done.returncode == 0
