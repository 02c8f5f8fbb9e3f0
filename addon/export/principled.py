"""The Principled BSDF as lobes whose shares are those of Blender's layers, seen from wherever a ray looks.

From the top: sheen, coat, emission, then metal (share m) beside what is no metal: glass (share t of the rest), or a dielectric
over a diffuse base. Each layer reflects its directional albedo E, that of GGX (`GgxAlbedo`), and what lies below has the rest:

    coat      w E_coat,                then w <- w (1 - E_coat)
    metal     w m E_F82(base)
    glass     w (1 - m) t, of which V is reflected and (1 - V) sqrt(base) passes
    glossy    w (1 - m) (1 - t) E
    diffuse   w (1 - m) (1 - t) (1 - E) base            Oren-Nayar's, where it is rough

So no more leaves than arrives, whatever the angle. The lobes are `Gloss` and `RoughRefraction`, as wide as GGX's, see
`engine.maths.ggx`; where the roughness is so small that the sharpest is too wide, the mirror and the exact dielectric.
They know from where they are seen, but not from where they are lit, so they are not reciprocal.
"""

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...engine import (
    Dielectric,
    GgxAlbedo,
    GlassTint,
    Gloss,
    Lambert,
    LobeExponent,
    Mirror,
    OrenNayar,
    RelativeIndex,
    RoughRefraction,
    SheenAlbedo,
    folded,
)
from .colours import BLACK, WHITE, added, as_texture, cut, inverted, root, times, varies

SMOOTHEST = 0.024
"""Blender's roughness below which a lobe would be sharper than the engine's sharpest, 0.1 degrees wide."""
_KEEPS_ENERGY = bpy.app.version >= (4, 3)
"""Whether Blender's rough diffuse surfaces reflect several times, as 5.0 and 5.2 do; 4.2 does not."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Layers:
    """The inputs of a Principled BSDF, which may be textures."""

    base: object = (0.8, 0.8, 0.8)
    metallic: object = 0.0
    roughness: object = 0.5
    ior: object = 1.5
    specular_level: object = 0.5
    tint: object = WHITE
    transmission: object = 0.0
    coat: object = 0.0
    coat_roughness: object = 0.03
    coat_ior: object = 1.5
    coat_tint: object = WHITE
    sheen: object = 0.0
    sheen_tint: object = WHITE
    sheen_roughness: object = 0.5
    diffuse_roughness: object = 0.0

    def lobes(self):
        """(lobes, what is left, a colour or texture, of light that is emitted below sheen and coat)."""
        lobes, left = [], WHITE
        if _is_there(self.sheen):
            # Next to the fibres' own lobe: it is brightest at the rim, and diffuse.
            sheen = fibres(times(cut(self.sheen), cut(self.sheen_tint)), self.sheen_roughness)
            lobes.append(Lambert(sheen))
            left = times(left, inverted(sheen))
        if _is_there(self.coat):
            weight = cut(self.coat)
            albedo = GgxAlbedo(self.coat_roughness, self.coat_ior, kind="dielectric")
            lobes.append(reflected(times(left, times(weight, albedo)), self.coat_roughness))
            tinted = added(inverted(weight), times(weight, cut(self.coat_tint)))
            left = times(times(left, inverted(times(weight, albedo))), tinted)
        return (*lobes, *self._below(left)), left

    def _below(self, left):
        m, t = cut(self.metallic), cut(self.transmission)
        base = as_texture(self.base) if varies(self.base) else cut(self.base)
        if _is_there(m):
            albedo = GgxAlbedo(self.roughness, f0=base, tint=self.tint, kind="metal")
            yield reflected(times(times(left, m), albedo), self.roughness)
        left = times(left, inverted(m))
        if _is_there(t):
            clear = times(left, t)
            yield from boundary(WHITE, root(base), self.roughness, self.ior, clear)
        left = times(left, inverted(t))
        if not _is_there(left):
            return
        if _is_there(self.specular_level) and self.ior != 1:
            coat = GgxAlbedo(self.roughness, self.ior, tint=self.tint, level=self.specular_level, kind="dielectric")
            yield reflected(times(left, coat), self.roughness)
            is_white = not varies(self.tint) and tuple(self.tint) == WHITE
            left = times(left, inverted(coat) if is_white else replace(coat, is_rest=True))
        yield diffused(times(left, base), self.diffuse_roughness, base)


def diffused(colour, roughness, again):
    """A diffuse lobe of `colour`; what a rough surface reflects several times is tinted by `again`."""
    roughness = cut(roughness)
    if not varies(roughness) and roughness == 0:
        return Lambert(colour)
    return OrenNayar(colour, roughness, cut(again) if _KEEPS_ENERGY else BLACK)


def reflected(colour, roughness):
    """A glossy lobe of `colour`, all that it reflects, for Blender's `roughness`."""
    return Mirror(colour) if is_smooth(roughness) else Gloss(colour, folded(LobeExponent(roughness)))


def boundary(reflectance, transmittance, roughness, ior, weight=WHITE, preserves=True):
    """The lobes of glass, times `weight`, which tint what they reflect and what passes; two, unless it is smooth.

    What is scattered several times is lost unless it `preserves` energy.
    """
    if is_smooth(roughness):
        return (Dielectric(ior, times(weight, reflectance), times(weight, transmittance)),)
    eta = RelativeIndex(ior)
    share = GgxAlbedo(roughness, eta, kind="boundary")
    is_white = not varies(transmittance) and np.all(np.equal(transmittance, 1))
    if not (is_white and preserves):
        weight = times(weight, GlassTint(transmittance, roughness, eta, preserves))
    return (
        reflected(times(times(weight, reflectance), share), roughness),
        refracted(times(times(weight, transmittance), inverted(share)), roughness, eta),
    )


def refracted(colour, roughness, eta):
    """A lobe of `colour`, all that it lets pass, for Blender's `roughness`, where eta is the relative index."""
    return RoughRefraction(colour, LobeExponent(roughness, eta), eta)


def is_smooth(roughness):
    """Whether Blender's `roughness` is that of a mirror."""
    return not varies(roughness) and roughness < SMOOTHEST


def _is_there(value):
    return varies(value) or (any(value) if isinstance(value, tuple) else value > 0)


def fibres(colour, roughness, kind="microfiber"):
    """What sheen of `colour` reflects towards the viewer: as fibres that stand upright do, most at the rim."""
    return times(cut(colour), SheenAlbedo(roughness, kind))
