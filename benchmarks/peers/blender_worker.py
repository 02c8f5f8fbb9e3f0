"""A process in which Blender renders one scene with Glanz or with Cycles, as it is told: `python -m benchmarks.peers.blender_worker`."""

import os
import sys
import time
from pathlib import Path

import bpy
import numpy as np
import OpenEXR

from glanz.addon import results
from glanz.addon.capture import capture
from glanz.engine import prepare, render_image, render_plan, rendering, write_scene

from ..blender import press_f12, quiet
from ..embree_time import timed
from ..memory import peak
from . import scenes
from .work import answer, serve


class Blender:
    """The open scene; each method answers with numbers. `side` is the longer one of the picture [px]."""

    def __init__(self, engine, name, folder):
        self.imported = peak()
        start = time.perf_counter()
        self.engine, self.folder = engine, Path(folder)
        self.scene = scenes.build(name)
        self.built = time.perf_counter() - start
        self.marks = {}
        bpy.app.handlers.render_stats.append(self._on_status)
        # The plan is compiled and the tree is built before.
        rendering.render_plan = self._marking(rendering.render_plan, "began")
        results.write_tile = self._marking(results.write_tile, "pixel")

    def _on_status(self, text, *_):
        # Cycles says how many samples are done, none at first, once everything is built.
        if self.engine == "CYCLES" and "Sample " in text:
            self._mark("began")
            if "Sample 0/" not in text:
                self._mark("pixel")

    def _mark(self, key):
        self.marks.setdefault(key, time.perf_counter())
        self.marks.setdefault(f"{key} cpu", time.process_time())

    def _marking(self, function, key):
        """`function`, which marks `key` once it is done."""

        def marking(*args, **options):
            result = function(*args, **options)
            self._mark(key)
            return result

        return marking

    def f12(self, samples, side, seed=0, **options):
        """Seconds of a render: "wall" of all, of which "load" until it begins to trace and "alone" the rest; "cpu" and "cpu_alone" of all
        processors; "first_pixel" from the start to the first pixels.
        """
        scenes.set_frame(self.scene, samples, side, seed)
        self.marks.clear()
        start, start_cpu = time.perf_counter(), time.process_time()
        wall, cpu = press_f12(self.engine, **options)
        load, pixel = (self.marks[key] - start for key in ("began", "pixel"))
        cpu_alone = cpu - (self.marks["began cpu"] - start_cpu)
        return {"wall": wall, "load": load, "alone": wall - load, "cpu": cpu, "cpu_alone": cpu_alone, "first_pixel": pixel}

    def first_pixel(self, width=1920, height=1080, samples=64):
        """Seconds to the first pixels of a warm F12; then the process ends, whatever is left to render."""
        scenes.set_frame(self.scene, 1, max(width, height))
        self.scene.render.resolution_x, self.scene.render.resolution_y = width, height
        press_f12(self.engine)
        self.scene.glanz.samples = self.scene.cycles.samples = samples
        self.marks, start = _First(lambda moment: answer({"first_pixel": moment - start})), time.perf_counter()
        press_f12(self.engine)

    def picture(self, path, samples, side, seed):
        """Write the picture (H, W, 3) to `path` .npy."""
        settings = self.scene.render.image_settings
        if hasattr(settings, "media_type"):
            settings.media_type = "IMAGE"
        settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
        written = self.folder / f"{Path(path).stem}.exr"
        self.scene.render.filepath = str(written)
        done = self.f12(samples, side, seed, write_still=True)
        with OpenEXR.File(str(written)) as file:
            channels = file.channels()
            pixels = channels["RGB"].pixels if "RGB" in channels else np.stack([channels[c].pixels for c in "RGB"], axis=2)
            np.save(path, pixels)
        written.unlink()
        return done

    def memory(self):
        """The largest resident set so far, and what importing took of it [MB]."""
        return {"peak": peak(), "imported": self.imported}

    def export(self, path, side):
        """Write the scene for the engines that know no Blender; the seconds of the export, and how long building the scene took before."""
        scenes.set_frame(self.scene, 1, side)
        start = time.perf_counter()
        with quiet():
            scene, settings, warnings = capture()
        seconds = time.perf_counter() - start
        if warnings:
            raise SystemExit(f"scene '{self.scene.name}' is not exported as it is: {'; '.join(warnings)}")
        write_scene(path, scene, settings)
        return {"seconds": seconds, "built": self.built, "triangles": sum(o.mesh.triangles.shape[1] for o in scene.objects)}

    def lit_pixels(self, path, side, samples=64):
        """Write (H, W), where the camera sees a light or the world directly, to `path` .npy."""
        scenes.set_frame(self.scene, samples, side)
        with quiet():
            scene, settings, _ = capture(overrides={"passes": ("Combined", "Emission", "Environment")})
        passes = render_image(scene, settings).passes
        np.save(path, sum(passes[key].max(axis=2) for key in ("Emission", "Environment")) > 0)
        return {}

    def core(self, samples, side):
        """Seconds of the engine alone, without Blender: "prepare" and "render"; and Embree's share of the threads' time [%]."""
        scenes.set_frame(self.scene, samples, side)
        with quiet():
            scene, settings, _ = capture()
        start = time.perf_counter()
        plan, _ = prepare(scene, settings)
        prepared = time.perf_counter()
        for _ in render_plan(plan):
            pass
        end = time.perf_counter()
        with timed() as accels:
            plan, _ = prepare(scene, settings)
            cpu = time.process_time()
            for _ in render_plan(plan):
                pass
            cpu = time.process_time() - cpu
        embree = sum(accel.seconds for accel in accels)
        rays = sum(accel.rays for accel in accels)
        return {"prepare": prepared - start, "render": end - prepared, "embree_share": 100 * embree / cpu, "rays": 1e-6 * rays}


class _First(dict):
    """Marks of which "pixel" is the last: tells when it comes, and ends the process."""

    def __init__(self, tell):
        self._tell = tell

    def setdefault(self, key, moment):
        if key == "pixel":
            self._tell(moment)
            os._exit(0)


if __name__ == "__main__":
    serve(Blender(*sys.argv[1:4]))
