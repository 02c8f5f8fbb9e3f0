"""The perfect mirror."""

from dataclasses import dataclass

from ..maths.vectors import reflect
from . import registry


@registry.add
@dataclass(frozen=True)
class Mirror:
    """Light leaves in the mirror direction, and nowhere else; `reflectance` k_r is the share that does."""

    key = "mirror"
    label = "Mirror"
    is_specular = True
    transmits = False

    reflectance: tuple = (1.0, 1.0, 1.0)

    @classmethod
    def black(cls):
        return cls((0.0, 0.0, 0.0))

    def row(self):
        return {"reflectance": self.reflectance}

    def check(self, owner):
        pass

    @staticmethod
    def albedo(k):
        return k.reflectance

    @staticmethod
    def scatter(k, n, wo, is_front, u1):
        return reflect(wo, n), k.reflectance

    @staticmethod
    def branches(k, n, wo, is_front):
        return ((reflect(wo, n), k.reflectance),)
