"""Materials whose textures ask no more of a point than how it is looked at: tables instead of textures.

What a layer reflects depends on the cosine of the ray to the shading normal, and on the side that it meets; where its inputs are
constants, on nothing else. Then all that textures do at a point is done beforehand for a row of cosines: the parameters of all lobes,
within the light that there is, and the probabilities of the lobes. A lookup is linear in the root of the cosine, as the tables of
`maths.ggx` are, whose entries are among its own. A material that it does not meet to `_TOLERANCE` keeps its textures.
"""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np

from ..arrays import Columns
from ..maths.ggx import COSINES
from ..maths.vectors import dot
from ..scene.graphs import is_texture
from ..scene.points import Points
from ..scene.textured import is_isotropic
from .filling import filled_in
from .materials import Lobe, thresholds_of

_STEPS = 16 * (COSINES - 1)
"""From the horizon to the zenith. What Principled materials reflect is met to 5e-6 (measured)."""
_TOLERANCE = 2.0**-10
"""Of a value, or of 1/16 of the largest of its parameter: half-way between the entries a table may be that far off."""


@dataclass(frozen=True, slots=True, eq=False)
class ByCosine:
    """All lobes of all materials, seen from any cosine.

    lobes           (bsdf, {parameter: its rows of `values`}) of each lobe; the probabilities of the lobes are the last rows
    rough           how many of the lobes have a width
    kind            that of the `Reflection`
    values, slopes  (C, K) float32, and how much they change to the next column
    first           (2 M,) int32: the first column of each material as seen from the front, then of each from the back
    steps           (M,) float32: on to the column of the zenith; 0 for materials that are the same from everywhere
    """

    lobes: tuple
    rough: int
    kind: type
    values: np.ndarray
    slopes: np.ndarray
    first: np.ndarray
    steps: np.ndarray

    def at(self, surface):
        """The `Reflection` of a `Surface`, see `Materials.at`."""
        x = np.sqrt(np.abs(dot(surface.ns, surface.wo)))
        x *= self.steps.take(surface.material)
        column = x.astype(np.int32)
        x -= column
        column += self.first.take(np.where(surface.is_front, surface.material, surface.material + self.steps.size))
        # Cut off: what is no number has no column either.
        values = self.slopes.take(column, axis=1, mode="clip")
        values *= x
        values += self.values.take(column, axis=1, mode="clip")
        lobes = tuple(Lobe(bsdf, Columns(**{name: values[rows] for name, rows in names.items()})) for bsdf, names in self.lobes)
        shares = values[-len(lobes) :]
        return self.kind(lobes[: self.rough], lobes[self.rough :], thresholds_of(shares), shares)


def tabulated(materials, around=()):
    """The `ByCosine` of `Materials`, None where there is nothing to tabulate, and the materials without the textures of that.

    `around` are the rows of those that depend on the media which really meet at a boundary, where these are not known.
    """
    rows = [row for row in materials.textured if row not in around and _is_isotropic(materials, row)]
    found = {row: table for row in rows if (table := _table(materials, row))}
    if not found:
        return None, materials
    constant, names = _stacked(materials.lobes, materials.shares, materials.emission.shape[1])
    values, first = [constant], np.tile(np.arange(constant.shape[1], dtype=np.int32), (2, 1))
    for row, sides in found.items():
        for side, seen in enumerate(sides):
            first[side:, row] = sum(part.shape[1] for part in values)
            values.append(seen)
    slopes = [np.zeros_like(constant), *(np.diff(part, axis=1, append=part[:, -1:]) for part in values[1:])]
    steps = np.zeros(constant.shape[1], np.float32)
    steps[list(found)] = _STEPS
    lobes = tuple((lobe.bsdf, rows) for lobe, rows in zip(materials.lobes, names))
    values, slopes = np.concatenate(values, axis=1), np.concatenate(slopes, axis=1)
    table = ByCosine(lobes, materials.rough_lobes, materials.kind, values, slopes, first.ravel(), steps)
    return table, replace(materials, textured={row: t for row, t in materials.textured.items() if row not in found})


def _is_isotropic(materials, row):
    textures = [*(t.texture for t in materials.textured[row]), *filter(is_texture, materials.straight[row])]
    # Textures are looked up before reliefs bend the normals.
    return row not in materials.relief and all(map(is_isotropic, textures))


def _table(materials, row):
    """What is in the columns of one material by the cosine, (C, _STEPS + 1): from the front, and from the back if that differs.

    Nothing where the lines between the entries are too far from what they stand for.
    """
    sides = []
    for is_front in (True, False):
        at = _Sights(row, is_front)
        with np.errstate(all="ignore"):
            seen = filled_in(materials, materials.at(at.surface), at.count, [(row, np.arange(at.count), at)])
        values, _ = _stacked((*seen.rough, *seen.specular), seen.shares, at.count)
        # Where nothing is reflected the probabilities leap; they are right for any values.
        if not _is_met(values[: -len(seen.shares)]):
            return ()
        sides.append(values[:, ::2])
    return sides[:1] if np.array_equal(*sides) else sides


def _is_met(values):
    """Whether every other column of (C, 2 K + 1) is a mean of its neighbours."""
    entries, between = values[:, ::2], values[:, 1::2]
    size, largest = np.abs(between), np.abs(entries).max(axis=1, keepdims=True)
    deviation = np.abs(0.5 * (entries[:, 1:] + entries[:, :-1]) - between)
    return bool((deviation <= _TOLERANCE * np.maximum(size, largest / 16)).all())


def _stacked(lobes, shares, count):
    """The parameters of all lobes and their probabilities as rows (C, count), and {parameter: its rows} of each lobe."""
    rows, names = [], []
    for lobe in lobes:
        names.append({})
        for name, column in vars(lobe.k).items():
            height = len(column) if column.ndim > 1 else 1
            at = sum(map(len, rows))
            names[-1][name] = slice(at, at + height) if column.ndim > 1 else at
            rows.append(np.broadcast_to(column, (height, count)))
    return np.concatenate((*rows, np.broadcast_to(shares, (len(lobes), count)))), names


class _Sights(Points):
    """A plane of the material `row`, seen from its front or back at cosines whose roots go from 0 to 1, at the entries and half-way."""

    count = 2 * _STEPS + 1

    def __init__(self, row, is_front):
        super().__init__()
        cos = np.square(np.linspace(0, 1, self.count)).astype(np.float32)
        self.d = np.stack((np.sqrt(1 - cos * cos), np.zeros_like(cos), -cos))
        up = np.float32([[0], [0], [1]])
        material = np.full(self.count, row)
        self.surface = SimpleNamespace(n=up, ns=up, is_front=np.full(self.count, is_front), material=material)
