"""Does Blender, as a Python module, load on this machine? If not, say what to do about it.

Exit status 1 when bpy should load and does not; 0 when it loads, or when there is none for this Python.
"""

import importlib.util
import re
import subprocess
import sys

DEBIAN = {
    "libX11.so": "libx11-6", "libXrender.so": "libxrender1", "libXfixes.so": "libxfixes3", "libXi.so": "libxi6",
    "libXxf86vm.so": "libxxf86vm1", "libXext.so": "libxext6", "libxkbcommon.so": "libxkbcommon0", "libSM.so": "libsm6",
    "libICE.so": "libice6", "libGL.so": "libgl1", "libEGL.so": "libegl1", "libgomp.so": "libgomp1", "libuuid.so": "libuuid1",
    "libz.so": "zlib1g", "libxcb.so": "libxcb1",
}  # fmt: skip
"""The Debian package of each library that bpy takes from the system."""


def missing_libraries(text):
    """The libraries that ldd's output `text` calls not found."""
    return re.findall(r"^\s*(\S+) => not found", text, flags=re.MULTILINE)


def packages(libraries):
    """(Debian packages, libraries that none is known for)."""
    known = {library: package for library in libraries for name, package in DEBIAN.items() if library.startswith(name)}
    return sorted(set(known.values())), [library for library in libraries if library not in known]


def advice(error, libraries):
    """What to tell a user whose bpy fails with `error` and lacks `libraries`."""
    lines = [f"Blender's Python module bpy is installed but does not load: {error}"]
    debian, others = packages(libraries)
    if debian:
        lines.append(f"It needs libraries of the system. On Debian or Ubuntu: sudo apt-get install {' '.join(debian)}")
    if others:
        lines.append(f"Libraries that were not found: {' '.join(others)}")
    lines.append("To go on without Blender: BPY=none make test")
    return "\n".join(lines)


def main():
    version = "{}.{}".format(*sys.version_info)
    spec = importlib.util.find_spec("bpy")
    if spec is None:
        print(
            f"There is no bpy in this environment (Python {version}): .blend files cannot be rendered here, and tests that need "
            "Blender are skipped. It exists for Python 3.11 (Blender 4.2 to 5.0) and 3.13 (Blender 5.2)."
        )
        return 0
    # In a process of its own: some versions crash when the interpreter ends.
    program = "import bpy, os, sys; print(bpy.app.version_string, flush=True); os._exit(0)"
    result = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    if result.returncode == 0:
        print(f"Blender {result.stdout.split()[-1]} loads.")
        return 0
    error = (result.stderr.strip().splitlines() or [f"exit status {result.returncode}"])[-1]
    # Of the module itself, whose list includes those of the libraries that it brings along; others are for graphics cards.
    ldd = subprocess.run(["ldd", spec.origin], capture_output=True, text=True, stdin=subprocess.DEVNULL)
    print(advice(error, sorted(set(missing_libraries(ldd.stdout)))), file=sys.stderr)
    return 1


if __name__ == "__main__":
    sys.exit(main())
