"""What lights and rough lobes promise to integrators that are not physical: a middle, and a term of the illumination model."""

import numpy as np
import pytest

from glanz.engine.maths.vectors import dot, reflect
from glanz.engine.registry import BSDFS
from glanz.tests import helpers as h
from glanz.tests.contracts import test_lights as lights

SHRINKABLE = [value for value in lights.ALL if hasattr(type(value), "middle")]
REFLECTING = [plugin for plugin in BSDFS.values() if not plugin.is_specular and not plugin.transmits]
NORMAL = h.unit(0.3, -0.5, 0.8)


def check_middle(value):
    """Every example but the sun stands at ABOVE, and has its middle there."""
    k = h.table(value.row(h.UNIT_FRAME))
    wi, _, E, _ = type(value).sample(k, lights.P, np.broadcast_to(type(value).middle(k), (2, 1)).astype(np.float64))
    towards = getattr(value, "towards", np.array(lights.ABOVE) - lights.P[:, 0])
    np.testing.assert_allclose(wi[:, 0], towards / np.linalg.norm(towards), atol=1e-6)
    assert np.isfinite(E).all()


@pytest.mark.parametrize("value", SHRINKABLE, ids=lights.name)
def test_the_middle_of_a_light_is_where_it_stands(value):
    check_middle(value)


def test_the_middle_catches_a_corner(monkeypatch):
    value = lights.EXAMPLES["area"][0]
    monkeypatch.setattr(type(value), "middle", staticmethod(lambda k: np.zeros((2, 1))))
    with pytest.raises(AssertionError):
        check_middle(value)


@pytest.mark.parametrize("plugin", REFLECTING, ids=lambda p: p.key)
def test_a_term_of_the_illumination_model_is_the_reflectance_at_its_brightest(plugin):
    """k_d for light along the normal, k_s for light from where the highlight is; nowhere more, and never negative."""
    value = plugin(reflectance=(0.6, 0.4, 0.2))
    k, wo = h.table(value.row()), h.unit(0.1, -0.3, 0.9)
    brightest = NORMAL if plugin.is_diffuse else reflect(wo, NORMAL)
    np.testing.assert_allclose(value.illuminate(k, NORMAL, wo, brightest)[:, 0], (0.6, 0.4, 0.2), rtol=1e-9)
    wi = h.directions(1, 5000)
    wi *= np.sign(dot(NORMAL, wi))
    term = value.illuminate(k, NORMAL, wo, wi)
    assert (term >= 0).all()
    assert (term.max(axis=1) <= (0.6, 0.4, 0.2)).all()
