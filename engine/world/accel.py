"""Embree behind a guard: the only file that knows embreex.

embreex answers bad input with a crash, a hang or a lie: short arrays are read out of bounds, a NaN in one direction
visits every triangle, memory that runs out is a segmentation fault. Here every such input becomes an exception or a
documented result:

- rays that are not finite meet nothing, and never reach Embree
- a limit that is negative or NaN means that nothing is met
- what Embree would not have memory for is refused with the number, before it is taken
"""

import contextlib
import os
import sys
from dataclasses import dataclass

import numpy as np

from .. import memory
from ..arrays import gather
from ..errors import AccelError
from . import shared_buffers

RAYS_PER_CALL = 2**17
"""A call cannot be interrupted; this many rays take less than half a second."""
BYTES_PER_TRIANGLE = 160
"""Embree's tree, its copy of the mesh and the build, measured, rounded up."""


@dataclass(frozen=True, slots=True, eq=False)
class Hits:
    """What N rays met: `prim` (N,) int32 is the triangle, -1 for nothing; t, u, v (N,) float32 are defined where prim >= 0;
    elsewhere t is how far the ray could have gone.

    The point is v0 + u e1 + v e2, which is exacter than o + t d.
    """

    prim: np.ndarray
    t: np.ndarray
    u: np.ndarray
    v: np.ndarray

    def take(self, lanes):
        """The hits of the rays `lanes` (M,)."""
        return Hits(gather(self.prim, lanes), gather(self.t, lanes), gather(self.u, lanes), gather(self.v, lanes))


class Accel:
    """Triangles (3, V) float32 and (3, F) int32, ready to be met by rays.

    Raises AccelError for what cannot be built, MemoryShortage where it would not fit.
    """

    def __init__(self, vertices, triangles):
        vertices = np.asarray(vertices)
        triangles = np.asarray(triangles)
        if vertices.ndim != 2 or vertices.shape[0] != 3 or vertices.dtype != np.float32:
            raise AccelError(f"vertices must be float32 (3, V), not {vertices.dtype} {vertices.shape}")
        if triangles.ndim != 2 or triangles.shape[0] != 3 or triangles.dtype.kind not in "iu":
            raise AccelError(f"triangles must be integers (3, F), not {triangles.dtype} {triangles.shape}")
        if triangles.size and not 0 <= triangles.min() <= triangles.max() < vertices.shape[1]:
            raise AccelError(f"triangles name vertices {triangles.min()} to {triangles.max()} of {vertices.shape[1]}")
        memory.require(triangles.shape[1] * BYTES_PER_TRIANGLE, f"{triangles.shape[1]} triangles", "simplify the scene", share=0.5)
        # Embree may read one number more than the last vertex has.
        padded = np.zeros((vertices.shape[1] + 1, 3), np.float32)
        padded[:-1] = vertices.T
        # As long as the tree is there, so are the arrays: Embree may read them.
        self._arrays = padded, np.ascontiguousarray(triangles.T, np.int32)
        self.embree = self
        """What is left of it without precision of its own, see `measured`."""
        self.is_empty = triangles.shape[1] == 0
        self._scene, self._mesh = (None, None) if self.is_empty else _build(*self._arrays)

    def is_of(self, vertices, triangles):
        """Whether it was made of these vertices (3, V) and triangles (3, F)."""
        own_vertices, own_triangles = self._arrays
        return np.array_equal(own_vertices[:-1], vertices.T) and np.array_equal(own_triangles, triangles.T)

    def closest(self, o, d, limit=None):
        """The nearest triangle along each ray: o, d (3, N) float32, d unit; returns `Hits`.

        limit, (N,) float32: what lies farther away is not met; rays that meet nothing keep it as their t (without: inf).
        """
        n = _check_rays(o, d)
        limit = None if limit is None else _checked_limit(limit, n)
        hits = None
        for lanes in () if self.is_empty else _safe_lanes(o, d, limit):
            # embreex may write into the limits: it gets its own.
            dists = np.inf if limit is None else limit[lanes].copy()
            found = self._scene.run(o[:, lanes].T, d[:, lanes].T, dists=dists, output=True)
            if n == found["primID"].size:
                return Hits(found["primID"], found["tfar"], found["u"], found["v"])
            hits = hits or _no_hits(n, limit)
            hits.prim[lanes], hits.t[lanes] = found["primID"], found["tfar"]
            hits.u[lanes], hits.v[lanes] = found["u"], found["v"]
        return hits or _no_hits(n, limit)

    def occluded(self, o, d, limit):
        """Whether anything lies within `limit` (N,) float32 along each ray, (N,) bool."""
        n = _check_rays(o, d)
        limit = _checked_limit(limit, n)
        result = np.zeros(n, bool)
        for lanes in () if self.is_empty else _safe_lanes(o, d, limit):
            # embreex may write into the limits: it gets its own.
            found = self._scene.run(o[:, lanes].T, d[:, lanes].T, dists=limit[lanes].copy(), query="OCCLUDED")
            result[lanes] = found >= 0
        return result


def _build(vertices, triangles):
    """embreex's scene with its mesh of `vertices` (V + 1, 3), the last of which is none, and `triangles` (F, 3)."""
    rtcore, rtcore_scene, mesh_construction = _embreex()
    device = rtcore.EmbreeDevice()
    # Robust: watertight at shared edges, 7 to 10 % of rays aimed at an edge leak without.
    scene = rtcore_scene.EmbreeScene(device, robust=True)
    library, pointer = shared_buffers.library_of(rtcore_scene), shared_buffers.scene_pointer(scene, device)
    if not (library and pointer):
        mesh = mesh_construction.TriangleMesh(scene, vertices[:-1], triangles)
        # The tree is built at the first query: do it now, where one thread runs and errors have a name.
        scene.run(np.zeros((1, 3), np.float32), np.ones((1, 3), np.float32))
        return scene, mesh
    mesh = mesh_construction.TriangleMesh(scene, vertices[:1], np.zeros((1, 3), np.int32))
    if error := shared_buffers.share(library, pointer, vertices, triangles):
        raise AccelError(f"Embree cannot build a tree of {len(triangles)} triangles: its error {error}")
    scene.is_committed = 1
    return scene, mesh


def _no_hits(n, limit):
    """The `Hits` of n rays that meet nothing."""
    t = np.full(n, np.inf, np.float32) if limit is None else limit.copy()
    return Hits(np.full(n, -1, np.int32), t, np.zeros(n, np.float32), np.zeros(n, np.float32))


def _check_rays(o, d):
    for name, rays in (("origins", o), ("directions", d)):
        if not isinstance(rays, np.ndarray) or rays.ndim != 2 or rays.shape[0] != 3 or rays.dtype != np.float32:
            kind, shape = getattr(rays, "dtype", type(rays).__name__), getattr(rays, "shape", "")
            raise AccelError(f"ray {name} must be a float32 array (3, N), not {kind} {shape}")
    if o.shape != d.shape:
        raise AccelError(f"{o.shape[1]} ray origins, but {d.shape[1]} directions")
    return o.shape[1]


def _checked_limit(limit, n):
    limit = np.asarray(limit)
    if limit.shape != (n,) or limit.dtype != np.float32:
        raise AccelError(f"limit must be float32 ({n},), not {limit.dtype} {limit.shape}")
    return limit


def _safe_lanes(o, d, limit=None):
    """Slices or index lists of at most RAYS_PER_CALL rays that Embree can be trusted with."""
    n = o.shape[1]
    # All together first, for there is hardly ever one that is not.
    if np.isfinite(o).all() and np.isfinite(d).all() and (limit is None or np.minimum.reduce(limit, initial=0) >= 0):
        return [slice(start, start + RAYS_PER_CALL) for start in range(0, n, RAYS_PER_CALL)]
    with np.errstate(over="ignore", invalid="ignore"):
        safe = np.isfinite(o[0] + o[1] + o[2] + d[0] + d[1] + d[2])
    if limit is not None:
        safe &= limit >= 0
    lanes = np.nonzero(safe)[0]
    return [lanes[start : start + RAYS_PER_CALL] for start in range(0, lanes.size, RAYS_PER_CALL)]


def check():
    """Raise AccelError, with the cause, where embreex cannot be loaded."""
    _embreex()


def _embreex():
    """embreex bound to its own libembree, also inside a Blender that brings another one.

    Official Linux builds of Blender hold their libembree4 in the global scope, and embreex's calls would bind to
    that copy. RTLD_DEEPBIND makes it look into its own libraries first. Only the first import matters.
    """
    with _deepbind():
        try:
            from embreex import mesh_construction, rtcore, rtcore_scene
        except Exception as error:  # whatever a library raises that was built for another NumPy or another system
            raise AccelError(
                f"embreex cannot be loaded ({error}); install the package embreex, or the Glanz extension for this platform"
            ) from error
    return rtcore, rtcore_scene, mesh_construction


@contextlib.contextmanager
def _deepbind():
    if not hasattr(os, "RTLD_DEEPBIND"):
        yield
        return
    flags = sys.getdlopenflags()
    sys.setdlopenflags(os.RTLD_NOW | os.RTLD_LOCAL | os.RTLD_DEEPBIND)
    try:
        yield
    finally:
        sys.setdlopenflags(flags)
