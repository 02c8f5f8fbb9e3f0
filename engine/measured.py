"""How far a picture is from the truth, as one number: told by the standard errors of its pixels."""

import math
from dataclasses import dataclass

import numpy as np

from .scene.settings import ERROR_MEASURES

MEASURED_BY = ("Combined", "Standard Error")
"""The passes that the error of a picture is taken from."""
_LUMINANCE = np.array((0.2126, 0.7152, 0.0722))
"""Of linear Rec. 709 primaries (ITU-R BT.709-6, item 3.2)."""
_DARK = (6 / 29) ** 3
"""The luminance below which lightness is in proportion to it."""


@dataclass(frozen=True, slots=True, eq=False)
class Found:
    """What is known of P pixels.

    samples   (P,) int, how many each has
    squares   (P,) their squared errors, as they count for the measure
    radiance  the sum of their radiances, means of channels [W m^-2 sr^-1]
    """

    samples: np.ndarray
    squares: np.ndarray
    radiance: float

    @classmethod
    def of(cls, values, samples, measure):
        """Of pixels {pass: (C, P)} that have so many `samples`; `measure` is one of `MEASURES`."""
        radiance, errors = (values[key][:3].astype(np.float64) for key in MEASURED_BY)
        return cls(samples, MEASURES[measure].squares(radiance, errors), float(radiance.mean(axis=0).sum()))


def picture_error(found, measure):
    """The error of a picture from what is `Found` of all its tiles: an unbiased guess of the RMSE that it has by the `measure`."""
    count = sum(part.samples.size for part in found)
    square, radiance = sum(part.squares.sum() for part in found) / count, sum(part.radiance for part in found) / count
    unit = abs(MEASURES[measure].unit(radiance))
    # Black without a doubt is without error.
    return math.sqrt(square) / unit if square and unit else math.inf if square else 0.0


def scatter(found):
    """By what share the RMSE that a picture really has differs from its `picture_error`: a standard deviation.

    Errors of pixels are independent, and their squares vary by twice their own square each (those of normal errors, whose channels err
    together): it falls with the root of the number of pixels that have most of the error.
    """
    square = sum(part.squares.sum() for part in found)
    return math.sqrt(0.5 * sum(np.square(part.squares).sum() for part in found)) / square if 0 < square < math.inf else 0.0


class Relative:
    """The error of radiance relative to the mean radiance of the picture: the relative RMSE of all pixels and channels."""

    @staticmethod
    def squares(radiance, errors):
        """(P,) of radiances and their standard errors, (3, P)."""
        return np.square(errors).mean(axis=0)

    @staticmethod
    def unit(radiance):
        """What an error is divided by, for a mean radiance of the picture."""
        return radiance


class Lightness:
    """The error of CIE lightness L*, as a share of that of white, which is radiance 1: what eyes see of noise in dark and in bright.

    Of pixels that are displayed as they are; an exposure of the view is not known here. 0.01 is one of the 100 steps from black to
    white, about the least that is seen side by side. To first order in the errors, whose channels are taken to err together, as those
    of light of one colour do: if they do not, the error is less.
    """

    @staticmethod
    def squares(radiance, errors):
        """(P,) of radiances and their standard errors, (3, P), by the slope of L* over luminance (ISO/CIE 11664-4:2019, eq. 1 and 4)."""
        slope = 1.16 / 3 * np.maximum(_LUMINANCE @ radiance, _DARK) ** (-2 / 3)
        return np.square(slope * (_LUMINANCE @ errors))

    @staticmethod
    def unit(radiance):
        """It is a share already."""
        return 1.0


MEASURES = dict(zip(ERROR_MEASURES, (Relative, Lightness), strict=True))
