"""Values that fit together in no way are refused by the name of their owner, before anything is computed with them."""

import math

import numpy as np
import pytest

from glanz.engine import CheckerTexture, SceneError
from glanz.engine.scene.mist import Mist
from glanz.engine.scene.shade import Shade
from glanz.tests import helpers as h

BAD = {
    "mist that begins nowhere": (lambda: Mist(start=math.nan).check("world 'Fog'"), "world 'Fog': its mist is from nan m"),
    "mist that goes back": (lambda: Mist(depth=-1.0).check("world 'Fog'"), r"over -1\.0 m, allowed: finite numbers"),
    "mist without end": (lambda: Mist(depth=math.inf).check("world 'Fog'"), "over inf m"),
    "mist of an unknown kind": (lambda: Mist(falloff="cubic").check("world 'Fog'"), "falloff of its mist is 'cubic', allowed: "),
    "a shade that is none": (lambda: Shade(texture=1.0).check("light 'Key'"), r"light 'Key': its shade is 1\.0, allowed: a texture"),
    "a shade without a frame": (
        lambda: Shade(texture=CheckerTexture(), world_from_light=np.full((4, 4), np.nan)).check("light 'Key'"),
        "light 'Key': the frame of its shade",
    ),
    "another shape beside": (
        lambda: h.replaced(h.box(), beside=np.zeros((2, 3, 7))),
        r"mesh 'box': beside has shape \(2, 3, 7\), expected",
    ),
    "generated coordinates of another mesh": (
        lambda: h.replaced(h.box(), generated=np.zeros((3, 7))),
        "mesh 'box': generated must have one",
    ),
    "coordinates of some triangles": (
        lambda: h.replaced(h.box(), uv_layers=("a",), uvs=np.zeros((1, 2, 3)), uv_indices=np.zeros((3, 5), int)),
        "mesh 'box': uv_indices must have one entry for each of 12",
    ),
}


@pytest.mark.parametrize("name", BAD)
def test_what_does_not_fit_is_refused_by_name(name):
    value, message = BAD[name]
    with pytest.raises(SceneError, match=message):
        value()


def test_what_fits_is_not():
    Mist().check("world 'Fog'")
    Shade(texture=CheckerTexture()).check("light 'Key'")
    h.replaced(h.box(), generated=np.zeros((3, 8)), beside=np.zeros((2, 3, 8)))
