"""Materials whose parameters may be textures: what is seen of them without looking any texture up.

A lobe's parameter is a number, a colour, or a texture that gives one at each point.
"""

import dataclasses

import numpy as np

from ..constants import LUMINANCE
from ..registry import TEXTURES
from .coordinates import Coordinates
from .relief import NormalMap

_LEAST_SHARE = 2.0**-10
"""A texture is at least so large on average, compared to its largest value: what is rarely bright must be found as well."""


def is_texture(value):
    """Whether a parameter is a texture."""
    return type(value) in TEXTURES.values()


def textures_of(value):
    """{field: texture} of a lobe or material."""
    return {f.name: getattr(value, f.name) for f in dataclasses.fields(value) if is_texture(getattr(value, f.name))}


def averaged(value):
    """A lobe or material with each texture's average in its place."""
    return _replaced(value, lambda t: np.maximum(t.average(), np.maximum(t.bounds()[1], 0) * _LEAST_SHARE))


def brightest(value):
    """A lobe or material with each texture's largest value in its place."""
    return _replaced(value, lambda t: np.maximum(t.bounds()[1], 0))


def most_reflecting(value):
    """A lobe or material with the largest colours and the least numbers of its textures; no lobe reflects more than this."""
    return dataclasses.replace(brightest(value), **{n: getattr(darkest(value), n) for n in textures_of(value) if is_number(value, n)})


def darkest(value):
    """A lobe or material with each texture's least value in its place; what is below 0 counts as 0."""
    return _replaced(value, lambda t: np.maximum(t.bounds()[0], 0))


def is_number(value, field):
    """Whether the parameter `field` of a lobe or material is a number: it takes the luminance of a texture."""
    return not isinstance(type(value).__dataclass_fields__[field].default, tuple)


def _replaced(value, colour_of):
    colours = {name: tuple(map(float, colour_of(texture))) for name, texture in textures_of(value).items()}
    if not colours:
        return value
    return dataclasses.replace(value, **{n: float(np.dot(LUMINANCE, c)) if is_number(value, n) else c for n, c in colours.items()})


def with_inner(texture):
    """`texture` and all textures that it is made of."""
    yield texture
    for f in dataclasses.fields(texture):
        inner = getattr(texture, f.name)
        for part in inner if isinstance(inner, tuple) else (inner,):
            if is_texture(part):
                yield from with_inner(part)


def coordinates_of(texture):
    """The different `Coordinates` that `texture` looks itself up at."""
    found = (getattr(part, f.name) for part in with_inner(texture) for f in dataclasses.fields(part))
    return tuple(dict.fromkeys(value for value in found if isinstance(value, Coordinates)))


def material_textures(material):
    """All textures of a material's lobes, emission, alpha and relief, without inner ones."""
    return [t for value in (*material.lobes, material, *material.relief) for t in textures_of(value).values()]


def attributes_of(material):
    """What a material's textures and normal maps ask of meshes, see `Coordinates.attribute`."""
    found = [c.attribute for texture in material_textures(material) for c in coordinates_of(texture)]
    return frozenset([*found, *(("uv", relief.layer) for relief in material.relief if isinstance(relief, NormalMap))])
