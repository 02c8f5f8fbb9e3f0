"""What shader nodes mean to the engine: weighted lobes and emission, as values that can be added and scaled."""

from dataclasses import dataclass, replace

import numpy as np

from ...engine import (
    GgxAlbedo,
    LambertTransmission,
    RelativeIndex,
    Transparent,
    albedo_of,
    textures_of,
)
from .colours import WHITE, added, as_texture, cut, inverted, times, varies
from .principled import boundary, diffused, is_smooth, reflected, refracted


@dataclass(frozen=True, eq=False)
class Closure:
    """The sum of `lobes` (BSDF values) plus `emission` [W m^-2 sr^-1], and the share that is a `holdout`.

    Colours are constants or textures, see `colours`. `reliefs` are the different reliefs, each a tuple, of its shaders.
    """

    lobes: tuple = ()
    emission: object = (0.0, 0.0, 0.0)
    reliefs: tuple = ()
    holdout: object = (0.0, 0.0, 0.0)

    def __add__(self, other):
        return Closure(
            # Merged at once: shaders that are mixed with themselves again and again would double each time.
            merged(self.lobes + other.lobes),
            added(self.emission, other.emission),
            tuple(dict.fromkeys(self.reliefs + other.reliefs)),
            added(self.holdout, other.holdout),
        )

    def scaled(self, factor):
        """Everything times `factor`, a number, a colour or a texture."""
        return replace(
            self,
            lobes=tuple(scaled_lobe(lobe, factor) for lobe in self.lobes),
            emission=times(self.emission, factor),
            holdout=times(self.holdout, factor),
        )

    def albedo(self):
        """Share of light that goes on by all lobes without textures, (3,); of the others the engine takes care."""
        return sum((np.array(albedo_of(lobe)) for lobe in self.lobes if not textures_of(lobe)), np.zeros(3))


def scaled_lobe(lobe, factor):
    """`lobe` with its colours times `factor`."""
    return with_colours(lobe, (times(colour, factor) for colour in colours_of(lobe)))


def colours_of(lobe):
    """The colours of `lobe`, each (r, g, b), that scale what it sends on."""
    return [getattr(lobe, name) for name in ("reflectance", "transmittance") if hasattr(lobe, name)]


def with_colours(lobe, colours):
    """`lobe` with other `colours`, in the same order."""
    names = [name for name in ("reflectance", "transmittance") if hasattr(lobe, name)]
    return replace(lobe, **dict(zip(names, colours, strict=True)))


def merged(lobes):
    """The fewest lobes with the same sum: equal shapes added up, black ones left out."""
    sums = {}
    for lobe in lobes:
        colours = colours_of(lobe)
        black = [(0.0, 0.0, 0.0)] * len(colours)
        shape = with_colours(lobe, black)
        sums[shape] = [added(a, b) for a, b in zip(sums.get(shape, black), colours)]
    return tuple(with_colours(shape, total) for shape, total in sums.items() if any(varies(c) or any(c) for c in total))


def diffuse(colour, roughness=0.0):
    """Diffuse reflection of `colour`, ideal unless there is a `roughness`."""
    return Closure((diffused(as_texture(colour), roughness, colour),))


def translucent(colour):
    """Ideal diffuse transmission of `colour`."""
    return Closure((LambertTransmission(as_texture(colour)),))


def glossy(colour, roughness, preserves=True):
    """A rough mirror of `colour`; what is reflected twice is lost unless it `preserves` energy."""
    if is_smooth(roughness):
        return Closure((reflected(as_texture(colour), roughness),))
    return Closure((reflected(GgxAlbedo(roughness, f0=as_texture(colour), kind="mirror", preserves=preserves), roughness),))


def metal(base, tint, roughness, preserves=True):
    """A rough metal that reflects `base` when seen from above, and `tint` at 82 degrees."""
    return Closure((reflected(GgxAlbedo(roughness, f0=cut(base), tint=cut(tint), preserves=preserves), roughness),))


def conductor(ior, extinction, roughness, preserves=True):
    """A rough metal of the complex index of refraction ior + i extinction."""
    albedo = GgxAlbedo(roughness, as_texture(ior), extinction=as_texture(extinction), kind="conductor", preserves=preserves)
    return Closure((reflected(albedo, roughness),))


def glass(colour, ior, roughness=0.0, preserves=True):
    """A boundary that tints what it reflects and what passes it by `colour`; see `boundary`."""
    return Closure(boundary(as_texture(colour), as_texture(colour), roughness, ior, preserves=preserves))


def refraction(colour, ior, roughness):
    """The same, which reflects nothing."""
    eta = RelativeIndex(ior)
    return Closure((refracted(as_texture(colour), roughness, eta),))


def transparent(colour):
    """A surface that the share `colour` (r, g, b) of light passes straight on."""
    return Closure((Transparent(as_texture(colour)),))


def emission(colour, strength):
    """Radiance colour * strength [W m^-2 sr^-1]."""
    return Closure(emission=times(colour, strength))


def mix(factor, first, second):
    """The share 1 - factor of `first` and factor of `second`; the factor is a number or a texture."""
    factor = cut(factor)
    return first.scaled(inverted(factor)) + second.scaled(factor)


def with_alpha(alpha, closure):
    """`closure` where the surface is, with probability `alpha`; light goes straight on where it is not."""
    return mix(alpha, transparent(WHITE), closure)
