"""Textures looked up at surface points."""

from dataclasses import dataclass, field

import numpy as np

from ..maths.vectors import cross, dot, length

_LONGEST = 2.0**10
"""How much longer than wide footprints may be: grazing rays see the mean of what they pass anyway."""


@dataclass(frozen=True, slots=True, eq=False)
class TexturePoints:
    """N points on triangles, where textures are evaluated: what they are handed as `at`.

    attributes    {key: `Attribute`} of the world
    prim, u, v    (N,) triangles and barycentric coordinates
    across        None, or the half-axes of footprints in barycentric coordinates: two (2, N)
    Each coordinate system and each texture is worked out once.
    """

    attributes: dict
    prim: np.ndarray
    u: np.ndarray
    v: np.ndarray
    across: tuple = None
    _known: dict = field(default_factory=dict)

    def take(self, lanes):
        """The points `lanes` (M,)."""
        across = self.across and tuple(axis.take(lanes, axis=1) for axis in self.across)
        return TexturePoints(self.attributes, self.prim.take(lanes), self.u.take(lanes), self.v.take(lanes), across)

    def look_up(self, coordinates):
        """The points (3, N) in `coordinates`, and None or the half-axes of their footprints, two (3, N)."""
        if coordinates not in self._known:
            p, along_u, along_v = self.attribute(coordinates.attribute)
            axes = self.across and tuple(_affine(coordinates.matrix, a * along_u + b * along_v, 0) for a, b in self.across)
            self._known[coordinates] = _affine(coordinates.matrix, p, 1), axes
        return self._known[coordinates]

    def value(self, texture):
        """What `texture` is at the points, (3, N) or (3, 1)."""
        # By identity: the same texture often stands for several parameters.
        if id(texture) not in self._known:
            self._known[id(texture)] = texture.eval(self)
        return self._known[id(texture)]

    def attribute(self, key):
        """An attribute at the points, see `Attribute.at`."""
        if key not in self._known:
            self._known[key] = self.attributes[key].at(self.prim, self.u, self.v)
        return self._known[key]


def _affine(matrix, p, w):
    """The rows of `matrix` times (p, w). Term by term, as what a product of matrices rounds depends on the number of lanes."""
    result = np.empty_like(p)
    for row, total in zip(matrix, result):
        total[...] = w * row[3]
        for factor, coordinate in zip(row, p):
            if factor:
                total += np.float32(factor) * coordinate
    return result


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
                result[:, lanes] *= np.maximum(points.take(lanes).value(texture), 0)
        return result

    def lit(self, E, k, p, wi, distance):
        """See `EvenGlow.lit`; `k` are columns of `maths.patches`, and the triangle `prim` of each."""
        u, v = np.clip(barycentric(p + wi * distance - k.v0, k.e1, k.e2, k.normal), 0, 1)
        return self.seen(E, TexturePoints(self.attributes, np.broadcast_to(k.prim, u.shape), u, v))
