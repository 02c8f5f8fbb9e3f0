"""A process in which Mitsuba renders one exported scene, as it is told: `python -m benchmarks.peers.mitsuba_worker`."""

import json
import sys
import time

import numpy as np

from glanz.engine import read_scene

from ..memory import peak
from .work import serve

MOST_SAMPLES = 64
"""Of one picture; longer ones are means of several, or the wavefront would not fit into memory."""


class Mitsuba:
    """The loaded scene; each method answers with numbers."""

    def __init__(self, variant, path, sides, threads):
        import drjit
        import mitsuba as mi

        mi.set_variant(variant)
        drjit.set_thread_count(threads)
        # It asks for a variant at its import.
        from . import translate

        self._mi, self._translate, self._sides = mi, translate, tuple(sides)
        self.imported = peak()
        scene, settings = read_scene(path)
        start = time.perf_counter()
        self._scene = mi.load_dict(translate.translate(scene, settings, sides))
        self.loaded = time.perf_counter() - start

    def load(self):
        """Seconds that translating and loading took."""
        return {"load": self.loaded}

    def render(self, sampler, samples, side, seed=0):
        """Seconds of a render {"wall", "cpu"}; the first with a sampler and size compiles its kernels, too."""
        start, cpu = time.perf_counter(), time.process_time()
        self._rendered(sampler, samples, side, seed)
        return {"wall": time.perf_counter() - start, "cpu": time.process_time() - cpu}

    def picture(self, path, sampler, samples, side, seed):
        """Write the picture (H, W, 3) to `path` .npy."""
        parts = max(samples // MOST_SAMPLES, 1)
        pictures = (self._rendered(sampler, samples // parts, side, seed * 1000 + part) for part in range(parts))
        np.save(path, sum(pictures) / parts)
        return {}

    def memory(self):
        """The largest resident set so far, and what importing took of it [MB]."""
        return {"peak": peak(), "imported": self.imported}

    def _rendered(self, sampler, samples, side, seed):
        index = self._translate.sensor_index(self._sides, side, sampler)
        return np.array(self._mi.render(self._scene, sensor=index, spp=samples, seed=seed), np.float32)


if __name__ == "__main__":
    serve(Mitsuba(*json.loads(sys.argv[1])))
