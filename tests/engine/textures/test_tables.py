"""The tables of ramps and curves are kept by scene files, whatever their length."""

import numpy as np
import pytest

from glanz.engine import ColourRamp, Curves, Material, Settings, read_scene, write_scene
from glanz.tests import helpers as h

TABLE = np.random.default_rng(3).random((3, 33)).astype(np.float32)


@pytest.mark.parametrize("value", [ColourRamp(table=TABLE), Curves(table=TABLE[:1])])
def test_tables_of_any_length_come_back_from_files(value, tmp_path):
    thing = h.thing(h.quad(), Material(name="m", emission=value))
    write_scene(tmp_path / "a", h.scene([thing]), Settings())
    back = read_scene(tmp_path / "a")[0].objects[0].materials[0].emission
    assert h.same_bits(back.table, value.table)
