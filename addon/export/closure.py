"""What shader nodes mean to the engine: weighted lobes and emission, as values that can be added and scaled."""

from dataclasses import dataclass, field, replace

import numpy as np

from ...engine import Lambert, Phong

SHARPEST_EXPONENT = 1e6
"""The engine's sharpest Phong lobe, 0.1 degrees wide: the nearest that it comes to a mirror."""


@dataclass(frozen=True, eq=False)
class Closure:
    """The sum of `lobes` (BSDF values) plus `emission` (3,) [W m^-2 sr^-1]; `is_clear` says that light goes straight through."""

    lobes: tuple = ()
    emission: np.ndarray = field(default_factory=lambda: np.zeros(3))
    is_clear: bool = False

    def __add__(self, other):
        return Closure(self.lobes + other.lobes, self.emission + other.emission, self.is_clear and other.is_clear)

    def scaled(self, factor):
        """Everything times `factor`, a number or (3,)."""
        return replace(self, lobes=tuple(scaled_lobe(lobe, factor) for lobe in self.lobes), emission=self.emission * factor)

    def albedo(self):
        """Share of light reflected by all lobes together, (3,)."""
        return sum((np.array(lobe.albedo(), np.float64) for lobe in self.lobes), np.zeros(3))


def scaled_lobe(lobe, factor):
    """`lobe` with its reflectance times `factor`."""
    return replace(lobe, reflectance=tuple(float(c) for c in np.multiply(lobe.reflectance, factor)))


def merged(lobes):
    """The fewest lobes with the same sum: equal shapes added up, black ones left out."""
    sums = {}
    for lobe in lobes:
        shape = replace(lobe, reflectance=(0.0, 0.0, 0.0))
        sums[shape] = sums.get(shape, np.zeros(3)) + lobe.reflectance
    return tuple(replace(shape, reflectance=tuple(float(c) for c in total)) for shape, total in sums.items() if total.any())


def phong_exponent(roughness):
    """The Phong exponent n = 2 / alpha^2 - 2 with alpha = roughness^2, from mirror-like 0 to uniform 1 of Blender's roughness."""
    alpha2 = min(max(roughness, 0.0), 1.0) ** 4
    return min(2 / alpha2 - 2, SHARPEST_EXPONENT) if alpha2 > 0 else SHARPEST_EXPONENT


def diffuse(colour):
    """Ideal diffuse reflection of `colour` (r, g, b)."""
    return Closure((Lambert(tuple(colour)),))


def glossy(colour, roughness):
    """A glossy lobe of `colour` (r, g, b)."""
    return Closure((Phong(tuple(colour), phong_exponent(roughness)),))


def emission(colour, strength):
    """Radiance colour * strength [W m^-2 sr^-1]."""
    return Closure(emission=np.array(colour, np.float64) * strength)


def mix(factor, first, second):
    """The share 1 - factor of `first` and factor of `second`."""
    factor = min(max(factor, 0.0), 1.0)
    return first.scaled(1 - factor) + second.scaled(factor)
