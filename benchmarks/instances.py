"""From a million triangles of instances in Blender to a world ready for rays."""

import sys
import time

import bpy

import glanz
from glanz.addon import capture as capture_module
from glanz.engine import Requirements
from glanz.engine.plan import Plan

from . import blender

MILLION = 10**6
FLORETS, DETAIL = 1400, 6
"""In each of six flowers; a floret has 4 DETAIL (DETAIL - 1) triangles."""


def main():
    sys.path.insert(0, str(blender.CORNELL_BOX.parent))
    import instances as sample

    glanz.register()
    with blender.quiet():
        sample.build(FLORETS, DETAIL)
        bpy.context.evaluated_depsgraph_get()
        export_seconds = []
        capture_module.export_scene = timed(capture_module.export_scene, export_seconds)
        start = time.perf_counter()
        scene, settings, _ = capture_module.capture()
        captured = time.perf_counter() - start
    start = time.perf_counter()
    Plan.of(scene, settings, Requirements.of(scene, settings))
    compiled = time.perf_counter() - start
    result = {
        "triangles": sum(o.mesh.triangles.shape[1] for o in scene.objects) / MILLION,
        "objects": len(scene.objects),
        "export": export_seconds[0],
        "export_with_blender": captured,
        "compile": compiled,
        "total": export_seconds[0] + compiled,
    }
    blender.finish(result)


def timed(function, seconds):
    """`function`, which notes how long it takes."""

    def wrapper(*arguments, **options):
        start = time.perf_counter()
        result = function(*arguments, **options)
        seconds.append(time.perf_counter() - start)
        return result

    return wrapper


if __name__ == "__main__":
    main()
