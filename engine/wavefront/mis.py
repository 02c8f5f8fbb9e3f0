"""Multiple importance sampling (Veach 1997, section 9.2)."""

import numpy as np


def power_heuristic(pdf, other):
    """The weight (N,) of a sample with density `pdf`, where `other` is the density of the other way to find it.

    Veach's beta = 2 (eq. 9.13), as a ratio: squares of densities overflow float32. An infinite `pdf` weighs 1.
    """
    with np.errstate(over="ignore", divide="ignore", invalid="ignore"):
        ratio = other / pdf
        return 1 / (1 + ratio * ratio)
