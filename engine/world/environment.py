"""The picture around a scene as a light: looked up where rays escape, and sampled in proportion to what it gives."""

from dataclasses import dataclass

import numpy as np

from ..constants import LUMINANCE, PI
from ..maths import interpolation
from ..maths.equirect import direction_to_square, square_to_direction, square_to_direction_pdf
from ..maths.texels import Texels

_AT_ONCE = 2**20
"""Texels that are weighed at once."""
_LEAST_PDF = np.float32(2.0**-80)
"""Only where rounding puts a place on the rim of a texel, and there is no light, is a density smaller."""
_WAYS = {
    "linear": (interpolation.linear_texels, interpolation.linear_place),
    "closest": (interpolation.nearest_texels, interpolation.nearest_place),
}


@dataclass(frozen=True, slots=True, eq=False)
class Environment:
    """Radiance from every direction: strength * picture + background. It stands among the `Lights` as their only one of its kind.

    pixels          (3, H * W) float32
    shape           (H, W)
    world_from_map  (3, 3) float32, orthogonal; render space has the axes of the world
    strength        (3, 1) float32
    background      (3, 1) float32
    texels          how a texel is chosen: by its luminance times its solid angle
    flux            luminance times solid angle, all around [W m^-2], as a vector (4,): of all directions, and their sum
    look, place     the two sides of `maths.interpolation`
    """

    pixels: np.ndarray
    shape: tuple
    world_from_map: np.ndarray
    strength: np.ndarray
    background: np.ndarray
    texels: Texels
    flux: np.ndarray
    look: object
    place: object

    @classmethod
    def of(cls, world):
        """From a `World` whose environment gives light."""
        picture = world.environment
        _, height, width = picture.pixels.shape
        flux = np.zeros(4)
        texels = Texels.of(_weights(world, flux), (height, width))
        flux[:3] = picture.world_from_map @ flux[:3]
        look, place = _WAYS[picture.interpolation]
        return cls(
            pixels=picture.pixels.reshape(3, -1),
            shape=(height, width),
            world_from_map=picture.world_from_map.astype(np.float32),
            strength=np.array(picture.strength, np.float32)[:, None],
            background=np.array(world.radiance, np.float32)[:, None],
            texels=texels,
            flux=flux,
            look=look,
            place=place,
        )

    def radiance(self, d):
        """L (3, N) of rays that escape along d (3, N)."""
        return self._look_up(*direction_to_square(_matmul(self.world_from_map.T, d)))[0]

    def hit(self, d):
        """L (3, N), and the density (N,) [sr^-1] with which `sample` finds d (3, N)."""
        u, v = direction_to_square(_matmul(self.world_from_map.T, d))
        L, probability = self._look_up(u, v, weighed=True)
        return L, self._pdf(probability, v)

    def sample(self, p, u2):
        """See `interfaces.Light.sample`."""
        row, column, u2 = self.texels.choose(u2)
        u, v = self.place(row, column, u2, self.shape)
        L, probability = self._look_up(u, v, weighed=True)
        pdf = self._pdf(probability, v)
        wi = _matmul(self.world_from_map, square_to_direction(u, v))
        return wi, np.full_like(pdf, np.inf), L / pdf, pdf

    def power(self, radius=1.0):
        """See `interfaces.Light.power`: what passes a cross-section pi r^2, as luminance."""
        return (PI * radius**2 * self.flux[3],) * 3

    def weight(self, frame):
        """See `interfaces.Light.weight`: the irradiance of a surface that faces the brightest side, as luminance.

        What comes from one direction counts in full, what comes from all directions a quarter, as under an even sky.
        """
        towards = float(np.linalg.norm(self.flux[:3]))
        irradiance = towards + 0.25 * (float(self.flux[3]) - towards)
        nowhere = (0.0, 0.0, 0.0)
        return {"centre": nowhere, "power": (irradiance,) * 3, "nearness": 0.0, "radius2": 1.0, "axis": nowhere, "cos_edge": -1.0}

    def _look_up(self, u, v, weighed=False):
        """L (3, N) at u, v, and if `weighed` the interpolated probability of a texel (N,)."""
        L, probability = 0, 0
        for row, column, weight in self.look(u, v, self.shape):
            texel = row * self.shape[1]
            texel += column
            part = self.pixels.take(texel, axis=1, mode="clip").astype(u.dtype, copy=False)
            part *= weight
            L = L + part
            if weighed:
                probability = probability + self.texels.shares.take(texel, mode="clip") * weight
        L *= self.strength
        L += self.background
        return L, probability

    def _pdf(self, probability, v):
        height, width = self.shape
        # At the poles a texel has hardly any solid angle.
        with np.errstate(over="ignore"):
            return np.maximum(probability * np.float32(height * width) * square_to_direction_pdf(v), _LEAST_PDF)


def _weights(world, flux):
    """What each texel weighs, (h, W) for h rows at a time; adds the vector and the sum of all to `flux` (4,) on the way."""
    picture = world.environment
    _, height, width = picture.pixels.shape
    tint, even = np.multiply(LUMINANCE, picture.strength), np.dot(LUMINANCE, world.radiance)
    # The mean direction over the width of a pixel is shorter than 1.
    across = square_to_direction((np.arange(width) + 0.5) / width, np.array([0.5])) * np.sinc(1 / width)
    step = max(1, _AT_ONCE // width)
    for first in range(0, height, step):
        edges = np.arange(first, min(first + step, height) + 1) / height
        down = square_to_direction(np.array([0.5]), 0.5 * (edges[:-1] + edges[1:]))
        weights = np.tensordot(tint, picture.pixels[:, first : first + step].astype(np.float64), 1)
        weights += even
        weights *= (2 * PI / width) * -np.diff(np.cos(PI * edges))[:, None]
        flux[:2] += across[:2] @ (down[0] @ weights)
        flux[2:] += down[2] @ weights.sum(axis=1), weights.sum()
        yield weights


def _matmul(matrix, d):
    # Not `@`: BLAS may add in another order where there are few lanes, and the picture would depend on the tiles.
    return np.stack([row[0] * d[0] + row[1] * d[1] + row[2] * d[2] for row in matrix])
