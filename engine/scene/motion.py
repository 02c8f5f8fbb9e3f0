"""Motion as keys: where a thing is at equally spaced times from the opening of the shutter to its closing."""

import numpy as np

from ..arrays import frozen
from ..errors import SceneError
from ..maths.poses import Keys


def no_motion():
    """The keys of what stands still, (0, 4, 4)."""
    return np.zeros((0, 4, 4))


def settle(thing, kind, name):
    """Check the `motion` of `thing`, and set its matrix `name` to that of the middle of the shutter.

    Keys that are all the same are no motion: they are dropped, so that nobody pays for them. What is not finite stays, and is
    found when the scene is checked. Raises SceneError, with the `kind` of thing, where there is no list of matrices.
    """
    try:
        motion = frozen(thing.motion, np.float64, (None, 4, 4), f"{kind} '{thing.name}'", "motion")
    except ValueError as error:
        raise SceneError(str(error)) from None
    if len(motion):
        moves = (motion != motion[0]).any()
        middle = Keys.of(motion).matrix(0.5) if moves and np.isfinite(motion).all() else motion[0]
        object.__setattr__(thing, name, frozen(middle, np.float64, (4, 4), kind, name))
        motion = motion if moves else no_motion()
    object.__setattr__(thing, "motion", motion)
