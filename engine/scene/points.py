"""Points at which textures are evaluated, and what is known of a texture where there are none."""

import weakref
from types import SimpleNamespace

import numpy as np

from ..maths.facing import across
from .coordinates import Coordinates
from .graphs import is_landing, with_inner

_PROBES = 256
_STEPS = (0.8191725133961645, 0.6710436067037893, 0.5497004779019703)
"""Powers of 1 / g with g^4 = g + 1: what is left of their multiples below 1 covers the cube evenly (Roberts 2018)."""


class Points:
    """N points; what a texture is handed as `at`. Each coordinate system and each texture is worked out once.

    Who inherits offers `attribute`(key), see `world.attributes.Attribute.at`; `across`, None or the half-axes of footprints
    in units of what attributes change along; `beside`(axis), the points moved by half-axis 0 or 1; `moved_by`(a), those moved by
    a; and what `OnPlane` shows. By itself it is one point without a footprint, where textures of constants are looked up.

    Textures look around while others do that look around at them. So that this does not double with each of them, points around
    the same ones are the same points wherever they are reached from, and have the footprints of those that they are beside.
    """

    count = 1
    across = None
    around = np.float32(1)
    """The index of refraction, or (N,), of what is around the bodies on whose surfaces the points are: here of the vacuum."""
    is_even = None
    """(N,) where what looks at the points looks at others beside them as well, see `wavefront.cones`; None: everywhere."""

    def __init__(self):
        self._known, self._around = {}, {}
        self._middle, self._place = weakref.ref(self), (0.0, 0.0, None)

    def value(self, x):
        """What an input is at the points: float32 (1, N) or (3, N), one column where it is the same for all."""
        if isinstance(x, Coordinates):
            return self.look_up(x)[0]
        if not hasattr(x, "eval"):
            return np.array(x, np.float32).reshape(-1, 1)
        # Textures are equal to none but themselves.
        if x not in self._known:
            for part in filter(is_landing, with_inner(x, self._known)) if is_landing(x) else (x,):
                self._known[part] = part.eval(self)
        return self._known[x]

    def once(self, key, function):
        """What `function`() returns, called the first time only that this `key` is asked for."""
        if key not in self._known:
            self._known[key] = function()
        return self._known[key]

    def look_up(self, where):
        """The points (3, N) that `where` stands for, and None or the half-axes of their footprints, two (3, N).

        `where` is `Coordinates`, or an input; how far that changes over a footprint is seen by going there.
        """
        if isinstance(where, Coordinates):
            return self.once(where, lambda: self._placed(where))
        p = self.value(where)
        if self.across is None:
            return _columns(p, self.count), None
        right, up, _ = self._place
        return _columns(p, self.count), self._at(right, up, None)._changes(where)

    def _changes(self, where):
        """How far the input `where` changes along the half-axes of footprints, two (3, N)."""
        p, (right, up, _) = self.value(where), self._place
        beside = [self._at(right, up, axis).value(where) for axis in (0, 1)]
        return self.once((where, "changes"), lambda: tuple(_columns(value - p, self.count) for value in beside))

    def away(self, right, up):
        """The points so many pixels away along the axes `maths.facing.across` of the surface."""
        x, y, axis = self._place
        return self._at(x + right, y + up, axis)

    def _at(self, right, up, axis):
        """The points so many pixels from those that were there first; of these the ones beside, unless `axis` is None."""
        place, middle = (right, up, axis), self._middle()
        if place == (0.0, 0.0, None):
            return middle
        if place not in middle._around:
            if axis is None:
                x, y = across(middle.surface.n)
                points = middle.moved_by((np.float32(right) * x + np.float32(up) * y) * middle.pixel_width)
            else:
                points = middle._at(right, up, None).beside(axis)
            points._middle, points._place = self._middle, place
            middle._around[place] = points
        return middle._around[place]

    def _placed(self, coordinates):
        p, along_u, along_v = self.attribute(coordinates.attribute)
        axes = self.across and tuple(_affine(coordinates.matrix, a * along_u + b * along_v, 0) for a, b in self.across)
        return _affine(coordinates.matrix, p, 1), axes


_COMPONENTS = {"number": 1, "alpha": 1, "colour alpha": 1, "value": 4, "tangent": 4}
"""How many numbers attributes have, but for those with three."""


_IDENTITY = np.eye(4, dtype=np.float32)[:3].reshape(12, 1)


class OnPlane(Points):
    """Points p (3, N) for which there is no scene: all attributes are p, and a plane is seen there by rays from all around its front."""

    edges = tuple(np.eye(3, dtype=np.float32)[:2, :, None])
    frame = SimpleNamespace(scale=1.0)
    camera = SimpleNamespace(from_world=_IDENTITY, to_world=_IDENTITY)
    pixel_width = np.float32(_PROBES**-0.5)

    def __init__(self, p, across=None):
        super().__init__()
        self.p, self.across = p, across

    @property
    def count(self):
        """N."""
        return self.p.shape[1]

    def attribute(self, key):
        """See `world.attributes.Attribute.at`; objects stand at the origin."""
        if key[0] in ("world_from_object", "object_from_world"):
            return _IDENTITY, 0, 0
        rows = [0, 1, 2, 0][: _COMPONENTS.get(key[0], 3)]
        x, y = np.eye(3, dtype=np.float32)[:2, :, None]
        return self.p[rows], x[rows], y[rows]

    @property
    def d(self):
        """Directions of rays, as they come from all around in front of a diffuse surface."""
        x, _, cos2 = self.p - np.floor(self.p)
        sin, angle = np.sqrt(1 - cos2), np.float32(2 * np.pi) * x
        return np.stack((sin * np.cos(angle), sin * np.sin(angle), -np.sqrt(cos2)))

    @property
    def surface(self):
        """The plane, whose normal is z."""
        up = np.float32([[0], [0], [1]])
        return SimpleNamespace(p=self.p, n=up, ns=up, is_front=np.ones(1, bool))

    @property
    def u(self):
        """Where in its triangle each is."""
        return self.p[0]

    @property
    def v(self):
        """The same, along the other edge."""
        return self.p[1]

    @property
    def in_window(self):
        """Where the camera sees the points."""
        return self.p

    def moved_by(self, a):
        """The points moved by a (3, 1)."""
        return type(self)(self.p + a, self.across)

    def at_time(self, a):
        """Vectors of objects, which do not move."""
        return a

    def path(self, output):
        """The rays are of no kind, one bounce from the camera, which is one metre away."""
        return np.full((1, 1), output in ("depth", "length"), np.float32)


class Probes(OnPlane):
    """Points all over the unit cube; their footprints along x and y cover it."""

    def __init__(self, moved=(0.0, 0.0)):
        step = np.array(_STEPS)[:, None]
        p = np.mod(0.5 + step * np.arange(_PROBES), 1).astype(np.float32)
        p[:2] += np.array(moved, np.float32)[:, None]
        half = np.full((1, _PROBES), 0.5 * _PROBES**-0.5, np.float32)
        none = np.zeros_like(half)
        super().__init__(p, (np.concatenate((half, none)), np.concatenate((none, half))))

    def beside(self, axis):
        """The probes moved by half-axis 0 or 1."""
        return Probes(self.across[axis][:, 0])

    def moved_by(self, a):
        """See `OnPlane.moved_by`."""
        return Probes(a[:2, 0])


_UNMOVED = tuple(map(tuple, np.eye(4).tolist()))
_averages = weakref.WeakKeyDictionary()


def average_of(texture):
    """The mean of a texture over `Probes`, (1,) or (3,) float64; what is no number counts as 0."""
    if texture not in _averages:
        with np.errstate(all="ignore"):
            value = Probes().value(texture)
        _averages[texture] = np.where(np.isfinite(value), value, 0).mean(axis=1, dtype=np.float64)
    return _averages[texture]


def constant_of(texture):
    """A pure texture of constants as the constant that it is: a number or three."""
    with np.errstate(all="ignore"):
        value = Points().value(texture)[:, 0].astype(np.float64)
    return float(value[0]) if value.size == 1 else tuple(value.tolist())


def _columns(a, n):
    """`a` (1 or 3, 1 or n) as (3, n)."""
    return np.broadcast_to(a, (3, n))


def _affine(matrix, p, w):
    """The rows of `matrix` times (p, w). Term by term, as what a product of matrices rounds depends on the number of lanes."""
    if matrix == _UNMOVED:
        return p
    result = np.empty_like(p)
    for row, total in zip(matrix, result):
        total[...] = w * row[3]
        for factor, coordinate in zip(row, p):
            if factor:
                total += np.float32(factor) * coordinate
    return result
