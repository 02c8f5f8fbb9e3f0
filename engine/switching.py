"""How soon a thread that waits for Python's lock (GIL) gets it while pictures are rendered."""

import sys
import threading
from contextlib import contextmanager

SECONDS = 0.0005
"""Threads let go of the lock for every call to NumPy and Embree, but mostly take it again before one that waits has woken up: that one
gets it for certain only after this time, which is 5 ms in Python."""
_lock = threading.RLock()
# Not Lock: a render that was left may be collected, and end, while this very thread holds it.
_before = []
"""The interval of the process before the first of the renders that are under way, one entry for each of them."""


@contextmanager
def brisk_switching():
    """Have threads of the process wait no longer than `SECONDS` while the block lasts; what was before comes back after the last."""
    with _lock:
        _before.append(_before[0] if _before else sys.getswitchinterval())
        sys.setswitchinterval(min(_before[0], SECONDS))
    try:
        yield
    finally:
        with _lock:
            before = _before.pop()
            if not _before:
                sys.setswitchinterval(before)
