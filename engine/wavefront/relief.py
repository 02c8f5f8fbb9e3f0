"""Normal maps and bump maps: textures that bend shading normals.

Light from below the geometric surface is refused as for every shading normal; a bent normal that would itself point
below it is not used.
"""

import dataclasses

import numpy as np

from ..maths.vectors import cross, dot, length
from ..scene.relief import NormalMap
from ..scene.textured import luminance
from ..world.texturing import barycentric
from .texturing import points_of

_LEAST_STEP = np.float32(2.0**-18)
"""Of a triangle's extent: heights closer together than this differ by the rounding of their places."""
_TINY = np.finfo(np.float32).tiny


def bend_normals(plan, rays, surface):
    """The surface with the normals that the reliefs of its materials give it, one after the other."""
    points, ns = points_of(plan, rays, surface), np.array(surface.ns)
    for row, reliefs in plan.world.materials.relief.items():
        lanes = np.nonzero(surface.material == row)[0]
        if not lanes.size:
            continue
        at = points.take(lanes)
        e1, e2 = plan.edges(plan, rays.carried.take(lanes), at.prim)
        n, own = surface.n.take(lanes, axis=1), ns.take(lanes, axis=1)
        for relief in reliefs:
            if isinstance(relief, NormalMap):
                side = np.where(surface.is_front.take(lanes), np.float32(1), np.float32(-1))
                bent, is_bent = _mapped(relief, at, own, side, e1, e2)
            else:
                step = 0.5 * rays.carried.extent.take(lanes)
                step = np.maximum(step, _LEAST_STEP * plan.world.triangles.extent.take(at.prim))
                bent, is_bent = _bumped(relief, at, own, n, e1, e2, step, np.float32(plan.world.frame.scale))
            # Also not where it is not a number.
            used = np.nonzero(is_bent & (dot(bent, n) > 0))[0]
            own[:, used] = bent[:, used]
        ns[:, lanes] = own
    return dataclasses.replace(surface, ns=ns)


def _mapped(relief, at, ns, side, e1, e2):
    """Normals (3, N) of a normal map, and where (N,) they are not those of the surface.

    The tangent is that of each triangle, dp/du, made orthogonal to the shading normal.
    """
    _, along_u, along_v = at.attribute(("uv", relief.layer))
    determinant = along_u[0] * along_v[1] - along_u[1] * along_v[0]
    front = ns * side
    tangent = (along_v[1] * e1 - along_u[1] * e2) * np.sign(determinant)
    tangent -= dot(tangent, front) * front
    tangent /= np.maximum(length(tangent), _TINY)
    bitangent = np.sign(determinant) * cross(front, tangent)
    x, y, z = 2 * np.broadcast_to(at.value(relief.texture), ns.shape) - 1
    strength = np.float32(relief.strength)
    x, y, z = strength * x, strength * y, 1 + min(strength, np.float32(1)) * (z - 1)
    normal = x * tangent + y * bitangent + z * front
    normal *= side / np.maximum(length(normal), _TINY)
    return normal, ((x != 0) | (y != 0)) & (determinant != 0)


def _bumped(relief, at, ns, n, e1, e2, step, scale):
    """Normals (3, N) of a bump map, and where (N,) they are not those of the surface.

    By the surface gradient of the height (Mikkelsen 2010, "Bump Mapping Unparametrized Surfaces on the GPU", eq. 4), from
    differences over `step` (N,).
    """
    right = e1 / np.maximum(length(e1), _TINY)
    up = cross(n, right)
    middle = _height(relief, at)
    slopes = []
    for along in (right, up):
        du, dv = barycentric(along * step, e1, e2, n)
        slopes.append(np.float32(relief.distance) * scale * (_height(relief, at.moved(du, dv)) - middle) / step)
    across = cross(up, ns), cross(ns, right)
    determinant = dot(right, across[0])
    gradient = slopes[0] * across[0] + slopes[1] * across[1]
    normal = np.abs(determinant) * ns - np.sign(determinant) * gradient
    normal /= np.maximum(length(normal), _TINY)
    strength = np.float32(relief.strength)
    normal = strength * normal + (1 - strength) * ns
    normal /= np.maximum(length(normal), _TINY)
    return normal, (slopes[0] != 0) | (slopes[1] != 0)


def _height(relief, at):
    return np.broadcast_to(luminance(at.value(relief.texture)), at.count)
