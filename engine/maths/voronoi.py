"""Cells around random points of a lattice (Worley 1996, "A Cellular Texture Basis Function"), with the very numbers of Blender's.

Each unit cell of the lattice holds one point. All functions take p (D, N) float32, D = 1 to 4, and look at cells one by one,
so that what they need does not grow with the 5^4 cells of four dimensions. Smooth minimum: Quilez 2013, "Smooth minimum";
distance to edges: Quilez 2012, "Voronoi edges".
"""

from dataclasses import dataclass
from itertools import product

import numpy as np

from .cellhash import pcg, unit, unit3, whole

_LEAST_GAP = np.float32(0.0001)
"""Blender's: the square of how far apart two points are to have an edge between them."""


def _sum(rows):
    # Term by term, as what NumPy's sums round depends on the number of lanes.
    total = rows[0]
    for row in rows[1:]:
        total = total + row
    return total


def _largest(rows):
    return np.maximum.reduce(rows)


def _square(way, exponent):
    return _sum(way * way)


def _manhattan(way, exponent):
    return _sum(np.abs(way))


def _chebychev(way, exponent):
    return _largest(np.abs(way))


def _powers(way, exponent):
    return _sum(np.abs(way) ** exponent)


METRICS = {
    "euclidean": (_square, lambda total, exponent: np.sqrt(total)),
    "manhattan": (_manhattan, lambda total, exponent: total),
    "chebychev": (_chebychev, lambda total, exponent: total),
    "minkowski": (_powers, lambda total, exponent: total ** (1 / exponent)),
}
"""How long a way (D, N) is: a measure that grows with its length, and the length (N,) of that measure."""


@dataclass(frozen=True)
class Shape:
    """What cells look like; numbers are float32, (1,) or (N,).

    randomness  how far points stray over their cells, 0 to 1
    metric      see METRICS
    exponent    of the metric "minkowski"
    smoothness  over what part of a cell neighbours blend, 0 to 1/2
    is_integer  points come from hashes of whole numbers, as from Blender 5.0 on; else of floats
    """

    randomness: object = 1.0
    metric: str = "euclidean"
    exponent: object = 0.5
    smoothness: object = 0.5
    is_integer: bool = True

    def measure(self, way):
        """What grows with the length of a way (D, N), (N,)."""
        return METRICS[self.metric][0](way, self.exponent)

    def length(self, way):
        """The length (N,) of a way (D, N)."""
        return METRICS[self.metric][1](self.measure(way), self.exponent)


class _Lattice:
    """The cells around points p (D, N): `local` is where the points are in theirs."""

    def __init__(self, p, shape):
        self.shape, self.cell = shape, np.floor(p)
        self.local = p - self.cell
        # One dimension hashes floats in all versions.
        self.is_integer = shape.is_integer and len(p) > 1
        self._whole = whole(self.cell) if self.is_integer else None

    def numbers(self, offset):
        """What is random about the cells at `offset` (D, 1) or (D, N) int32: (D, N) in [0, 1]."""
        if self.is_integer:
            return pcg(self._whole + offset)
        return _float_numbers(self.cell + offset.astype(np.float32))

    def point(self, offset, numbers=None):
        """The points (D, N) of the cells at `offset`, seen from the cell of p."""
        numbers = self.numbers(offset) if numbers is None else numbers
        return offset.astype(np.float32) + numbers * self.shape.randomness

    def colour(self, offset, numbers=None, lanes=slice(None)):
        """The colours (3, N) of the cells at `offset`, of some `lanes` alone."""
        if not self.is_integer:
            return unit3(*(self.cell[:, lanes] + offset.astype(np.float32)))
        if len(self.cell) > 2:
            return (self.numbers(offset) if numbers is None else numbers)[:3, lanes]
        cell = self._whole[:, lanes] + offset
        return pcg(np.concatenate((cell, np.zeros_like(cell[:1]))))


def _float_numbers(cell):
    if len(cell) == 4:
        x, y, z, w = cell
        return np.stack((unit(x, y, z, w), unit(w, x, y, z), unit(z, w, x, y), unit(y, z, w, x)))
    return np.stack([unit(*cell, *seed) for seed in ((), (1,), (2,))[: len(cell)]])


def _around(dimensions, reach=1):
    """Offsets (D, 1) int32 of all cells at most `reach` away, the first coordinate fastest, as Blender visits them."""
    sides = range(-reach, reach + 1)
    return [np.array(step[::-1], np.int32)[:, None] for step in product(sides, repeat=dimensions)]


def _nearest(lattice, measure, offsets, centre=0):
    """The offsets (D, N) of the nearest and the second nearest point, by the measure of the way to each; the first of equals."""
    n = lattice.local.shape[1]
    first, second = (np.full(n, np.finfo(np.float32).max) for _ in range(2))
    which, next_ = (np.zeros(n, np.intp) for _ in range(2))
    for k, offset in enumerate(offsets):
        size = measure(lattice.point(offset + centre))
        is_nearest, is_next = size < first, size < second
        np.copyto(second, size, where=is_next)
        np.copyto(next_, k, where=is_next)
        np.copyto(second, first, where=is_nearest)
        np.copyto(next_, which, where=is_nearest)
        np.copyto(first, size, where=is_nearest)
        np.copyto(which, k, where=is_nearest)
    table = np.concatenate(offsets, axis=1)
    return table.take(which, axis=1) + centre, table.take(next_, axis=1) + centre


def _found(lattice, offset):
    point = lattice.point(offset)
    return lattice.shape.length(point - lattice.local), lattice.colour(offset), point + lattice.cell


def f1(p, shape):
    """The distance (N,) to the nearest point, its colour (3, N) and its position (D, N)."""
    lattice = _Lattice(p, shape)
    offset, _ = _nearest(lattice, lambda point: shape.measure(point - lattice.local), _around(len(p)))
    return _found(lattice, offset)


def f2(p, shape):
    """The same of the second nearest point."""
    lattice = _Lattice(p, shape)
    _, offset = _nearest(lattice, lambda point: shape.length(point - lattice.local), _around(len(p)))
    return _found(lattice, offset)


def smooth_f1(p, shape):
    """`f1` without edges: over all cells nearby, smooth minima of distances, with colours and positions blended alike.

    Where the smoothness is 0 it is `f1`.
    """
    lattice = _Lattice(p, shape)
    smoothness = np.broadcast_to(shape.smoothness, p.shape[1:])
    is_smooth = smoothness > 0
    divisor = np.where(is_smooth, smoothness, 1)
    result = None
    for offset in _around(len(p), reach=2):
        numbers = lattice.numbers(offset)
        point = lattice.point(offset, numbers)
        distance = shape.length(point - lattice.local)
        if result is None:
            distance = np.where(is_smooth, distance, np.finfo(np.float32).max)
            result = np.concatenate((distance[None], lattice.colour(offset, numbers), point))
            continue
        gap = result[0] - distance
        # Most cells are too far away to count.
        h = np.where(is_smooth, np.float32(0.5) + np.float32(0.5) * gap / divisor, (gap > 0) & (np.abs(offset).max() < 2))
        lanes = np.nonzero(h > 0)[0]
        if not lanes.size:
            continue
        h = np.minimum(h.take(lanes), 1)
        h = h * h * (3 - 2 * h)
        colour = lattice.colour(offset, numbers, lanes)
        other = np.concatenate((distance.take(lanes)[None], colour, point.take(lanes, axis=1)))
        k = smoothness.take(lanes)
        correction = k * h * (1 - h)
        mixed = result.take(lanes, axis=1)
        mixed = (1 - h) * mixed + h * other
        mixed[0] -= correction
        mixed[1:] -= correction / (1 + 3 * k)
        result[:, lanes] = mixed
    return result[0], result[1:4], result[4:] + lattice.cell


def edge_distance(p, shape):
    """The distance (N,) to the nearest edge between cells."""
    lattice, offsets = _Lattice(p, shape), _around(len(p))
    if len(p) == 1:
        left, middle, right = (lattice.point(offset)[0] for offset in offsets)
        return np.minimum(*(np.abs((middle + other) / 2 - lattice.local[0]) for other in (left, right)))
    nearest, _ = _nearest(lattice, lambda point: _square(point - lattice.local, None), offsets)
    to_nearest = lattice.point(nearest) - lattice.local
    result = np.full(p.shape[1], np.finfo(np.float32).max)
    for offset in offsets:
        way = lattice.point(offset) - lattice.local
        across = way - to_nearest
        gap = _square(across, None)
        has_edge = gap > _LEAST_GAP
        distance = _sum((to_nearest + way) / 2 * across) / np.sqrt(np.where(has_edge, gap, 1))
        np.minimum(result, distance, out=result, where=has_edge)
    return result


def sphere_radius(p, shape):
    """The radius (N,) of the largest sphere around the nearest point that meets no sphere like it around another."""
    lattice, offsets = _Lattice(p, shape), _around(len(p))
    centre, _ = _nearest(lattice, lambda point: _square(point - lattice.local, None), offsets)
    point = lattice.point(centre)
    others = [offset for offset in offsets if offset.any()]
    neighbour, _ = _nearest(lattice, lambda other: _square(other - point, None), others, centre)
    return np.sqrt(_square(lattice.point(neighbour) - point, None)) / 2


FEATURES = {"f1": f1, "f2": f2, "smooth f1": smooth_f1}


def _scales(detail, roughness, lacunarity):
    """Scale, amplitude and share of each octave, the shares from 0 to 1."""
    scale = amplitude = np.float32(1)
    for i in range(int(np.ceil(detail.max(initial=0))) + 1 if roughness.any() else 1):
        yield scale, amplitude, np.clip(detail - np.float32(i - 1), 0, 1)
        scale, amplitude = scale * lacunarity, amplitude * roughness


def fractal_cells(p, feature, shape, detail, roughness, lacunarity, is_normalized):
    """Octaves of a feature (see FEATURES) of cells: the sum of distances (N,), of colours (3, N), and positions (D, N) blended."""
    distance, colour, position, most = np.float32(0), np.float32(0), np.float32(0), np.float32(0)
    for scale, amplitude, share in _scales(detail, roughness, lacunarity):
        octave = FEATURES[feature](p * scale, shape)
        amplitude = share * amplitude
        most = most + amplitude
        distance = distance + octave[0] * amplitude
        colour = colour + octave[1] * amplitude
        position = position + (octave[2] / scale - position) * amplitude
    if is_normalized:
        distance = distance / (most * _most_distance(len(p), shape) * np.float32(2 if feature == "f2" else 1))
        colour = colour / most
    return distance, colour, position


def _most_distance(dimensions, shape):
    reach = np.float32(0.5) + np.float32(0.5) * np.atleast_1d(shape.randomness)
    return reach if dimensions == 1 else shape.length(np.stack((reach,) * dimensions))


def fractal_edges(p, shape, detail, roughness, lacunarity, is_normalized):
    """Octaves of the distance to edges, (N,): finer edges inside the coarser cells."""
    reach = np.float32(0.5) + np.float32(0.5) * shape.randomness
    distance, most = np.float32(8), reach
    for scale, amplitude, share in _scales(detail, roughness, lacunarity):
        amplitude = share * amplitude
        nearer = np.minimum(distance, edge_distance(p * scale, shape) / scale)
        distance = distance + (nearer - distance) * amplitude
        most = most + (reach / scale - most) * amplitude
    return distance / most if is_normalized else distance
