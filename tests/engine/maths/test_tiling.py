"""Tiles around the origin are those of polygons: distances to sides, arcs in corners, lengths along the outline."""

import numpy as np
import pytest

from glanz.engine.maths.tiling import segment_number, tiles

ANGLES = (np.linspace(0, 2 * np.pi, 4001)[:-1] + 1e-4).astype(np.float32)


def around(sides, roundness, distance=1.0, is_normalized=False):
    one = np.ones(1, np.float32)
    x, y = distance * np.cos(ANGLES), distance * np.sin(ANGLES)
    return tiles(x.astype(np.float32), y.astype(np.float32), sides * one, roundness * one, is_normalized)


@pytest.mark.parametrize("sides", [3, 4, 7])
def test_a_sharp_polygon_has_its_sides_at_the_distance_1(sides):
    middles = (np.arange(sides) + 0.5) * 2 * np.pi / sides
    expected = (np.cos(ANGLES) * np.cos(middles)[:, None] + np.sin(ANGLES) * np.sin(middles)[:, None]).max(axis=0)
    found = around(sides, 0.0)
    np.testing.assert_allclose(found.v + 1, expected, atol=1e-5)
    np.testing.assert_allclose(found.u**2 + (found.v + 1) ** 2, 1, atol=1e-5)
    np.testing.assert_allclose(found.width, np.tan(np.pi / sides), rtol=1e-5)


@pytest.mark.parametrize(("sides", "roundness"), [(3.0, 0.3), (5.0, 0.7), (2.6, 0.5), (4.4, 0.2)])
def test_a_rounded_outline_is_that_of_a_polygon_eroded_and_grown_again(sides, roundness):
    """All points of the outline v = 0 are as far as the arcs' radius from the polygon that is smaller by it, its sides moved inwards."""
    scale = 1 / (around(sides, roundness).v + 1)
    x, y = scale * np.cos(ANGLES), scale * np.sin(ANGLES)
    half = np.pi / sides
    corners = 2 * half * np.arange(np.ceil(sides))
    inner = (1 - roundness) / np.cos(half) * np.stack((np.cos(corners), np.sin(corners)))
    if sides == int(sides):
        following = np.roll(inner, -1, axis=1)
        along = (following - inner)[:, :, None]
        t = ((np.stack((x, y))[:, None] - inner[:, :, None]) * along).sum(axis=0) / (along**2).sum(axis=0)
        gap = np.stack((x, y))[:, None] - inner[:, :, None] - np.clip(t, 0, 1) * along
        np.testing.assert_allclose(np.sqrt((gap**2).sum(axis=0)).min(axis=0), roundness, atol=1e-4)
    else:
        # Smooth: the outline turns nowhere by more than the arcs of the smallest radius would let it.
        step = np.unwrap(np.arctan2(np.diff(y), np.diff(x)))
        assert np.abs(np.diff(step)).max() <= 0.05


@pytest.mark.parametrize("sides", [3.0, 4.6, 9.0])
@pytest.mark.parametrize("roundness", [0.0, 0.5, 1.0])
def test_every_segment_goes_from_0_to_1(sides, roundness):
    found = around(sides, roundness, 0.8, is_normalized=True)
    number = segment_number(np.cos(ANGLES), np.sin(ANGLES), np.float32([sides]))
    assert set(number) == set(range(int(np.ceil(sides))))
    for k in set(number):
        u = found.u[number == k]
        # A sixty-fourth of a segment is left at either end by angles that stop short of it.
        assert u[0] <= 1 / 64 and u[-1] >= 1 - 1 / 64 and (np.diff(u) > 0).all()
    assert (np.diff(found.rotation) >= -1e-5).all()


def test_a_circle_has_arcs_for_sides():
    found = around(6.0, 1.0, 2.0)
    np.testing.assert_allclose(found.v, 1, atol=1e-5)
    np.testing.assert_allclose(found.u, np.remainder(ANGLES, np.pi / 3) - np.pi / 6, atol=1e-5)


def test_at_the_origin_is_the_middle():
    zero, sides = np.zeros(1, np.float32), np.full(1, 5, np.float32)
    assert tiles(zero, zero, sides, zero, True)[:2] == (0.5, 0.0)
    assert tiles(zero, zero, sides, zero, False)[:2] == (0.0, -1.0)
