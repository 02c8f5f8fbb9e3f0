"""What is computed with values may be infinite, and nothing else is told of that."""

import numpy as np

from glanz.addon.export.colours import added, times
from glanz.engine import NoiseTexture


def test_products_and_sums_leave_numpys_warnings_as_they_are():
    """Those of textures are made of others: NumPy 1.26 forgets the state before where a function that it decorates calls itself."""
    noise, huge = NoiseTexture(), (1e308,) * 3
    with np.errstate(all="raise"):
        before = np.geterr()
        total = added(times(times(noise, huge), huge), times(noise, huge))
        assert np.geterr() == before
    assert (total.textures, total.factors) == ((noise,), ((np.inf,) * 3,))
