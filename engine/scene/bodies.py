"""Objects that light gets into: what is inside them, how large they are, and whether they may share space."""

from itertools import product

import numpy as np

from ..maths.vectors import cross, dot
from .textured import may_reflect


def inside_of(o):
    """The materials through whose surface light gets into object `o`, a tuple; the first says what is inside."""
    if not o.mesh.triangles.size or not any(map(_has_inside, o.materials)):
        return ()
    indices = o.mesh.material_indices
    used = np.unique(indices.clip(0, len(o.materials) - 1)) if indices.size else (0,)
    return tuple(o.materials[i] for i in used if _has_inside(o.materials[i]))


def _has_inside(material):
    open_lobes = [lobe for lobe in material.lobes if lobe.transmits and may_reflect(lobe)]
    # What only lets light through, as a leaf's alpha does, has no inside unless it says so.
    return bool(open_lobes) and (material.medium is not None or any(hasattr(lobe, "ior") for lobe in open_lobes))


def volume(mesh):
    """The volume [m^3] inside a closed mesh (divergence theorem); some number for one that is not closed."""
    vertices = mesh.vertices.astype(np.float64)
    a, b, c = (vertices - vertices.mean(axis=1, keepdims=True)).take(mesh.triangles, axis=1).transpose(1, 0, 2)
    return float(abs(dot(a, cross(b, c)).sum())) / 6


def sharing_space(objects):
    """Those of `objects` whose bounds meet the bounds of another one, a list."""
    if len(objects) < 2:
        return []
    low, high = (np.array(side).T for side in zip(*map(_bounds, objects)))
    # One against all others at a time: thousands of objects never make a table of millions.
    meets = [np.count_nonzero(((low <= high[:, i : i + 1]) & (high >= low[:, i : i + 1])).all(axis=0)) > 1 for i in range(len(objects))]
    return [o for o, is_met in zip(objects, meets) if is_met]


@np.errstate(over="ignore", invalid="ignore")
def _bounds(o):
    """Least and greatest coordinates of a box around the object, world space; what moves may come anywhere."""
    if not o.is_still:
        return np.full(3, -np.inf), np.full(3, np.inf)
    low, high = o.mesh.vertices.min(axis=1), o.mesh.vertices.max(axis=1)
    corners = np.array(list(product(*zip(low, high))), np.float64).T
    placed = o.world_from_object[:3, :3] @ corners + o.world_from_object[:3, 3:]
    return placed.min(axis=1), placed.max(axis=1)
