"""Numbers that several files share."""

import math

VERSION = "0.1.0"
PI = math.pi
INV_PI = 1.0 / math.pi
EPS32 = 2.0**-24
"""Half a unit in the last place of float32 at 1: the unit of every geometric error bound."""
ONE_MINUS_EPS32 = 1.0 - 2.0**-24
"""The largest float32 below 1."""
LUMINANCE = (0.2126, 0.7152, 0.0722)
"""Weights of linear Rec. 709 primaries (ITU-R BT.709-6, item 3.2); used only to choose, never to shade."""
