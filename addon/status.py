"""The status line of a running render."""

import math
import time

from .memory import peak_megabytes, used_megabytes
from .reports import counted


class Status:
    """Shows share done, samples, time left and memory in Blender's render `engine`."""

    def __init__(self, engine, samples, clock=time.monotonic):
        self._engine = engine
        self._samples = samples
        self._clock = clock
        self._start = clock()

    def show(self, done, warnings=0, where="", reached=None):
        """`done` in [0, 1]; how many warnings there were; `where` says which of several pictures it is of; what it has `reached`."""
        used, peak = used_megabytes(), peak_megabytes()
        line = text(done, self._samples, self._clock() - self._start, warnings, used, reached)
        self._engine.update_progress(done)
        # Blender has a place of its own for memory, which it does not show beside a line like this.
        self._engine.update_stats("", f"{where}: {line}" if where else line)
        if used is not None:
            # The system counts the peak now and then only.
            self._engine.update_memory_stats(memory_used=used, memory_peak=max(used, peak))


def text(done, samples, elapsed, warnings=0, memory=None, reached=None):
    """Such as "45% of 64 samples, 1:05 left, error 2.1 % after 32, 400 MB, 3 warnings".

    The rest of the time is taken to pass as `elapsed` [s] did; `memory` [MB], where it is known, is that of Blender and all in it.
    With an error target `done` may be of fewer samples than `samples`; `reached`, the engine's, says how many there are.
    """
    left = (f"{minutes(elapsed * (1 - done) / done)} left",) if done > 0 else ()
    used = (f"{memory:,.0f} MB",) if memory is not None else ()
    told = (counted(warnings, "warning"),) if warnings else ()
    is_measured = reached is not None and math.isfinite(reached.error)
    error = (f"error {100 * reached.error:.2g} % after {reached.samples}",) if is_measured else ()
    return ", ".join((f"{100 * done:.0f}% of {samples} samples", *left, *error, *used, *told))


def minutes(seconds):
    """m:ss, from an hour on h:mm:ss."""
    m, s = divmod(round(seconds), 60)
    h, m = divmod(m, 60)
    return f"{h}:{m:02}:{s:02}" if h else f"{m}:{s:02}"
