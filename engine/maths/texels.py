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
    """

    rows: np.ndarray
    columns: np.ndarray

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
        return cls(np.append(0, discrete.cumulative(sums)).astype(np.float32), columns)

    def choose(self, u2):
        """Texels (row, column) (N,) for u2 (2, N), and a new u2 (2, N): the place of each number within its interval."""
        row = np.searchsorted(self.rows[1:], u2[1], side="right")
        width = self.columns.shape[1] - 1
        columns = self.columns.reshape(-1)
        # Each lane has a row of its own to search: all halve their intervals together.
        start = row * (width + 1)
        column = np.zeros_like(row)
        step = 1 << (width - 1).bit_length() >> 1
        while step:
            onwards = np.minimum(column + step, width)
            column += step * (columns.take(start + onwards) <= u2[0])
            step >>= 1
        start += column
        return row, column, np.stack((_place(columns, start, u2[0]), _place(self.rows, row, u2[1])))

    def probability(self, row, column):
        """The probability (N,) with which `choose` returns the texels (row, column), exactly."""
        at = row * self.columns.shape[1] + column
        columns = self.columns.reshape(-1)
        return (self.rows.take(row + 1) - self.rows.take(row)) * (columns.take(at + 1) - columns.take(at))


def _place(cdf, at, u1):
    low = cdf.take(at)
    return np.minimum((u1 - low) / (cdf.take(at + 1) - low), np.float32(ONE_MINUS_EPS32))
