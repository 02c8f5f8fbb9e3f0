"""Student's t distribution (Student 1908, "The Probable Error of a Mean", Biometrika 6(1)): what intervals around means are wide."""

import numpy as np

_NORMAL = 1.959963984540054
# By n, the degrees of freedom; from there on the expansion is good to 1e-4.
_FEW = (np.inf, 12.706204736, 4.302652730, 3.182446305, 2.776445105)


def quantile_975(freedom):
    """t (N,) that a variable of Student's distribution with `freedom` (N,) >= 0 degrees exceeds in 2.5 %; infinite for 0.

    Abramowitz and Stegun 1964, equation 26.7.5; relative error below 2e-4. Below 5 parts of a degree count for nothing.
    """
    freedom = np.asarray(freedom)
    n = np.maximum(freedom, len(_FEW))
    x = _NORMAL
    g1 = (x**3 + x) / 4
    g2 = (5 * x**5 + 16 * x**3 + 3 * x) / 96
    g3 = (3 * x**7 + 19 * x**5 + 17 * x**3 - 15 * x) / 384
    g4 = (79 * x**9 + 776 * x**7 + 1482 * x**5 - 1920 * x**3 - 945 * x) / 92160
    many = x + g1 / n + g2 / n**2 + g3 / n**3 + g4 / n**4
    return np.where(freedom < len(_FEW), np.array(_FEW).take(np.minimum(freedom, len(_FEW) - 1).astype(int)), many)
