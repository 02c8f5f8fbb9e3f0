"""The status line of a running render."""

import time

from .memory import peak_megabytes


class Status:
    """Shows share done, samples, time left and memory in Blender's render `engine`."""

    def __init__(self, engine, samples, clock=time.monotonic):
        self._engine = engine
        self._samples = samples
        self._clock = clock
        self._start = clock()

    def show(self, done, warnings=0):
        """`done` in [0, 1]; how many warnings there were."""
        self._engine.update_progress(done)
        self._engine.update_stats("", text(done, self._samples, self._clock() - self._start, warnings))
        memory = peak_megabytes()
        if memory is not None:
            self._engine.update_memory_stats(memory_used=memory, memory_peak=memory)


def text(done, samples, elapsed, warnings=0):
    """Such as "45% of 64 samples, 1:05 left, 3 warnings"; the rest of the time is taken to pass as `elapsed` [s] did."""
    left = (f"{minutes(elapsed * (1 - done) / done)} left",) if done > 0 else ()
    told = (f"{warnings} warning{'' if warnings == 1 else 's'}",) if warnings else ()
    return ", ".join((f"{100 * done:.0f}% of {samples} samples", *left, *told))


def minutes(seconds):
    """m:ss, from an hour on h:mm:ss."""
    m, s = divmod(round(seconds), 60)
    h, m = divmod(m, 60)
    return f"{h}:{m:02}:{s:02}" if h else f"{m}:{s:02}"
