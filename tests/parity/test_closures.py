"""Shaders are those of Cycles: spheres of each in a white furnace show nearly the same albedo for every angle."""

import numpy as np
import pytest

from glanz.tests.parity import closures

NOISE = 0.005
"""Of the mean of a ring, in either direction."""


@pytest.fixture(scope="module")
def furnace(tmp_path_factory):
    import glanz

    glanz.register()
    return closures.rendered(True, tmp_path_factory.mktemp("furnace"))


def test_albedos_are_those_of_cycles(furnace):
    far = {shader.name: round(d, 3) for shader, d in closures.deviations(*furnace).items() if abs(d) > shader.bar + NOISE}
    assert far == {}


def test_an_albedo_that_is_five_percent_off_is_noticed(furnace):
    _, theirs = furnace
    found = closures.deviations(theirs * np.float32(1.05), theirs)
    (diffuse,) = (d for shader, d in found.items() if shader.name == "Diffuse BSDF")
    assert diffuse > closures.SMOOTH
