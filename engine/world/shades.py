"""Lights before which textures stand: what these are told of the places where rays meet the lights."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np

from ..arrays import columns
from ..maths.frames import to_world
from ..maths.light_frames import to_light
from ..maths.vectors import dot
from ..maths.warps import square_to_cone
from ..scene.points import OnPlane
from .texturing import clean

_FARTHEST = np.finfo(np.float32).max
_RECEIVERS = 512
"""Places around a light at which its shade is averaged."""
_STEPS = 1.1673039782614187 ** -np.arange(1.0, 5.0)
"""Powers of 1 / g with g^5 = g + 1: what is left of their multiples below 1 covers the hypercube evenly (Roberts 2018)."""


def place_columns(shade, frame):
    """The columns that a row of a light has besides its own: its origin in render space, and its matrices, rows of four."""
    world_from_light = np.asarray(shade.world_from_light, np.float64)
    # What a scale of 0 flattens stays in its plane.
    linear = np.linalg.pinv(world_from_light[:3, :3])
    light_from_world = np.concatenate((linear, -linear @ world_from_light[:3, 3:]), axis=1)
    return {
        "origin": tuple(frame.points(world_from_light[:3, 3:])[:, 0]),
        "world_from_light": tuple(world_from_light[:3].ravel()),
        "light_from_world": tuple(light_from_world.ravel()),
    }


class ShadePoints(OnPlane):
    """Points on lights where rays along d (3, N) meet them from p (3, N) at `distance` (N,); `k` are rows of the lights.

    Lights do not know which rays look at them: these are of no kind, and one bounce from the camera.
    """

    d = frame = camera = None

    def __init__(self, glow, k, p, d, distance):
        super().__init__(d)
        self.d, self.frame, self.camera = d, glow.frame, glow.camera
        self._glow, self._k, self._p, self._distance = glow, k, p, distance
        self._is_distant = getattr(glow.light, "is_distant", False)
        self._there, self._normal, self._uv = glow.light.seen(k, p, d, distance)

    def attribute(self, key):
        """See `world.attributes.Attribute.at`; nothing changes along a light, and what only meshes have is 0."""
        found, *_ = super().attribute(key)
        none = np.zeros((len(found), 1), np.float32)
        found = self.once(key, lambda: self._looked_up(*key))
        return none if found is None else found, none, none

    def _looked_up(self, source, name):
        if source in ("uv", "parametric"):
            return np.concatenate((self._uv, np.zeros_like(self._uv[:1])))
        if source == "position":
            return self._position
        if source in ("object", "generated"):
            return self._local
        if source == "camera":
            rows = self.camera.from_world
            return np.stack([dot(rows[4 * i : 4 * i + 3], self._position) + rows[4 * i + 3] for i in range(3)])
        if source == "value":
            return self._value(name)
        return {"world_from_object": self._k.world_from_light, "object_from_world": self._k.light_from_world}.get(source)

    @property
    def _position(self):
        """(3, N) world space [m]; what is infinitely far away is at its direction seen from the light, as in Cycles."""
        if self._is_distant:
            return self._there
        world = self._there / np.float64(self.frame.scale) + self.frame.origin[:, None]
        return world.astype(np.float32)

    @property
    def _local(self):
        rows = self._k.light_from_world
        if self._is_distant:
            return to_light(self._k, self._there) + rows[3::4]
        # From the light's own origin: far from that of the world nothing is lost.
        return to_light(self._k, (self._there - self._k.origin) / np.float32(self.frame.scale))

    def _value(self, name):
        if name == "location":
            return np.concatenate((self._k.world_from_light[3::4], np.ones_like(self._k.world_from_light[:1])))
        table = self._glow.values.get(name)
        return None if table is None else table.take(np.asarray(self._k.lamp).astype(np.intp), axis=1)

    @property
    def surface(self):
        """The light, whose front is seen."""
        return SimpleNamespace(p=self._there, n=self._normal, ns=self._normal, is_front=np.ones(1, bool))

    @property
    def in_window(self):
        """Where in the picture the camera sees the points."""
        p = self.attribute(("position", ""))[0]
        return self.camera.window(self.frame.points(p).astype(np.float32))

    def moved_by(self, a):
        """The same places once more: along a light nothing is bent (as in Cycles)."""
        return ShadePoints(self._glow, self._k, self._p, self.d, self._distance)

    def path(self, output):
        """What `LightPath` says; the length of rays to suns is the largest of all numbers."""
        if output == "length":
            with np.errstate(over="ignore"):
                return np.minimum(self._distance / np.float32(self.frame.scale), _FARTHEST)[None]
        return np.full((1, 1), output == "depth", np.float32)


@dataclass(frozen=True, slots=True, eq=False)
class ShadedGlow:
    """The shades of lights of one kind, whose tables have the columns of `place_columns`, `lamp` (their number) and `texture`.

    light     the kind
    textures  the different textures
    values    {name: (4, M)} what is known of each light
    frame     the `Frame` of render space
    camera    the `CameraSpace`
    """

    light: type
    textures: tuple
    values: dict
    frame: object
    camera: object

    @classmethod
    def of(cls, lamps, frame, camera):
        """(the table of `lamps`, light values of one kind, all with a `shade`; their `ShadedGlow`)."""
        textures = tuple(dict.fromkeys(lamp.shade.texture for lamp in lamps))
        named = [dict(lamp.shade.values) for lamp in lamps]
        names = dict.fromkeys(name for values in named for name in values)
        values = {name: np.array([own.get(name, (0.0,) * 4) for own in named], np.float32).T for name in names}
        rows = [
            lamp.row(frame) | place_columns(lamp.shade, frame) | {"lamp": i, "texture": textures.index(lamp.shade.texture)}
            for i, lamp in enumerate(lamps)
        ]
        return columns(rows), cls(type(lamps[0]), textures, values, frame, camera)

    def seen_from(self, camera):
        """See `EvenGlow.seen_from`."""
        return replace(self, camera=camera)

    def lit(self, E, k, p, wi, distance):
        """E (3, N), irradiance at p (3, N) or radiance towards it, as the shades leave it. The light lies along wi at `distance`."""
        E = np.array(np.broadcast_to(E, wi.shape))
        worn = np.broadcast_to(k.texture, wi[0].shape)
        for i, texture in enumerate(self.textures):
            lanes = np.nonzero(worn == i)[0]
            if lanes.size:
                at = ShadePoints(self, k.pick(lanes), p.take(lanes, axis=1), wi.take(lanes, axis=1), distance.take(lanes))
                E[:, lanes] *= clean(at.value(texture))
        return E

    def met(self, L, k, rays, lanes, t):
        """See `EvenGlow.met`."""
        return self.lit(L, k, rays.o.take(lanes, axis=1), rays.d.take(lanes, axis=1), t)


def share_left(lamp, frame, camera, radius):
    """The share (3,) of the light of `lamp` that its shade leaves, on average over places at `radius` [m] at which it shines."""
    k, glow = ShadedGlow.of([lamp], frame, camera)
    u = np.mod(0.5 + _STEPS[:, None] * np.arange(1, _RECEIVERS + 1), 1).astype(np.float32)
    reach = lamp.weight(frame)
    axis = np.array(reach["axis"], np.float32)[:, None]
    away = to_world(axis if axis.any() else np.float32([[0], [0], [1]]), square_to_cone(u[2:], np.float32(1 - reach["cos_edge"])))
    p = k.origin + np.float32(radius * frame.scale) * away
    with np.errstate(all="ignore"):
        wi, distance, E, _ = lamp.sample(k, p, u[:2])
        before = np.broadcast_to(np.where(np.isfinite(E), E, 0), p.shape)
        after = glow.lit(before, k, p, wi, distance)
        share = after.sum(axis=1, dtype=np.float64) / before.sum(axis=1, dtype=np.float64)
    # Where it does not shine at all nothing is known of its shade.
    return np.where((share >= 0) & (share < np.inf), share, 0) if before.any() else np.ones(3)
