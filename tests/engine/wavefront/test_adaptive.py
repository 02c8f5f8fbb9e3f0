"""Cells, their colours and their neighbours, piece by piece; the pictures are in tests/renders/test_adaptive.py."""

import numpy as np
import pytest

from glanz.engine import SAMPLERS
from glanz.engine.constants import ONE_MINUS_EPS32
from glanz.engine.wavefront import adaptive
from glanz.engine.wavefront.adaptive import Cells, difference
from glanz.engine.wavefront.numbers import Numbers
from glanz.engine.wavefront.tiles import Pixels, rectangle
from glanz.tests import helpers as h


def every_cell(level, width=3, height=2):
    return Cells(level, *rectangle(0, 0, width << level, height << level))


@pytest.mark.parametrize(
    ("a", "b", "expected"),
    [
        ((0.5, 0.5, 0.5), (0.5, 0.5, 0.5), 0.0),
        ((0, 0, 0), (1, 1, 1), 1.0),
        ((0.25, 0, 0), (0.25, 0.04, 0), 0.2),
        ((0.01, 0, 0), (0.04, 0, 0), 0.1),
        ((4.0, 0, 0), (16.0, 0, 0), 0.5),
        ((1e30, 0, 0), (4e30, 0, 0), 0.5),
        ((-1.0, 0, 0), (0.0, 0, 0), 0.0),
    ],
)
def test_colours_differ_as_displays_show_them(a, b, expected):
    """By the square root of radiance up to white, by the share of the brighter one above."""
    a, b = (np.array(c, np.float64)[:, None] for c in (a, b))
    assert difference(a, b) == pytest.approx(expected, abs=1e-12)
    assert difference(b, a) == difference(a, b)


def test_the_difference_is_at_most_one():
    a, b = np.random.default_rng(1).lognormal(0, 8, (2, 3, 10_000))
    d = difference(a, b)
    assert ((d >= 0) & (d <= 1)).all()


@pytest.mark.parametrize("level", [1, 2, 3, 6])
def test_cells_divide_the_numbers_of_a_pixel(level):
    """Each number goes to its own cell, in float32, and 1 is never reached."""
    cells = every_cell(level)
    for number in (0.0, 0.37, float(ONE_MINUS_EPS32)):
        u2 = cells.spread(np.full((2, 2 * cells.x.size), number, np.float32))
        assert u2.dtype == np.float32
        assert u2.max() < 1
        # The largest number may be rounded into the next cell, but not further.
        corner = np.stack((np.tile(cells.x, 2), np.tile(cells.y, 2))) % 2**level / 2**level
        assert (u2 >= corner).all()
        assert (u2 <= corner + 0.5**level).all()
    assert (cells.px == cells.x // 2**level).all()
    assert (cells.py == cells.y // 2**level).all()


@pytest.mark.parametrize("sampler", SAMPLERS.values(), ids=lambda s: s.key)
def test_every_cell_has_random_numbers_of_its_own(sampler):
    """No key twice among all cells of all levels of some pixels."""
    numbers = Numbers(sampler, 4)
    pixels = Pixels(*rectangle(0, 0, 3, 2))
    keys = [pixels.keys(numbers, 3, 0), *(every_cell(level).keys(numbers, 3, 0) for level in range(1, 5))]
    assert all(key.dtype == np.uint32 for key in keys)
    assert np.unique(np.concatenate(keys)).size == sum(6 * 4**level for level in range(5))


def test_a_part_of_cells_are_those_of_the_window():
    cells = every_cell(2)
    part = cells.part(slice(5, 17))
    numbers = Numbers(SAMPLERS["stratified"], 4)
    assert h.same_bits(part.keys(numbers, 3, 0), cells.keys(numbers, 3, 0)[5:17])
    u2 = np.random.default_rng(2).random((2, cells.x.size), np.float32)
    assert h.same_bits(part.spread(u2[:, 5:17]), cells.spread(u2)[:, 5:17])


def test_the_tree_finds_the_smallest_cell_at_a_place():
    """A pixel of four in one of two; colours tell who was found."""
    tree = adaptive._Tree((4, 7, 2, 1))
    tree.grow(np.array([[10.0, 20.0]] * 4))
    tree.divide(np.array([1]))
    tree.grow(np.array([[21.0, 22.0, 23.0, 24.0]] * 4))
    tree.divide(np.array([2]))
    tree.grow(np.array([[31.0, 32.0, 33.0, 34.0]] * 4))
    x, y = rectangle(16, 28, 8, 4)
    expected = np.array(
        [
            [10, 10, 10, 10, 21, 21, 22, 22],
            [10, 10, 10, 10, 21, 21, 22, 22],
            [10, 10, 10, 10, 31, 32, 24, 24],
            [10, 10, 10, 10, 33, 34, 24, 24],
        ]
    )
    assert tree.colours(2, x, y)[0].reshape(4, 8).tolist() == expected.tolist()
    x, y = rectangle(8, 14, 4, 2)
    assert tree.colours(0, np.array([4, 5]), np.array([7, 7]))[1].tolist() == [10, 20]


def test_parts_count_by_their_area():
    """The mean of cells 1, (2, 3, 4, (5, 6, 7, 8)) of one pixel is that of the leaves by area, and a sum counts all that were."""
    levels = [np.array([[100.0]]), np.array([[1.0, 2, 3, 50]]), np.array([[5.0, 6, 7, 8]])]
    divided = [np.array([0]), np.array([3])]
    assert adaptive._gathered("mean", [v.copy() for v in levels], divided)[0, 0] == (1 + 2 + 3 + 6.5) / 4
    assert adaptive._gathered("sum", [v.copy() for v in levels], divided)[0, 0] == 100 + 56 + 26
    assert adaptive._gathered("first", [v.copy() for v in levels], divided)[0, 0] == 100
