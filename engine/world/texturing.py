"""Textures looked up at surface points."""

from dataclasses import dataclass

import numpy as np

from ..maths.vectors import cross, dot, length
from ..scene.points import Points

_LONGEST = 2.0**10
"""How much longer than wide footprints may be: grazing rays see the mean of what they pass anyway."""


class TexturePoints(Points):
    """N points on triangles, where textures are evaluated.

    attributes    {key: `Attribute`} of the world
    prim, u, v    (N,) triangles and barycentric coordinates
    across        None, or the half-axes of footprints in barycentric coordinates: two (2, N)
    """

    def __init__(self, attributes, prim, u, v, across=None):
        super().__init__()
        self.attributes, self.prim, self.u, self.v, self.across = attributes, prim, u, v, across

    @property
    def count(self):
        """N."""
        return self.prim.size

    def take(self, lanes):
        """The points `lanes` (M,)."""
        across = self.across and tuple(axis.take(lanes, axis=1) for axis in self.across)
        return TexturePoints(self.attributes, self.prim.take(lanes), self.u.take(lanes), self.v.take(lanes), across)

    def moved(self, du, dv):
        """The points at du, dv (N,) from these in barycentric coordinates; they may be beyond the edges of their triangles."""
        return TexturePoints(self.attributes, self.prim, self.u + du, self.v + dv, self.across)

    def beside(self, axis):
        """The points moved by half-axis 0 or 1 of their footprints."""
        return self.moved(*self.across[axis])

    def attribute(self, key):
        """An attribute at the points, see `Attribute.at`."""
        return self.once(key, lambda: self.attributes[key].at(self.prim, self.u, self.v))


def footprints(e1, e2, wo, width):
    """Half-axes, two (2, N), of what cones of `width` (N,) cut out of triangles with edges e1, e2, in barycentric coordinates.

    The cone's circle is stretched by 1 / cos along its direction (Akenine-Moller et al. 2021, "Improved Shader and Texture
    Level of Detail Using Ray Cones", section 5).
    """
    n = cross(e1, e2)
    n /= np.maximum(length(n), np.finfo(np.float32).tiny)
    cos = dot(n, wo)
    along = wo - cos * n
    sin = length(along)
    # Seen from above all directions are alike, but one is needed.
    along = np.where(sin > 0, along, e1)
    along /= np.maximum(length(along), np.finfo(np.float32).tiny)
    radius = np.float32(0.5) * width
    long = along * (radius / np.maximum(np.abs(cos), np.float32(1 / _LONGEST)))
    return tuple(barycentric(a, e1, e2, n) for a in (long, cross(n, along) * radius))


def barycentric(a, e1, e2, n):
    """Vectors a (3, N) in the plane of triangles with edges e1, e2 and normals n, as shares (2, N) of the edges."""
    area = dot(cross(e1, e2), n)
    # What is too small for its area to be a number has no parts either.
    area = np.where(np.abs(area) >= np.finfo(np.float32).tiny, area, np.inf)
    return np.stack((dot(cross(a, e2), n), dot(cross(e1, a), n))) / area


def clean(value):
    """What a texture gives as a share of light: what is below 0 or no number counts as 0."""
    return np.where((value > 0) & (value < np.inf), value, np.float32(0))


class EvenGlow:
    """No emitter is textured."""

    def seen(self, L, points):
        """Radiance L (3, N) of emitters at `TexturePoints`, as it is there."""
        return L

    def lit(self, E, k, p, wi, distance):
        """Irradiance E (3, N) at p from a point of each light, in the directions wi (3, N), as it is from there; `k` are its rows."""
        return E


EVEN = EvenGlow()


@dataclass(frozen=True, slots=True, eq=False)
class TexturedGlow:
    """What textured emitters shine with, where the tables say 1.

    textures    {row of the materials: emission}
    material    (F,) rows of all triangles
    attributes  {key: `Attribute`}
    """

    textures: dict
    material: np.ndarray
    attributes: dict

    def seen(self, L, points):
        """See `EvenGlow.seen`."""
        result = L.copy()
        material = self.material.take(points.prim)
        for row, texture in self.textures.items():
            lanes = np.nonzero(material == row)[0]
            if lanes.size:
                result[:, lanes] *= clean(points.take(lanes).value(texture))
        return result

    def lit(self, E, k, p, wi, distance):
        """See `EvenGlow.lit`; `k` are columns of `maths.patches`, and the triangle `prim` of each."""
        u, v = np.clip(barycentric(p + wi * distance - k.v0, k.e1, k.e2, k.normal), 0, 1)
        return self.seen(E, TexturePoints(self.attributes, np.broadcast_to(k.prim, u.shape), u, v))
