"""Lobes that are a power of a cosine about an axis: what the BSDFs of the Phong family share, and lights."""

from dataclasses import dataclass

from ..constants import INV_PI
from ..errors import SceneError
from .frames import to_world
from .vectors import cosine_power
from .warps import square_to_cosine_power

LARGEST_EXPONENT = 1e6
"""A lobe 0.1 degrees wide; float32 directions cannot carry a sharper one."""


def check_exponent(subject, exponent):
    """Raises SceneError, saying that `subject` is wrong, for an exponent that no lobe has."""
    if not 0 <= exponent <= LARGEST_EXPONENT:
        raise SceneError(f"{subject} is {exponent}, allowed: 0 to {LARGEST_EXPONENT:g}")


@dataclass(frozen=True)
class Highlight:
    """What glossy BSDFs of a share `reflectance` and a power `exponent` >= 0 of a cosine, large is sharp, have in common."""

    is_specular = False
    transmits = False
    is_diffuse = False
    limits = {"exponent": (0.0, LARGEST_EXPONENT)}

    reflectance: tuple = (0.8, 0.8, 0.8)
    exponent: float = 32.0

    @classmethod
    def black(cls):
        """See `interfaces.Lobe`."""
        return cls((0.0, 0.0, 0.0))

    def row(self):
        """See `interfaces.Lobe`."""
        return {"reflectance": self.reflectance, "exponent": self.exponent}

    @staticmethod
    def albedo(k):
        """See `interfaces.Lobe`."""
        return k.reflectance

    def check(self, owner):
        """See `interfaces.Lobe`."""
        check_exponent(f"material '{owner}': Phong exponent", self.exponent)


def phong_lobe(axis, w, exponent):
    """(n + 2) / (2 pi) cos^n of the angle between unit axis and w (3, N): times a cosine its integral is at most 1."""
    return (exponent + 2) * (0.5 * INV_PI) * cosine_power(axis, w, exponent)


def sample_lobe(axis, u2, exponent):
    """Directions (3, N) about the unit axis (3, N), distributed as `sample_lobe_pdf`."""
    return to_world(axis, square_to_cosine_power(u2, exponent))


def sample_lobe_pdf(axis, w, exponent):
    """(n + 1) / (2 pi) cos^n [sr^-1] of the angle between unit axis and w (3, N), (N,)."""
    return (exponent + 1) * (0.5 * INV_PI) * cosine_power(axis, w, exponent)
