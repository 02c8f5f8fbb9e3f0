"""The largest resident set of a Full HD render with three passes, and of a process that only imports bpy."""

import resource
import subprocess
import sys


def main():
    command = [sys.executable, "-m", "benchmarks.memory", "import"]
    alone = subprocess.run(command, capture_output=True, text=True, check=True)
    only_import = float(alone.stdout.split()[-1])
    from . import blender

    scene = blender.open_cornell_box(samples=4, width=1920, height=1080)
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_normal = True
    blender.press_f12("GLANZ")
    blender.finish({"import_bpy": only_import, "peak": peak(), "over": peak() - only_import})


def peak():
    """Largest resident set so far [MB]."""
    # Linux counts in kB, macOS in bytes.
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss * (1e-6 if sys.platform == "darwin" else 1.024e-3)


if __name__ == "__main__":
    if sys.argv[1:] == ["import"]:
        import os

        import bpy  # noqa: F401 - this is what is measured

        print(peak(), flush=True)
        os._exit(0)
    main()
