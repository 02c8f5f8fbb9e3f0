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

    def show(self, done):
        """`done` in [0, 1]."""
        self._engine.update_progress(done)
        self._engine.update_stats("", text(done, self._samples, self._clock() - self._start))
        memory = peak_megabytes()
        if memory is not None:
            self._engine.update_memory_stats(memory_used=memory, memory_peak=memory)


def text(done, samples, elapsed):
    """Such as "45% of 64 samples, 1:05 left"; the rest of the time is taken to pass as `elapsed` [s] did."""
    line = f"{100 * done:.0f}% of {samples} samples"
    return f"{line}, {minutes(elapsed * (1 - done) / done)} left" if done > 0 else line


def minutes(seconds):
    """m:ss, from an hour on h:mm:ss."""
    m, s = divmod(round(seconds), 60)
    h, m = divmod(m, 60)
    return f"{h}:{m:02}:{s:02}" if h else f"{m}:{s:02}"
