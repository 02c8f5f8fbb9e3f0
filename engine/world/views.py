"""How points are looked at: by which rays, and where the camera has them."""

from dataclasses import dataclass

import numpy as np

from ..maths.vectors import dot
from .interaction import Surface, smooth_normals


@dataclass(frozen=True, slots=True, eq=False)
class CameraSpace:
    """The frame of the camera at the middle of the shutter: it looks along +z, x to the right, y up [m].

    rows                 (3, 4) float32, camera_from_render
    from_world, to_world (12, 1) float32: the rows of camera_from_world and of its inverse
    """

    camera: object
    rows: np.ndarray
    from_world: np.ndarray
    to_world: np.ndarray

    @classmethod
    def of(cls, camera, frame):
        """Of a camera value and the `Frame` of render space."""
        world_from_render = np.eye(4)
        world_from_render[:3, :3] /= frame.scale
        world_from_render[:3, 3] = frame.origin
        # Blender's cameras look along -z.
        world_from_camera = np.asarray(camera.world_from_camera, np.float64) @ np.diag((1, 1, -1, 1))
        camera_from_world = np.linalg.inv(world_from_camera)
        rows = (camera_from_world @ world_from_render)[:3].astype(np.float32)
        matrices = (m[:3].reshape(12, 1).astype(np.float32) for m in (camera_from_world, world_from_camera))
        return cls(camera, rows, *matrices)

    def points(self, p):
        """Points p (3, N) of render space in the frame of the camera."""
        return self.vectors(p) + self.rows[:, 3:]

    def vectors(self, a):
        """The same for vectors."""
        # Term by term, as what a product of matrices rounds depends on the number of lanes.
        return self.rows[:, 0:1] * a[0] + self.rows[:, 1:2] * a[1] + self.rows[:, 2:3] * a[2]

    def window(self, p):
        """Where in the picture (x, y, 0) (3, N) points p (3, N) of render space are: (0, 0) is its lower left, (1, 1) its upper right."""
        x, y = self.camera.in_window(self.points(p))
        return np.stack((x, y, np.zeros_like(x)))


class LampView:
    """Points on glowing triangles as shadow rays look at them: along d (3, N), over `distance` (N,).

    They are looked at once more where paths meet them; so here they are of no kind of ray.
    """

    is_even = None

    def __init__(self, glow, k, d, distance):
        self.frame, self.camera = glow.frame, glow.camera
        self.d = d
        self._glow, self._k, self._distance = glow, k, distance

    def take(self, lanes):
        """The points `lanes` (M,)."""
        k = self._k.take(lanes) if self._k.v0.shape[1] > 1 else self._k
        return LampView(self._glow, k, self.d.take(lanes, axis=1), self._distance.take(lanes))

    def surface(self, prim, u, v):
        """The `Surface` at places u, v (N,) of the triangles `prim` (N,)."""
        triangles, k = self._glow.triangles, self._k
        sign = np.copysign(np.float32(1), -dot(k.normal, self.d))
        n, p = k.normal * sign, k.v0 + u * k.e1 + v * k.e2
        ns = n
        if triangles.smooth.size:
            # Those of triangles that move are in frames of their own.
            ns = np.where(prim < triangles.first_moving, smooth_normals(triangles, prim, u, v, n, sign), n)
        return Surface(p, -self.d, n, ns, p, sign > 0, prim, triangles.material.take(prim), u, v, self._distance)

    def edges(self, prim):
        """The edges, two (3, N), render space."""
        return self._k.e1, self._k.e2

    def pixel(self, prim):
        """How wide (N,) a pixel is taken to be: shadow rays have no width, but triangles have a size."""
        return self._glow.triangles.extent.take(prim) * np.float32(2.0**-8)

    def turned(self, prim, a):
        """Vectors a (3, N) of objects, as they are placed at the middle of the shutter."""
        return a

    def around(self, surface):
        """The index of refraction of what is around glowing bodies: media count where paths meet them."""
        return np.float32(1)

    def path(self, output):
        """What `LightPath` says, (1, 1) or (1, N)."""
        if output == "length":
            return self._distance[None] / np.float32(self.frame.scale)
        return np.full((1, 1), output == "depth", np.float32)
