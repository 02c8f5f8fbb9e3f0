"""What is computed from a ladder of measurements; pure functions."""

import math

import numpy as np

LARGE = 3
"""So many of the largest rungs tell the slope where what is paid once no longer counts."""


def slope(sizes, values):
    """Of log `values` over log `sizes`, by least squares: 1 is linear, 0 constant. NaN where less than two are above 0."""
    sizes, values = np.asarray(sizes, float), np.asarray(values, float)
    known = values > 0
    if known.sum() < 2:
        return math.nan
    return float(np.polyfit(np.log(sizes[known]), np.log(values[known]), 1)[0])


def slope_at_the_end(sizes, values):
    """`slope` of the LARGE largest."""
    order = np.argsort(sizes)[-LARGE:]
    return slope(np.asarray(sizes)[order], np.asarray(values)[order])


def serial_share(times):
    """The serial share in Amdahl's law of {threads: seconds}, in [0, 1], by least squares; it needs one thread and more.

    By it, times(n) / times(1) - 1 / n is `serial` times (1 - 1 / n).
    """
    n = np.array([count for count in times if count > 1], float)
    excess = np.array([seconds / times[1] for count, seconds in times.items() if count > 1]) - 1 / n
    return float(np.clip((excess * (1 - 1 / n)).sum() / ((1 - 1 / n) ** 2).sum(), 0.0, 1.0))


def amdahl(serial, threads):
    """How much faster `threads` are than one where, in a share `serial` of the time of one, all others wait (Amdahl 1967)."""
    return 1 / (serial + (1 - serial) / threads)


def behind_a_lock(share, threads):
    """How much faster `threads` are than one where each holds a lock for `share` of its time alone, and others wait only for the lock.

    The machine repairman's model, solved by mean value analysis (Reiser & Lavenberg 1980, with one queue and think time 1 - share);
    times are random, exponentially. It rises as threads do at first, then to 1 / share, above Amdahl's law.
    """
    rate = queue = 0.0
    for n in range(1, threads + 1):
        response = share * (1 + queue)
        rate = n / (1 - share + response)
        queue = rate * response
    return rate


def share_and_error(hits, samples):
    """(share, standard error) of what `hits` of `samples` found; neither is known without samples."""
    if not samples:
        return math.nan, math.nan
    share = hits / samples
    # Laplace's estimate keeps the error of none and of all above 0.
    smooth = (hits + 1) / (samples + 2)
    return share, math.sqrt(smooth * (1 - smooth) / samples)
