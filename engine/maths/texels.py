"""Choosing a texel of a picture in proportion to its weight: first its row, then its column (pbrt 4th ed., A.5.6)."""

from dataclasses import dataclass

import numpy as np

from ..constants import ONE_MINUS_EPS32
from . import discrete


@dataclass(frozen=True, slots=True, eq=False)
class Texels:
    """The distributions of a picture of H x W texels, made as `discrete.cumulative` makes them, after a 0.

    rows     (H + 1,) float32
    columns  (H, W + 1) float32, within each row
    shares   (H * W,) float32: the probability with which `choose` returns each texel, exactly
    """

    rows: np.ndarray
    columns: np.ndarray
    shares: np.ndarray

    @classmethod
    def of(cls, weights, shape):
        """From the weights >= 0, not all 0, of a picture of `shape` (H, W): an iterable of (h, W), a few rows at a time.

        So a picture may be larger than what should be held in float64.
        """
        height, width = shape
        columns = np.zeros((height, width + 1), np.float32)
        sums = []
        for part in weights:
            row_sums = part.sum(axis=1)
            # A row without weight is never chosen, whatever its columns.
            part = np.where(row_sums[:, None] > 0, part, 1)
            columns[len(sums) : len(sums) + len(part), 1:] = discrete.cumulative(part)
            sums.extend(row_sums)
        rows = np.append(0, discrete.cumulative(sums)).astype(np.float32)
        shares = np.diff(columns)
        shares *= np.diff(rows)[:, None]
        return cls(rows, columns, shares.ravel())

    def choose(self, u2):
        """Texels (row, column) (N,) for u2 (2, N), and a new u2 (2, N): the place of each number within its interval."""
        row = np.searchsorted(self.rows[1:], u2[1], side="right")
        width = self.columns.shape[1] - 1
        columns = self.columns.reshape(-1)
        # Each lane has a row of its own to search: all halve their intervals together.
        start = row * (width + 1)
        end = start + width
        place = start.copy()
        step = 1 << (width - 1).bit_length() >> 1
        while step:
            onwards = place + step
            np.minimum(onwards, end, out=onwards)
            place += step * (columns.take(onwards, mode="clip") <= u2[0])
            step >>= 1
        return row, place - start, np.stack((_place(columns, place, u2[0]), _place(self.rows, row, u2[1])))


def _place(cdf, at, u1):
    low = cdf.take(at)
    return np.minimum((u1 - low) / (cdf.take(at + 1) - low), np.float32(ONE_MINUS_EPS32))
