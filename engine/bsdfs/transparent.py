"""Surfaces that light passes straight on, as through a fine grid: a filter, a veil, the clear part of a leaf on a card."""

from dataclasses import dataclass

from . import registry


@registry.add
@dataclass(frozen=True)
class Transparent:
    """The share `transmittance` of light goes straight on, per channel; what is not given to other lobes is absorbed.

    It is met alike from both sides and bends nothing. With alpha a, beside other lobes scaled by a, it is 1 - a.
    """

    key = "transparent"
    label = "Transparent"
    is_specular = True
    is_straight = True
    transmits = True

    transmittance: tuple = (1.0, 1.0, 1.0)

    @classmethod
    def black(cls):
        return cls((0.0, 0.0, 0.0))

    def row(self):
        return {"transmittance": self.transmittance}

    def check(self, owner):
        pass

    @staticmethod
    def albedo(k):
        return k.transmittance

    @staticmethod
    def scatter(k, n, wo, is_front, u1):
        return -wo, k.transmittance

    @staticmethod
    def branches(k, n, wo, is_front):
        return ((-wo, k.transmittance),)
