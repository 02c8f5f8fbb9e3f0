"""Which things cover a pixel, and how much of it each: few of many, so only those that are met are remembered."""

import numpy as np

_BITS = np.int64(32)
_BLOCK = 2**16
"""Pixels whose things are kept together: few enough to be sorted in by every batch."""
_NOTHING = np.zeros(0, np.int64), np.zeros(0)


class Ranks:
    """The coverage of P pixels by things that are known by float32 numbers other than 0.

    Summed in float64 and in the order of samples, so batches do not change a bit.
    """

    def __init__(self, pixels):
        self._pixels = pixels
        # By block of pixels: keys, pixel and bits of the number in one, and their weights.
        self._blocks = {}

    def add(self, pixels, number, weight):
        """Add `weight` (samples, M) of the things `number` (samples, M) to `pixels` (M,), each once; 0 is nothing."""
        pixel = np.broadcast_to(pixels, number.shape)
        # Samples where a pixel filter is negative take away, here as in the picture.
        met = np.nonzero((number != 0) & (weight != 0))
        keys = pixel[met] << _BITS | np.ascontiguousarray(number, np.float32).view(np.uint32)[met].astype(np.int64)
        weight, block = weight[met], pixel[met] // _BLOCK
        for number_of_block in np.unique(block).tolist():
            own = block == number_of_block
            known, weights = self._blocks.get(number_of_block, _NOTHING)
            known, place = np.unique(np.concatenate((known, keys[own])), return_inverse=True)
            self._blocks[number_of_block] = known, np.bincount(place.ravel(), np.concatenate((weights, weight[own])), known.size)

    def state(self):
        """{name: array} of all that has been added, from which `restore` goes on."""
        keys, weights = (np.concatenate(columns) for columns in zip(*(self._blocks.values() or (_NOTHING,))))
        return {"keys": keys, "weights": weights}

    def restore(self, state):
        """Go on from a `state`."""
        block = (state["keys"] >> _BITS) // _BLOCK
        self._blocks = {int(b): (state["keys"][block == b], state["weights"][block == b]) for b in np.unique(block)}

    def pairs(self, level):
        """(4, P) float64: number and weight of the things of rank 2 `level` and the next, those that cover most first; 0 for none."""
        keys, weights = (np.concatenate(columns) for columns in zip(*(self._blocks.values() or (_NOTHING,))))
        weights = np.maximum(weights, 0)
        pixel = keys >> _BITS
        order = np.lexsort((-weights, pixel))
        pixel = pixel.take(order)
        rank = np.arange(pixel.size) - np.searchsorted(pixel, pixel)
        number = (keys & np.int64(0xFFFFFFFF)).astype(np.uint32).view(np.float32)
        result = np.zeros((4, self._pixels))
        for row in (0, 1):
            own = np.nonzero(rank == 2 * level + row)[0]
            chosen = order.take(own)
            result[2 * row, pixel.take(own)] = number.take(chosen)
            result[2 * row + 1, pixel.take(own)] = weights.take(chosen)
        return result
