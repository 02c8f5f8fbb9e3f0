"""One picture of parts that were rendered apart: of other samples each, of the same pixels."""

import re
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from .errors import SceneError, SceneWarning
from .registry import PASSES
from .rendering import Image

RANGE, SAMPLES = "glanz.sample_range", "glanz.samples"
ALIKE = (
    "scene",
    "camera",
    "integrator",
    "sampler",
    "samples",
    "seed",
    "max_depth",
    "clamp_direct",
    "clamp_indirect",
    "pixel_filter",
    "replicates",
    "adaptive_threshold",
    "requirements",
)
"""What files of parts must say alike, under `glanz.`: else they are no parts of one picture."""
_LEVEL = re.compile(r"(Crypto[A-Za-z]+)(\d\d)")


@dataclass(frozen=True, slots=True, eq=False)
class Part:
    """A picture of the samples first .. end - 1 of each pixel: `image`; `name` is what errors call it."""

    name: str
    image: Image
    first: int
    end: int

    @classmethod
    def of(cls, name, image):
        """The part that `image` says to be in its metadata. Raises SceneError for a picture that does not say it."""
        found = re.fullmatch(r"(\d+),(\d+)", image.metadata.get(RANGE, ""))
        if not found or int(found[1]) >= int(found[2]):
            raise SceneError(f"'{name}' does not say which samples it has: it is not of Glanz's command line, or has been merged already")
        if image.metadata.get("glanz.reached.ended_by", "samples") != "samples":
            raise SceneError(f"'{name}' was ended before it had all of its samples, so its pixels may have unlike numbers of them")
        return cls(name, image, int(found[1]), int(found[2]))

    @property
    def samples(self):
        """How many of each pixel."""
        return self.end - self.first


def merged(parts):
    """The `Image` of all `parts`, weighed by their samples, in any order.

    Means are those of one render, but for float32; so are the shares of light by colours where these are there too. Errors of
    independent parts add up. Raises SceneError for parts that do not belong together, or have samples in common.
    """
    parts = sorted(parts, key=lambda part: part.first)
    _check(parts)
    total = sum(part.samples for part in parts)
    weights = np.array([part.samples / total for part in parts])
    warnings, passes = [], {}
    for key in parts[0].image.passes:
        p = PASSES[key]
        values = np.stack([part.image.passes[key] for part in parts]).astype(np.float64)
        if p.reduction == "ranks":
            continue
        if p.reduction == "first":
            result = values[0]
        elif p.reduction == "sum":
            result = values.sum(axis=0)
        elif p.reduction == "replicates":
            result = np.sqrt(np.tensordot(weights**2, values**2, 1))
        elif p.divided_by in parts[0].image.passes and p.divided_by != key:
            by = np.stack([part.image.passes[p.divided_by] for part in parts])[..., : values.shape[-1]] * weights[:, None, None, None]
            whole = by.sum(axis=0, dtype=np.float64)
            result = np.divide((values * by).sum(axis=0), whole, out=np.zeros_like(whole), where=whole != 0)
        else:
            if p.divided_by:
                warnings.append(SceneWarning(f"the pass {key} is merged by samples, as what it is a share of is in no file"))
            result = np.tensordot(weights, values, 1)
        passes[key] = result.astype(np.float32)
    passes |= _coverage(parts, weights)
    first, end = parts[0].first, parts[-1].end
    if end - first != total:
        missing = [f"{a.end} to {b.first - 1}" for a, b in pairwise(parts) if a.end != b.first]
        warnings.append(SceneWarning(f"samples {', '.join(missing)} are in no file"))
    image = parts[0].image
    metadata = image.metadata | {RANGE: f"{first},{end}" if end - first == total else f"{total} of {first},{end}"}
    metadata |= {"glanz.reached.samples": str(total), "glanz.reached.error": "not measured"}
    return Image(image.width, image.height, {key: passes[key] for key in image.passes}, metadata, tuple(warnings))


def _check(parts):
    first = parts[0]
    for part in parts[1:]:
        if (part.image.width, part.image.height) != (first.image.width, first.image.height):
            sizes = (f"{image.width}x{image.height}" for image in (first.image, part.image))
            raise SceneError(f"'{first.name}' and '{part.name}' are no parts of one picture: {' and '.join(sizes)} pixels")
        if part.image.passes.keys() != first.image.passes.keys():
            other = ", ".join(sorted(part.image.passes.keys() ^ first.image.passes.keys()))
            raise SceneError(f"'{first.name}' and '{part.name}' are no parts of one picture: only one of them has {other}")
        for name in ALIKE:
            one, other = (p.image.metadata.get(f"glanz.{name}") for p in (first, part))
            if one != other:
                raise SceneError(f"'{first.name}' and '{part.name}' are no parts of one picture: {name} {one!r} and {other!r}")
    for one, other in pairwise(parts):
        if other.first < one.end:
            last = min(one.end, other.end) - 1
            raise SceneError(f"'{one.name}' and '{other.name}' both have the samples {other.first} to {last}")


def _coverage(parts, weights):
    """The passes of what covers most, {key: (H, W, 4) float32}, each thing by all of its shares that the parts have."""
    levels = {}
    for key in parts[0].image.passes:
        if found := _LEVEL.fullmatch(key):
            levels.setdefault(found[1], []).append(key)
    result = {}
    for keys in levels.values():
        keys = sorted(keys)
        height, width = parts[0].image.height, parts[0].image.width
        numbers, shares = [], []
        for part, weight in zip(parts, weights):
            pairs = np.concatenate([part.image.passes[key] for key in keys], axis=-1).reshape(height * width, -1)
            numbers.append(np.ascontiguousarray(pairs[:, ::2]).view(np.uint32))
            shares.append(pairs[:, 1::2].astype(np.float64) * weight)
        merged_pairs = _ranked(np.concatenate(numbers, axis=1), np.concatenate(shares, axis=1), 2 * len(keys))
        for level, key in enumerate(keys):
            result[key] = merged_pairs[:, 4 * level : 4 * level + 4].reshape(height, width, 4)
    return result


def _ranked(numbers, shares, count):
    """The `count` numbers of most share in each of P pixels, (P, 2 count) float32 in pairs; numbers (P, M) uint32, shares (P, M)."""
    pixels, several = numbers.shape
    key = np.repeat(np.arange(pixels, dtype=np.int64), several) << 32 | numbers.ravel().astype(np.int64)
    known, place = np.unique(key, return_inverse=True)
    share = np.bincount(place.ravel(), shares.ravel(), known.size)
    kept = np.nonzero((known & 0xFFFFFFFF != 0) & (share > 0))[0]
    known, share = known[kept], share[kept]
    order = np.lexsort((-share, known >> 32))
    pixel = known[order] >> 32
    rank = np.arange(pixel.size) - np.searchsorted(pixel, pixel)
    inside = rank < count
    result = np.zeros((pixels, count, 2), np.float32)
    where = pixel[inside], rank[inside]
    result[(*where, 0)] = (known[order][inside] & 0xFFFFFFFF).astype(np.uint32).view(np.float32)
    result[(*where, 1)] = share[order][inside]
    return result.reshape(pixels, 2 * count)
