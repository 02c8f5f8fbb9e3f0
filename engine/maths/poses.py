"""Affine motion between keys: matrices taken apart into place, rotation and stretch, and put together at any time.

M = T R S with a rotation R and a symmetric stretch S (the polar decomposition of Shoemake and Duff 1992, "Matrix
Animation and Polar Decomposition"). Place and stretch go in straight lines from key to key, the rotation at constant
speed about one axis (Shoemake 1985, "Animating Rotation with Quaternion Curves"): constant velocity and constant spin
are exact with two keys, as long as the spin is less than half a turn between them.
"""

from dataclasses import dataclass

import numpy as np

from .transforms import flips_orientation


@dataclass(frozen=True, slots=True, eq=False)
class Keys:
    """K >= 2 keys at equal times from 0 to 1, taken apart.

    place     (3, K) float64
    rotation  (4, K) unit quaternions (w, x, y, z), each on the side of the one before
    stretch   (3, 3, K) symmetric; negative definite where all matrices mirror
    """

    place: np.ndarray
    rotation: np.ndarray
    stretch: np.ndarray

    @classmethod
    def of(cls, matrices):
        """From affine matrices (K, 4, 4), finite."""
        matrices = np.asarray(matrices, np.float64)
        u, size, v = np.linalg.svd(matrices[:, :3, :3])
        # Mirrored keys are rotations of -1. An axis that is lost may point either way, and where keys differ, the shortest changes sides.
        is_flat = size[:, 2] <= np.finfo(np.float64).eps * size[:, 0]
        hand = np.where(flips_orientation(u @ v), -1.0, 1.0)
        common = -1.0 if (hand[~is_flat] < 0).all() and not is_flat.all() else 1.0
        for part in (np.swapaxes(u, 1, 2), size):
            part[hand != common, 2] *= -1
        rotation = common * u @ v
        stretch = common * np.swapaxes(v, 1, 2) * size[:, None] @ v
        quaternions = [quaternion(rotation[0])]
        for turned in rotation[1:]:
            q = quaternion(turned)
            quaternions.append(q if q @ quaternions[-1] >= 0 else -q)
        return cls(matrices[:, :3, 3].T, np.stack(quaternions, axis=1), np.moveaxis(stretch, 0, -1))

    def matrix(self, time):
        """The (4, 4) at `time` in [0, 1]."""
        i, f = segment(self.place.shape[1], time)
        result = np.eye(4)
        q = between_rotations(self.rotation[:, i], self.rotation[:, i + 1], f)
        result[:3, :3] = rotation_matrix(q) @ self.stretch_at(time)
        result[:3, 3] = between(np.moveaxis(self.place, -1, 0), time)
        return result

    def stretch_at(self, time):
        """The stretch (3, 3) at `time` in [0, 1]."""
        return between(np.moveaxis(self.stretch, -1, 0), time)


def segment(count, time):
    """The key before `time` in [0, 1] of `count` >= 2, and the share of the way to the next one."""
    i = min(int(time * (count - 1)), count - 2)
    return i, time * (count - 1) - i


def between(keys, time):
    """What lies at `time` in [0, 1] on straight lines between `keys` (K, ...); nan between what is not finite."""
    i, f = segment(len(keys), time)
    with np.errstate(over="ignore", invalid="ignore"):
        return (1 - f) * keys[i] + f * keys[i + 1]


def quaternion(rotation):
    """The unit quaternion (w, x, y, z) of a rotation (3, 3): the eigenvector of the matrix of Bar-Itzhack 2000, exact to rounding."""
    m = np.asarray(rotation, np.float64)
    off = (m[2, 1] - m[1, 2], m[0, 2] - m[2, 0], m[1, 0] - m[0, 1])
    k = np.empty((4, 4))
    k[0, 0] = np.trace(m)
    k[0, 1:] = k[1:, 0] = off
    k[1:, 1:] = m + m.T - np.trace(m) * np.eye(3)
    q = np.linalg.eigh(k)[1][:, -1]
    return -q if q[np.argmax(np.abs(q))] < 0 else q


def axis_and_angle(a, b):
    """The rotation that leads from quaternions a to b (4, K), applied before a: its axis (3, K), unit or 0, and angle (K,) [rad]."""
    w, v = a[0] * b[0] + (a[1:] * b[1:]).sum(axis=0), a[0] * b[1:] - b[0] * a[1:] - np.cross(a[1:], b[1:], axis=0)
    size = np.linalg.norm(v, axis=0)
    return v / np.where(size > 0, size, 1), 2 * np.arctan2(size, w)


def between_rotations(a, b, f):
    """The quaternion (4,) that is the share f of the way from a to b (4,)."""
    w = a @ b
    across = b - w * a
    size = np.linalg.norm(across)
    angle = f * np.arctan2(size, w)
    return a * np.cos(angle) + across / (size or 1) * np.sin(angle)


def rotation_matrix(q):
    """Rotations (3, 3, ...) of unit quaternions (4, ...)."""
    w, x, y, z = q
    return np.stack(
        (
            np.stack((1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y))),
            np.stack((2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x))),
            np.stack((2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y))),
        )
    )
