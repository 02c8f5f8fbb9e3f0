"""Textures looked up at surface points."""

from dataclasses import dataclass, replace

import numpy as np

from ..maths.vectors import cross, dot, length
from ..scene.points import Points
from .views import LampView

_TINY = np.finfo(np.float32).tiny
_LONGEST = 2.0**10
"""How much longer than wide footprints may be: grazing rays see the mean of what they pass anyway."""


class TexturePoints(Points):
    """N points on triangles, where textures are evaluated.

    attributes    {key: `Attribute`} of the world
    prim, u, v    (N,) triangles and barycentric coordinates
    view          who looks at them, see `wavefront.views`; None: no texture asks
    across        None, or the half-axes of footprints in barycentric coordinates: two (2, N)
    """

    def __init__(self, attributes, prim, u, v, view=None, across=None):
        super().__init__()
        self.attributes, self.prim, self.u, self.v, self.across = attributes, prim, u, v, across
        self._view, self._find_surface = view, None

    @property
    def count(self):
        """N."""
        return self.prim.size

    @property
    def is_even(self):
        """(N,) see `Points`."""
        return self._view and self._view.is_even

    def take(self, lanes):
        """The points `lanes` (M,)."""
        across = self.across and tuple(axis.take(lanes, axis=1) for axis in self.across)
        view = self._view and self._view.take(lanes)
        return TexturePoints(self.attributes, self.prim.take(lanes), self.u.take(lanes), self.v.take(lanes), view, across)

    def moved(self, du, dv):
        """The points at du, dv (N,) from these in barycentric coordinates; they may be beyond the edges of their triangles."""
        return TexturePoints(self.attributes, self.prim, self.u + du, self.v + dv, self._view, self.across)

    def moved_by(self, a):
        """The points at a (3, N) from these, render space, along their triangles."""
        return self.moved(*barycentric(a, *self.edges, self.surface.n))

    def met(self, find):
        """These points, whose `Surface` is known already: `find`() gives it when a texture asks."""
        self._find_surface = find
        return self

    def on(self, surface):
        """The points on a `Surface` that differs from theirs in its shading normals."""
        points = TexturePoints(self.attributes, self.prim, self.u, self.v, self._view, self.across)
        points.once("surface", lambda: surface)
        return points

    def beside(self, axis):
        """The points moved by half-axis 0 or 1 of their footprints."""
        return self.moved(*self.across[axis])

    def attribute(self, key):
        """An attribute at the points, see `Attribute.at`."""
        if key in _PLACES:
            return self.once(key, lambda: _PLACES[key](self))
        return self.once(key, lambda: self.attributes[key].at(self.prim, self.u, self.v))

    @property
    def d(self):
        """(3, N) the directions of the rays that look at the points, unit."""
        return self._view.d

    @property
    def frame(self):
        """The `Frame` of render space."""
        return self._view.frame

    @property
    def camera(self):
        """The `CameraSpace`."""
        return self._view.camera

    @property
    def surface(self):
        """The `Surface`: its shading normals are as yet without relief."""
        return self.once("surface", self._find_surface or (lambda: self._view.surface(self.prim, self.u, self.v)))

    @property
    def edges(self):
        """The edges of the triangles, two (3, N), render space."""
        return self.once("edges", lambda: self._view.edges(self.prim))

    @property
    def in_window(self):
        """Where in the picture the camera sees the points, (3, N), see `views.CameraSpace.window`."""
        return self.camera.window(self.surface.p)

    @property
    def around(self):
        """The index of refraction, 1 or (N,), of what is around the bodies on whose surfaces the points are."""
        return self.once("around", lambda: self._view.around(self.surface))

    @property
    def pixel_width(self):
        """How wide (N,) a pixel is where the points are, render space."""
        return self._view.pixel(self.prim)

    def at_time(self, a):
        """Vectors a (3, N) of objects as they are placed at the middle of the shutter, as they are at the time of the rays."""
        return self._view.turned(self.prim, a)

    def path(self, output):
        """What `LightPath` says of the rays, (1, 1) or (1, N)."""
        return self._view.path(output)


def _position(at):
    # Subtracted as a whole: far from the origin single precision holds the sum, but not both of its parts.
    p = (at.surface.p / np.float64(at.frame.scale) + at.frame.origin[:, None]).astype(np.float32)
    return p, *(e / np.float32(at.frame.scale) for e in at.edges)


def _camera(at):
    return at.camera.points(at.surface.p), *(at.camera.vectors(e) for e in at.edges)


_PLACES = {("position", ""): _position, ("camera", ""): _camera}
"""What points know without any mesh."""


def footprints(e1, e2, wo, width, is_stretched):
    """Half-axes, two (2, N), of what cones of `width` (N,) cut out of triangles with edges e1, e2, in barycentric coordinates.

    Where `is_stretched` (N,) the cone's circle is longer by 1 / cos along its direction (Akenine-Moller et al. 2021,
    "Improved Shader and Texture Level of Detail Using Ray Cones", section 5).
    """
    n = cross(e1, e2)
    n /= np.maximum(length(n), _TINY)
    cos = dot(n, wo)
    along = wo - cos * n
    # Seen from above all directions are alike, but one is needed.
    straight = np.nonzero(dot(along, along) == 0)[0]
    if straight.size:
        along[:, straight] = e1.take(straight, axis=1)
    radius = np.float32(0.5) * width
    short = radius / np.maximum(length(along), _TINY)
    long = np.where(is_stretched, short / np.maximum(np.abs(cos), np.float32(1 / _LONGEST)), short)
    return tuple(barycentric(a, e1, e2, n) for a in (along * long, cross(n, along) * short))


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
    """No emitter is textured, no light has a shade."""

    def seen_from(self, camera):
        """The same with another `CameraSpace`."""
        return self

    def seen(self, L, points):
        """Radiance L (3, N) of emitters at `TexturePoints`, as it is there."""
        return L

    def lit(self, E, k, p, wi, distance):
        """Irradiance E (3, N) at p from a point of each light, in the directions wi (3, N), as it is from there; `k` are its rows."""
        return E

    def met(self, L, k, rays, lanes, t):
        """Radiance L (3, M) of the light `k` where the `lanes` (M,) of rays meet it at t (M,), as it is there."""
        return L


EVEN = EvenGlow()


@dataclass(frozen=True, slots=True, eq=False)
class TexturedGlow:
    """What textured emitters shine with, where the tables say 1.

    textures    {row of the materials: emission}
    triangles   the world's
    attributes  {key: `Attribute`}
    frame       the `Frame` of render space
    camera      the `CameraSpace`
    """

    textures: dict
    triangles: object
    attributes: dict
    frame: object
    camera: object

    def seen_from(self, camera):
        """See `EvenGlow.seen_from`."""
        return replace(self, camera=camera)

    def seen(self, L, points):
        """See `EvenGlow.seen`."""
        result = L.copy()
        material = self.triangles.material.take(points.prim)
        for row, texture in self.textures.items():
            lanes = np.nonzero(material == row)[0]
            if lanes.size:
                result[:, lanes] *= clean(points.take(lanes).value(texture))
        return result

    def lit(self, E, k, p, wi, distance):
        """See `EvenGlow.lit`; `k` are columns of `maths.patches`, and the triangle `prim` of each."""
        u, v = np.clip(barycentric(p + wi * distance - k.v0, k.e1, k.e2, k.normal), 0, 1)
        view = LampView(self, k, wi, distance)
        return self.seen(E, TexturePoints(self.attributes, np.broadcast_to(k.prim, u.shape), u, v, view))
