"""Bodies with something inside that are carried about while the shutter is open."""

import numpy as np
import pytest

from glanz.engine import Dielectric
from glanz.tests import helpers as h
from glanz.tests.moving import moving, shifted, turned
from glanz.tests.renders.test_media import FLOOR, GROWN, body, incoherent, layered, no_roulette, seen

__all__ = ["no_roulette"]


@pytest.mark.parametrize("glass", [-1, 0, 1])
def test_bodies_that_touch_and_move_together_pass_the_same(glass):
    """A glass that is carried about with its water in it: they touch all the time."""
    keys = turned((-0.2, 0.3)) @ shifted((-1, 0.5, 0), (1.2, -0.4, 0))
    things = [(0, 1, 0.3), (1, 2, 1.0), (2, 3, 0.3)]
    absorbing = [moving(body(*z, a, glass * (a < 1), name=f"{z}"), keys) for *z, a in things]
    for order in (1, -1):
        assert seen([*absorbing[::order], FLOOR], samples=16) == pytest.approx(np.exp(-1.6), rel=GROWN)
    water = moving(body(1, 2, lobe=Dielectric(1.33), name="water"), keys)
    wall = [moving(body(*z, 0, glass, lobe=Dielectric(2.4), name=f"{z}"), keys) for z in ((0, 1), (2, 3))]
    assert h.mean_is(layered([*wall, water, FLOOR]), incoherent(1, 2.4, 1.33, 2.4, 1), floor=1e-5)


def test_moving_together_catches_bodies_that_are_left_as_they_are(monkeypatch):
    """They do not grow, and faces that coincide are met once."""
    monkeypatch.setattr("glanz.engine.world.compile.moved_apart", lambda vertices, *others: vertices)
    with pytest.raises(AssertionError):
        test_bodies_that_touch_and_move_together_pass_the_same(1)
