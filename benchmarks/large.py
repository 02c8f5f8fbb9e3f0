"""One mesh of ten million triangles in Blender, rendered by F12: what export, build and rendering take, and how much memory.

    python -m benchmarks.large [triangles [smooth | flat]]

Without arguments both shadings are measured, each in a process of its own.
"""

import json
import math
import subprocess
import sys
import time

import bpy
import numpy as np

from glanz.addon import export
from glanz.engine import rendering
from glanz.sample_scenes import common

from . import blender
from .growth.rung import forget_highest, highest

TRIANGLES = 10**7
SHADINGS = ("smooth", "flat")
SIDE, SAMPLES, DEPTH = 512, 16, 4


def main(triangles=TRIANGLES, *shadings):
    found = {}
    for shading in shadings or SHADINGS:
        command = [sys.executable, "-m", "benchmarks.large", str(triangles), shading]
        done = subprocess.run(command, stdout=subprocess.PIPE, text=True, check=True)
        found |= {f"{shading}_{key}": value for key, value in json.loads(done.stdout.splitlines()[-1]).items()}
    print(json.dumps(found))


def measure(triangles, shading):
    """Seconds of "export", "build" and "render", wall and processor ("_cpu") time; "total" is all that F12 takes.

    Resident memory [MB]: "before" F12 is Blender with its mesh; "peak" is the most of the process, "over" the most above "before".
    """
    with blender.quiet():
        scene = build(triangles, shading == "smooth")
    marks = []
    export.export_views = marking(export.export_views, marks)
    # The plan is compiled and the tree is built before.
    rendering.render_plan = marking(rendering.render_plan, marks)
    before = forget_highest()
    marks.append(moment())
    blender.press_f12("GLANZ")
    marks.append(moment())
    begin, exported, built, end = marks
    peak = highest()
    result = {"triangles": len(scene.objects["Hills"].data.polygons) * 1e-6, "before": before, "peak": peak, "over": peak - before}
    for name, start, stop in (("export", begin, exported), ("build", exported, built), ("render", built, end), ("total", begin, end)):
        result |= {name: stop[0] - start[0], f"{name}_cpu": stop[1] - start[1]}
    return result


def build(triangles, is_smooth):
    """The open file: one mesh of about so many `triangles`, a lamp, a camera."""
    scene = common.new_scene("Large", SIDE, SIDE, SAMPLES, DEPTH)
    scene.render.threads_mode, scene.render.threads = "FIXED", blender.THREADS
    side = max(round(math.sqrt(triangles / 2)), 1)
    x, y = np.meshgrid(*[np.linspace(-3, 3, side + 1, dtype=np.float32)] * 2)
    z = 0.3 * np.sin(3 * x) * np.cos(2 * y)
    corner = (np.arange(side, dtype=np.int32)[:, None] * (side + 1) + np.arange(side, dtype=np.int32)).ravel()
    a, b, c, d = corner, corner + 1, corner + side + 2, corner + side + 1
    corners = np.stack((a, b, c, a, c, d), axis=1).ravel()
    mesh = bpy.data.meshes.new("Hills")
    mesh.vertices.add(x.size)
    mesh.vertices.foreach_set("co", np.stack((x, y, z), axis=-1).ravel())
    mesh.loops.add(corners.size)
    mesh.loops.foreach_set("vertex_index", corners)
    mesh.polygons.add(corners.size // 3)
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 3, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.full(corners.size // 3, is_smooth))
    mesh.materials.append(common.diffuse("Grey", (0.6, 0.6, 0.6)))
    mesh.update(calc_edges=True)
    common.add(scene, "Hills", mesh)
    common.light(scene, "Lamp", "POINT", (1, -1, 4), (0, 0, 0), 1000)
    common.camera(scene, (4, -5, 4), (0, 0, 0), lens=45)
    return scene


def marking(function, marks):
    """`function`, which notes the moment when it is done."""

    def marked(*arguments, **options):
        result = function(*arguments, **options)
        marks.append(moment())
        return result

    return marked


def moment():
    return time.perf_counter(), time.process_time()


if __name__ == "__main__":
    if len(sys.argv) > 2:
        blender.finish(measure(int(sys.argv[1]), sys.argv[2]))
    main(*map(int, sys.argv[1:]))
