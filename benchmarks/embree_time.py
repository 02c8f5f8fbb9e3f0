"""How much of the threads' time is spent inside Embree: a stand-in for Embree's scene that looks at the clock."""

import contextlib
import threading
import time

from glanz.engine.world import accel


class TimedScene:
    """Everything goes on to embreex, timed with the clock of the thread that calls."""

    def __init__(self, scene):
        self._scene = scene
        self._lock = threading.Lock()
        self.seconds = 0.0
        self.rays = 0

    def run(self, origins, directions, **options):
        start = time.thread_time()
        result = self._scene.run(origins, directions, **options)
        seconds = time.thread_time() - start
        with self._lock:
            self.seconds += seconds
            self.rays += len(origins)
        return result


@contextlib.contextmanager
def timed():
    """All `Accel` made inside are timed: a list of their `TimedScene`s."""
    scenes = []
    build = accel.Accel.__init__

    def build_timed(self, vertices, triangles):
        build(self, vertices, triangles)
        self._scene = TimedScene(self._scene)
        scenes.append(self._scene)

    accel.Accel.__init__ = build_timed
    try:
        yield scenes
    finally:
        accel.Accel.__init__ = build
