"""Scene values as JSON and back: a fixed list of record types, each with its fields by name."""

import dataclasses
import math

import numpy as np

from ..errors import FileError, GlanzError
from ..registry import BSDFS, CAMERAS, LIGHTS, TEXTURES
from ..scene import (
    Bitmap,
    Coordinates,
    EnvironmentMap,
    Lens,
    Material,
    Medium,
    Mesh,
    MeshAttribute,
    Mist,
    Object,
    Scene,
    Settings,
    Shade,
    World,
)
from ..scene.graphs import is_texture, with_inner
from ..textures.bump_map import BumpMap
from ..textures.linear import LinearTexture
from ..textures.normal_map import NormalMap

SHARED = (Mesh, Material, Bitmap, *TEXTURES.values())
"""Values that many others may hold; they are stored once and are the same value again after reading."""
PARTS = {
    Scene: {"camera": CAMERAS, "objects": [Object], "lights": [LIGHTS], "world": World},
    Mesh: {"attributes": [MeshAttribute]},
    Object: {"mesh": Mesh, "materials": [Material]},
    Material: {"lobes": [BSDFS], "relief": [TEXTURES], "medium": Medium},
    World: {"environment": EnvironmentMap, "mist": Mist},
    LinearTexture: {"textures": [TEXTURES]},
    Shade: {"texture": TEXTURES},
}
"""Which fields hold other values, and of which type; in a list: any number of them."""


def types():
    """{name in the file: type} of all that may stand in a file; plug-ins are named `light/point` by their keys."""
    values = (Scene, World, EnvironmentMap, Mist, Object, Mesh, MeshAttribute, Material, Medium, Lens, Settings, Shade, Bitmap, Coordinates)
    # The two reliefs that there were before textures could be anything.
    plain = {cls.__name__: cls for cls in (*values, NormalMap, BumpMap)}
    plugins = {"bsdf": BSDFS, "light": LIGHTS, "camera": CAMERAS, "texture": TEXTURES}
    return plain | {f"{kind}/{key}": cls for kind, registry in plugins.items() for key, cls in registry.items()}


class Encoder:
    """Turns values into JSON; `shared` grows a list of what others refer to by number."""

    def __init__(self, arrays):
        self.shared = []
        self._arrays = arrays
        self._names = {cls: name for name, cls in types().items()}
        self._numbers = {}
        self._kept, self._textures = [], set()

    def encode(self, value):
        """The JSON for `value`; raises TypeError for a type that is not known."""
        if value is None or isinstance(value, (bool, str)) or type(value) is int:
            return value
        if type(value) is float:
            return value if math.isfinite(value) else {"float": str(value)}
        if isinstance(value, (np.ndarray, np.generic)):
            # A NumPy number computes differently from Python's, so it stays one: an array without axes.
            return self._arrays.encode(np.asarray(value)) | ({"number": True} if isinstance(value, np.generic) else {})
        if isinstance(value, (tuple, list)):
            return [self.encode(item) for item in value]
        if type(value) not in self._names:
            raise TypeError(f"a value of the type {type(value).__name__} cannot be stored")
        if isinstance(value, SHARED):
            return {"shared": self._number(value)}
        return self._record(value)

    def _number(self, value):
        if id(value) not in self._numbers:
            # What textures are made of first: they may be deeper than Python's stack.
            parts = with_inner(value, self._textures) if is_texture(value) else (value,)
            self._textures.update(filter(is_texture, parts))
            for part in parts:
                self._kept.append(part)
                record = self._record(part)
                self._numbers[id(part)] = len(self.shared)
                self.shared.append(record)
        return self._numbers[id(value)]

    def _record(self, value):
        fields = {f.name: self.encode(getattr(value, f.name)) for f in dataclasses.fields(value)}
        return {"type": self._names[type(value)], **fields}


class Decoder:
    """Turns JSON back into values. Raises FileError for what is not of the known types, GlanzError for what they refuse."""

    def __init__(self, arrays, shared):
        self._arrays = arrays
        self._types = types()
        self._shared = []
        if not isinstance(shared, list):
            raise FileError("its list of shared values is not a list")
        for number, record in enumerate(shared):
            # One after the other: a shared value can refer to those before it only, so there are no circles.
            try:
                self._shared.append(self.decode(record))
            except GlanzError as error:
                raise FileError(f"its shared value {number}: {error}") from error

    def decode(self, content, expected=None):
        """The value of JSON `content`; `expected` is the name of the only type allowed."""
        if expected and not (isinstance(content, dict) and content.get("type") == expected):
            raise FileError(f"its {expected} is not a {expected}")
        if isinstance(content, list):
            return tuple(self.decode(item) for item in content)
        if not isinstance(content, dict):
            return content
        match content:
            case {"type": str(name), **fields}:
                return self._build(name, fields)
            case {"shared": int(number), **rest} if not rest and 0 <= number < len(self._shared):
                return self._shared[number]
            case {"float": "nan" | "inf" | "-inf" as text, **rest} if not rest:
                return float(text)
            case {"array": values, "dtype": str(dtype), "shape": list(shape), **rest}:
                return self._number_or_array(self._arrays.decode_inline(values, dtype, shape), rest)
            case {"npy": name, **rest}:
                return self._number_or_array(self._arrays.decode_npy(name), rest)
        raise FileError(f"unknown content {str(content)[:80]}")

    @staticmethod
    def _number_or_array(array, rest):
        return array[()] if rest.get("number") else array

    def _build(self, name, fields):
        if name not in self._types:
            raise FileError(f"unknown type '{name}'; known: {', '.join(self._types)}")
        cls = self._types[name]
        known = {f.name: f for f in dataclasses.fields(cls)}
        if not known.keys() >= fields.keys():
            raise FileError(f"{name} has no field '{next(iter(fields.keys() - known.keys()))}'")
        values = {field: self.decode(content) for field, content in fields.items()}
        for field, value in values.items():
            _check_field(cls, known[field], value)
        try:
            return cls(**values)
        except GlanzError:
            raise
        except (TypeError, ValueError, OverflowError, AttributeError) as error:
            raise FileError(f"its {name} {values.get('name', '')!r} is damaged ({error})") from error


_TEXTURED = {Material: ("emission", "alpha", "holdout"), World: ("radiance",)}
"""The fields of values, beside all parameters of BSDFs, that may be textures."""


def _check_field(cls, field, value):
    """Raises FileError unless `value` is of the kind that the field holds by default, or that PARTS names."""
    part = Shade if cls in LIGHTS.values() and field.name == "shade" else PARTS.get(cls, {}).get(field.name)
    if part is not None:
        fits = isinstance(value, tuple) and all(map(_fits_type(part[0]), value)) if isinstance(part, list) else _fits_type(part)(value)
    elif field.type is object and cls in TEXTURES.values():
        fits = type(value) in (*TEXTURES.values(), Coordinates) or _is_number(value) or _is_alike((0.0, 0.0, 0.0), value)
        fits = fits or value is field.default is None
    elif field.type is np.ndarray and cls in TEXTURES.values():
        # Tables of any length; `check` looks into them.
        fits = isinstance(value, np.ndarray)
    elif cls is LinearTexture and field.name == "factors":
        fits = isinstance(value, tuple) and all(type(f) in TEXTURES.values() or _is_number(f) or _is_alike((0.0,) * 3, f) for f in value)
    elif type(value) in TEXTURES.values():
        fits = cls in BSDFS.values() or field.name in _TEXTURED.get(cls, ())
    elif dataclasses.is_dataclass(field.default):
        fits = type(value) is type(field.default)
    elif field.default is not dataclasses.MISSING:
        fits = _is_alike(field.default, value)
    elif field.default_factory is not dataclasses.MISSING:
        fits = _is_alike(field.default_factory(), value)
    else:
        fits = isinstance(value, str if field.name == "name" else np.ndarray)
    if not fits:
        raise FileError(f"{cls.__name__} has {field.name} {str(value)[:40]!r}, which is of another kind")


def _fits_type(part):
    allowed = tuple(part.values()) if isinstance(part, dict) else (part,)
    # A scene may lack its camera, rendering says so; a material its medium; a world its picture; and a light its shade.
    return lambda value: type(value) in allowed or (part in (CAMERAS, Medium, EnvironmentMap, Shade) and value is None)


def _is_alike(default, value):
    """Whether `value` could stand where `default` does: same kind, and same shape unless the default is empty."""
    if isinstance(default, bool):
        return isinstance(value, (bool, np.bool_))
    if isinstance(default, str):
        return isinstance(value, str)
    if isinstance(default, int):
        return isinstance(value, (int, np.integer)) and not isinstance(value, bool)
    if isinstance(default, float):
        return _is_number(value)
    shape = np.shape(default)
    if 0 in shape:
        return isinstance(value, np.ndarray) if isinstance(default, np.ndarray) else isinstance(value, tuple)
    if isinstance(default, tuple) and isinstance(default[0], str):
        return isinstance(value, tuple) and all(isinstance(item, str) for item in value)
    # Users may hand over a matrix as nested tuples and a vector as an array.
    numbers = np.array(value, object) if isinstance(value, tuple) else value
    return isinstance(numbers, np.ndarray) and numbers.shape == shape and all(map(_is_number, numbers.flat))


def _is_number(value):
    if isinstance(value, (bool, np.bool_)) or not isinstance(value, (int, float, np.integer, np.floating)):
        return False
    # Python's whole numbers know no end, floating-point numbers do.
    return not isinstance(value, int) or abs(value) < 2**63
