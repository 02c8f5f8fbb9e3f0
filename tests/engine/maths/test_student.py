"""Quantiles of Student's distribution, against SciPy's."""

import numpy as np
from scipy import stats

from glanz.engine.maths.student import quantile_975


def test_quantiles_are_those_of_students_distribution():
    freedom = np.arange(1, 4096)
    np.testing.assert_allclose(quantile_975(freedom), stats.t.ppf(0.975, freedom), rtol=2e-4)


def test_nothing_is_known_without_a_degree_of_freedom():
    assert np.isinf(quantile_975(np.zeros(3, int))).all()
