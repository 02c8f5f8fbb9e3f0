"""Arrays inside a scene file: the small ones as JSON lists, the others as .npy entries."""

import io
import math

import numpy as np

from ..errors import FileError

KINDS = "biuf"
"""Kinds of dtypes that may be stored: truth values, whole numbers, floating-point numbers."""
INLINE = 16
"""Arrays of up to so many finite numbers, such as matrices, stand in the JSON itself."""


class ArrayWriter:
    """Turns arrays into JSON; `add(name, bytes)` receives each distinct large one once, and keeps none."""

    def __init__(self, add):
        self._add = add
        self._names = {}
        self._kept = []

    def encode(self, array):
        """The JSON for `array`; raises TypeError for a dtype that is not numeric."""
        if array.dtype.kind not in KINDS or array.dtype.itemsize > 8:
            raise TypeError(f"arrays of {array.dtype} cannot be stored")
        array = np.ascontiguousarray(array).reshape(array.shape)  # the reshape keeps shape () as it is
        array = array.astype(array.dtype.newbyteorder("<"), copy=False)
        if array.size <= INLINE and (array.dtype.kind != "f" or np.isfinite(array).all()):
            return {"array": array.tolist(), "dtype": array.dtype.name, "shape": list(array.shape)}
        # Views of one buffer are one array; `_kept` stops Python from giving the buffer to another.
        key = (array.__array_interface__["data"][0], array.shape, array.dtype.str)
        if key not in self._names:
            self._kept.append(array)
            self._names[key] = f"arrays/{len(self._names)}.npy"
            buffer = io.BytesIO()
            np.lib.format.write_array(buffer, array, version=(1, 0), allow_pickle=False)
            # Released also where writing fails: Python cannot free a buffer that is looked at.
            with buffer.getbuffer() as data:
                self._add(self._names[key], data)
        return {"npy": self._names[key]}


class ArrayReader:
    """Turns JSON back into arrays; `read(name)` returns the bytes of an entry. Raises FileError for all else."""

    def __init__(self, read):
        self._read = read
        self._arrays = {}

    def decode_inline(self, content, dtype, shape):
        """The array of a JSON list, its dtype's name and its shape."""
        try:
            values = np.array(content)
            _numeric(values.dtype)
            with np.errstate(all="ignore"):  # what does not fit is not equal, below
                array = values.astype(_numeric(np.dtype(dtype)))
            if values.size > INLINE or not np.array_equal(values, array) or any(type(n) is not int for n in shape):
                raise ValueError(f"not {dtype} of shape {shape}")
            return array.reshape(shape)
        except (TypeError, ValueError, OverflowError, SyntaxError, RecursionError) as error:
            raise FileError(f"an array in its JSON is damaged ({error})") from error

    def decode_npy(self, name):
        """The array of the entry `name`, read once however often it is asked for; read-only."""
        if not isinstance(name, str):
            raise FileError(f"an array has the name {name!r}")
        if name not in self._arrays:
            try:
                data = self._read(name)
            except KeyError:
                raise FileError(f"its array '{name}' is missing") from None
            self._arrays[name] = _parsed(name, data)
        return self._arrays[name]


def _parsed(name, data):
    """The array in the bytes of a .npy file of version 1.0, without a copy; the declared size must be the real one."""
    file = io.BytesIO(data)
    try:
        if np.lib.format.read_magic(file) != (1, 0):
            raise ValueError("not version 1.0 of the .npy format")
        shape, is_fortran, dtype = np.lib.format.read_array_header_1_0(file)
        count, start = math.prod(shape), file.tell()
        if is_fortran or any(n < 0 for n in shape) or count * _numeric(dtype).itemsize != len(data) - start:
            raise ValueError(f"shape {shape} of {dtype} does not fit its {len(data) - start} bytes")
        return np.frombuffer(data, dtype, count, start).reshape(shape) if count else np.zeros(shape, dtype)
    except Exception as error:
        # NumPy parses the header as Python literals, and whatever that raises for hostile text means one thing.
        raise FileError(f"its array '{name}' is damaged ({type(error).__name__}: {error})") from error


def _numeric(dtype):
    if dtype.kind not in KINDS or dtype.itemsize > 8 or dtype.hasobject:
        raise ValueError(f"dtype {dtype}")
    return dtype
