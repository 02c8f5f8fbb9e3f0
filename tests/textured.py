"""Meshes with texture coordinates, and textured scenes, for tests."""

import numpy as np

from glanz.engine import (
    Bitmap,
    CheckerTexture,
    Coordinates,
    ImageTexture,
    Lambert,
    LinearTexture,
    Material,
    Mesh,
    NoiseTexture,
    OrthographicCamera,
    Phong,
)
from glanz.engine.scene.points import Points
from glanz.tests import helpers as h, scenes

CORNERS = ((0.0, 1.0, 1.0, 0.0), (0.0, 0.0, 1.0, 1.0))
"""The unit square on the corners of `helpers.quad`."""
PICTURE = Bitmap(name="picture", pixels=np.random.default_rng(1).integers(0, 256, (3, 8, 16)).astype(np.uint8))
CHECKERED = CheckerTexture((0.9, 0.8, 0.1), (0.1, 0.2, 0.6), Coordinates(source="object"))
VEINED = NoiseTexture(Coordinates(source="generated", matrix=np.diag((5.0, 5.0, 5.0, 1.0))), is_coloured=True)
PAINTED = ImageTexture(PICTURE, Coordinates(matrix=np.diag((3.0, 2.0, 1.0, 1.0))))


def with_uvs(mesh, uvs=CORNERS, indices=None, names=("UV",)):
    """`mesh` with a layer of texture coordinates, by vertex unless told otherwise."""
    uvs = np.asarray(uvs, float)
    return Mesh(
        name=mesh.name,
        vertices=mesh.vertices,
        triangles=mesh.triangles,
        normals=mesh.normals,
        normal_indices=mesh.normal_indices,
        uv_layers=names,
        uvs=uvs[None] if uvs.ndim == 2 else uvs,
        uv_indices=mesh.triangles if indices is None else indices,
    )


def everything(scale=1.0):
    """`scenes.everything` with textured materials: reflectances, a textured lobe among two, emission, alpha."""
    base = scenes.everything(scale)
    floor, smooth, flat, box, glow, veil, *others = base.objects
    painted = h.replaced(floor, mesh=with_uvs(floor.mesh), materials=(Material(name="painted", lobes=(Lambert(PAINTED),)),))
    veined = Material(name="veined", lobes=(Lambert((0.2, 0.3, 0.1)), Phong(LinearTexture((VEINED,), ((0.5, 0.4, 0.6),)), 20.0)))
    shining = Material(name="shining", lobes=(Lambert((0.3, 0.3, 0.3)),), emission=LinearTexture((VEINED,), ((3.0, 2.0, 1.0),)))
    checkered = CheckerTexture((0.9, 0.8, 0.1), (0.1, 0.2, 0.6), Coordinates(source="generated", matrix=np.diag((4.0, 4.0, 4.0, 1.0))))
    return h.replaced(
        base,
        objects=[
            painted,
            h.replaced(smooth, materials=(veined,)),
            flat,
            h.replaced(box, materials=(Material(name="checkered", lobes=(Lambert(checkered),)),)),
            h.replaced(glow, materials=(shining,)),
            h.replaced(veil, materials=(h.replaced(scenes.VEIL, name="lace", alpha=VEINED),)),
            *others,
        ],
    )


def facing(mesh, material, **others):
    """A scene that looks down onto `mesh` at z = 0 with an orthographic camera 2 m wide; pixels see squares of equal size."""
    camera = OrthographicCamera(world_from_camera=h.affine(translation=(0, 0, 5)), window=(-1, 1, -1, 1))
    return h.scene([h.thing(mesh, material)], camera=camera, **others)


class Anywhere(Points):
    """Points all over the unit cube for all coordinates, without footprints."""

    count, across = 20_000, None

    def attribute(self, key):
        p = np.random.default_rng(1).random((3, self.count)).astype(np.float32)
        return p, np.zeros_like(p), np.zeros_like(p)


def extremes(value):
    """The least and the largest value of each channel of a texture on the unit cube: two (r, g, b)."""
    found = np.broadcast_to(Anywhere().value(value), (3, Anywhere.count))
    return tuple(found.min(axis=1).tolist()), tuple(found.max(axis=1).tolist())
