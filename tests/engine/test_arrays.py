"""Columns and frozen arrays."""

import numpy as np
import pytest

from glanz.engine.arrays import Columns, columns, frozen
from glanz.engine.registry import BSDFS
from glanz.engine.wavefront import cones, light_path

ROWS = [{"size": 1.0, "colour": (1, 2, 3)}, {"size": 2.0, "colour": (4, 5, 6)}]


def test_rows_become_columns_whose_last_axis_counts_them():
    table = columns(ROWS)
    assert table.size.tolist() == [1, 2]
    assert table.colour.tolist() == [[1, 4], [2, 5], [3, 6]]
    assert table.colour.dtype == np.float32
    assert table.colour.flags.c_contiguous
    assert columns(ROWS, np.float64).size.dtype == np.float64


def test_rows_are_taken_as_often_as_asked():
    taken = columns(ROWS).take(np.array([1, 1, 0]))
    assert taken.size.tolist() == [2, 2, 1]
    assert taken.colour.shape == (3, 3)


def test_no_rows_are_an_empty_table():
    assert vars(columns([])) == {}


def test_numbers_beyond_float32_become_infinite_without_a_warning():
    assert np.isinf(columns([{"power": 1e300}]).power[0])


@pytest.mark.parametrize("array", [[[1, 2], [3]], "text", [[object()]], [[1j]]], ids=["ragged", "text", "object", "complex"])
def test_what_is_no_array_of_numbers_is_refused_by_name(array):
    with pytest.raises(ValueError, match="mesh 'm': points"):
        frozen(array, np.float32, (None, None), "mesh 'm'", "points")


def test_a_frozen_array_cannot_be_written_but_its_source_can():
    source = np.zeros((3, 2), np.float32)
    array = frozen(source, np.float32, (3, None), "mesh 'm'", "points")
    assert not array.flags.writeable
    assert source.flags.writeable


def test_one_row_stands_for_all():
    one, two = columns(ROWS[:1]), columns(ROWS)
    lanes = np.array([1, 0, 1])
    assert one.pick(np.zeros(3, np.intp)) is one
    assert two.pick(lanes).size.tolist() == [2, 1, 2]
    repeated = one.repeated(3)
    assert repeated.colour.shape == (3, 3)
    repeated.size[0] = 7
    assert repeated.size.tolist() == [7, 1, 1]
    assert one.size.tolist() == [1]


def test_no_parameter_is_called_as_a_method_of_tables():
    """It would hide the method, and where it is missing the method would be taken for it."""
    assert not {name for plugin in BSDFS.values() for name in plugin().row()} & set(dir(Columns))
    assert not {name for carried in (cones.CARRIED, light_path.CARRIED) for name, _ in carried} & set(dir(Columns))
