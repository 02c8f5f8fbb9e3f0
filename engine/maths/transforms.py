"""Affine transforms of points, vectors and normals; (4, 4) matrices are named destination_from_source."""

import numpy as np


def cofactors(matrix):
    """The cofactor matrix (..., 3, 3) of the linear part: what carries normals, also where there is no inverse.

    cof(M) = det(M) M^-T; the sign of the determinant keeps normals on their side of a mirrored surface.
    """
    a, b, c = np.moveaxis(np.asarray(matrix, np.float64)[..., :3, :3], -2, 0)
    return np.stack((np.cross(b, c), np.cross(c, a), np.cross(a, b)), axis=-2)


def flips_orientation(matrix):
    """Whether transforms (..., 4, 4) turn right hands into left hands (negative determinant)."""
    return np.linalg.det(np.asarray(matrix, np.float64)[..., :3, :3]) < 0


def look_at(eye, target, up=(0.0, 0.0, 1.0)):
    """world_from_camera (4, 4) of a camera at `eye` that looks along its -z at `target`; `up` points up in the image.

    The lecture's axes: w = (e - z) / |e - z|, u = up x w, v = w x u. Raises ValueError where up is along the view.
    """
    eye, target, up = (np.asarray(v, np.float64) for v in (eye, target, up))
    w = eye - target
    u = np.cross(up, w)
    if not np.linalg.norm(u) > 0:
        raise ValueError(f"no view from {eye.tolist()} to {target.tolist()} with up {up.tolist()}")
    w /= np.linalg.norm(w)
    u /= np.linalg.norm(u)
    matrix = np.eye(4)
    matrix[:3, :4] = np.stack((u, np.cross(w, u), w, eye), axis=1)
    return matrix
