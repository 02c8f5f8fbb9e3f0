"""Files of lamp makers: IESNA LM-63, "Standard File Format for the Electronic Transfer of Photometric Data" (1986 to 2019)."""

import re

import numpy as np

from ..errors import FileError

CANDELA = 4 * np.pi / 177.83
"""What a candela is in the watts by which Blender counts bulbs: at 177.83 lm/W, that of daylight D65 in Cycles."""
BRIGHTEST = 1e30
"""Watts beyond which products no longer fit into single precision."""
_CLOSE = 2.0**-13
"""Degrees that make no difference."""
_TYPES = {1: "C", 2: "B", 3: "A"}


def parse_ies(text):
    """The tables of `textures.ies.IesTexture` in the text of a file: {"vertical", "horizontal", "intensity"}, float64.

    Photometry of the types A, B and C, completed by its symmetries and turned so that -z is straight down, as in Cycles.
    Raises FileError with the cause for what is no such file.
    """
    tilt = re.search(r"^[ \t]*TILT[ \t]*=[ \t]*(\S*)[^\n]*$", text, re.MULTILINE | re.IGNORECASE)
    if tilt is None:
        raise FileError("it has no line TILT=, which all IES files have")
    numbers = _Numbers(text[tilt.end() :])
    if tilt.group(1).upper() == "INCLUDE":
        numbers.take(1)
        numbers.take(2 * numbers.count("angles of tilt"))
    # Lamps, lumens of each, and the candela multiplier.
    *_, multiplier = numbers.take(3)
    rows, columns = numbers.count("vertical angles"), numbers.count("horizontal angles")
    kind = _TYPES.get(numbers.take(1)[0])
    if kind is None:
        raise FileError(f"its photometric type is none of {', '.join(f'{n} ({name})' for n, name in _TYPES.items())}")
    # Units, width, length, height of the lamp; the factors of its ballast; watts.
    *_, ballast, factor, _ = numbers.take(7)
    vertical, horizontal = numbers.take(rows), numbers.take(columns)
    with np.errstate(all="ignore"):
        intensity = numbers.take(rows * columns).reshape(columns, rows) * (multiplier * ballast * factor * CANDELA)
        vertical, horizontal, intensity = {"A": _type_a, "B": _type_b, "C": _type_c}[kind](vertical, horizontal, intensity)
        if vertical.size < 2 or horizontal.size < 2:
            raise FileError("it has a single angle, which is no table")
        if not all((np.diff(angles.astype(np.float32)) > 0).all() and np.isfinite(angles).all() for angles in (vertical, horizontal)):
            raise FileError("its angles do not grow, or are not finite")
    if not (np.abs(intensity) < BRIGHTEST).all():
        raise FileError("a candela is not finite, or beyond what is rendered")
    return {"vertical": vertical, "horizontal": horizontal, "intensity": np.ascontiguousarray(intensity)}


class _Numbers:
    """The numbers of a text, taken one after the other."""

    def __init__(self, text):
        self._words = text.replace(",", " ").split()
        self._start = 0

    def take(self, count):
        """The next `count`, (count,) float64."""
        words = self._words[self._start : self._start + count]
        if len(words) < count:
            raise FileError(f"it ends too early: {self._start + count} numbers are needed, it has {len(self._words)}")
        self._start += count
        try:
            return np.array([float(word) for word in words])
        except ValueError as error:
            raise FileError(f"a number is missing: {error}") from None

    def count(self, what):
        """The next, which says how many there are of something."""
        number = self.take(1)[0]
        if not (1 <= number <= len(self._words) and number == int(number)):
            raise FileError(f"its number of {what} is {number:g}")
        return int(number)


def _mirrored(angles, table, middle):
    """Angles (K,) from `middle` on, and the table (K, ...) with them, continued to the other side."""
    return np.concatenate((2 * middle - angles[:0:-1], angles)), np.concatenate((table[:0:-1], table))


def _continued(angles, table):
    """Angles up to a plane of symmetry, and the table with them, continued beyond it."""
    return np.concatenate((angles, 2 * angles[-1] - angles[-2::-1])), np.concatenate((table, table[-2::-1]))


def _type_a(vertical, horizontal, intensity):
    """The axis of the lamp is horizontal: vertical angles are from -90 to 90, horizontal ones to its left and right."""
    horizontal, intensity = 180 - horizontal[::-1], intensity[::-1]
    if abs(horizontal[-1] - 180) < _CLOSE:
        horizontal, intensity = _continued(horizontal, intensity)
    return vertical + 90, horizontal, intensity


def _type_b(vertical, horizontal, intensity):
    """The polar axis lies: what is vertical and what is horizontal change places. Whoever turns the lamp has it upright."""
    vertical, horizontal, intensity = horizontal + 90, vertical + 90, intensity.T
    if abs(horizontal[0] - 90) < _CLOSE:
        horizontal, intensity = _mirrored(horizontal, intensity, 90)
    if abs(vertical[0] - 90) < _CLOSE:
        vertical, intensity = _mirrored(vertical, intensity.T, 90)
        intensity = intensity.T
    return vertical, horizontal, intensity


def _type_c(vertical, horizontal, intensity):
    """From straight down, all around, a half, a quarter, or the same all around."""
    if abs(horizontal[0] - 90) < _CLOSE:
        horizontal = horizontal - 90
    if horizontal.size == 1:
        return vertical, np.array((0.0, 360.0)), np.repeat(intensity, 2, axis=0)
    for end in (90, 180):
        if abs(horizontal[-1] - end) < _CLOSE:
            horizontal, intensity = _continued(horizontal, intensity)
    gap = 360 - horizontal[-1]
    steps = horizontal[-1] - horizontal[-2], horizontal[1] - horizontal[0]
    if horizontal[0] < _CLOSE < gap and any(abs(step - gap) < _CLOSE for step in steps):
        # Some files leave out the last angle, which is the first.
        horizontal, intensity = np.append(horizontal, 360), np.concatenate((intensity, intensity[:1]))
    return vertical, horizontal, intensity
