"""Functions given by their values at equal steps."""

import numpy as np

from ..errors import SceneError


def look_up(table, x, is_smooth=True, goes_on=False):
    """`table` (C, K) at x (1 or C, N), which is 0 at the first entry and 1 at the last: (C, N) float32.

    is_smooth  linear between the entries; else the entry below
    goes_on    beyond the ends as the first and the last two entries go; else the end itself
    """
    last = table.shape[1] - 1
    place = np.clip(np.where(np.isnan(x), 0, x), 0, 1) * np.float32(last)
    below = np.minimum(place.astype(np.intp), last)
    if is_smooth:
        t = place - below.astype(np.float32)
        found = (1 - t) * _entries(table, below) + t * _entries(table, np.minimum(below + 1, last))
    else:
        found = _entries(table, below)
    if not goes_on:
        return found
    first, end = table[:, :1], table[:, -1:]
    before = first + (first - table[:, 1:2]) * -x * np.float32(last)
    after = end + (end - table[:, -2:-1]) * (x - 1) * np.float32(last)
    return np.where(x < 0, before, np.where(x > 1, after, found))


def _entries(table, k):
    """(C, N) of the columns k (1 or C, N)."""
    return np.take_along_axis(table, np.broadcast_to(k, (table.shape[0], k.shape[1])), axis=1)


def check_table(table, name):
    """Raises SceneError, naming the table, unless it is a finite float32 array of one or three rows and two columns or more."""
    is_table = isinstance(table, np.ndarray) and table.dtype == np.float32 and table.ndim == 2
    if not is_table or len(table) not in (1, 3) or table.shape[1] < 2:
        raise SceneError(f"{name} is no float32 array of one or three rows of at least 2")
    if not np.isfinite(table).all():
        raise SceneError(f"{name} has numbers that are not finite")
