"""Which things cover a pixel, and how much of it each: few of many, so only those that are met are remembered."""

import numpy as np

_BITS = np.int64(32)


class Ranks:
    """The coverage of P pixels by things that are known by float32 numbers other than 0.

    Summed in float64 and in the order of samples, so batches do not change a bit.
    """

    def __init__(self, pixels):
        self._pixels = pixels
        # Pixel and bits of the number in one key, ascending.
        self._keys, self._weights = np.zeros(0, np.int64), np.zeros(0)

    def add(self, first, number, weight):
        """Add `weight` (samples, pixels) of the things `number` (samples, pixels) to the pixels from `first` on; 0 is nothing."""
        pixel = np.broadcast_to(first + np.arange(number.shape[1]), number.shape)
        met = np.nonzero((number != 0) & (weight > 0))
        keys = pixel[met] << _BITS | np.ascontiguousarray(number, np.float32).view(np.uint32)[met].astype(np.int64)
        self._keys, place = np.unique(np.concatenate((self._keys, keys)), return_inverse=True)
        self._weights = np.bincount(place.ravel(), np.concatenate((self._weights, weight[met])), self._keys.size)

    def pairs(self, level):
        """(4, P) float64: number and weight of the things of rank 2 `level` and the next, those that cover most first; 0 for none."""
        pixel = self._keys >> _BITS
        order = np.lexsort((-self._weights, pixel))
        pixel = pixel.take(order)
        rank = np.arange(pixel.size) - np.searchsorted(pixel, pixel)
        number = (self._keys & np.int64(0xFFFFFFFF)).astype(np.uint32).view(np.float32)
        result = np.zeros((4, self._pixels))
        for row in (0, 1):
            own = np.nonzero(rank == 2 * level + row)[0]
            chosen = order.take(own)
            result[2 * row, pixel.take(own)] = number.take(chosen)
            result[2 * row + 1, pixel.take(own)] = self._weights.take(chosen)
        return result
