"""Materials whose parameters may be textures: what is seen of them without looking any texture up.

A lobe's parameter is a number, a colour, or a texture that gives one at each point.
"""

import dataclasses

import numpy as np

from ..constants import LUMINANCE
from ..interfaces import albedo_of, asks_for_cosine, has_detail, is_pure
from .coordinates import Coordinates
from .graphs import inputs_of, is_texture, with_inner
from .points import average_of, constant_of


def textures_of(value):
    """{field: texture} of a lobe or material."""
    return {f.name: getattr(value, f.name) for f in dataclasses.fields(value) if is_texture(getattr(value, f.name))}


def averaged(value):
    """A lobe or material with each texture's average in its place; what is below 0 counts as 0."""
    return _replaced(value, lambda field, texture: np.maximum(average_of(texture), 0))


def plain(value):
    """A lobe or material with the default of each parameter that is a texture: what can be checked of it without points."""
    return dataclasses.replace(value, **{n: type(value).__dataclass_fields__[n].default for n in textures_of(value)})


def may_reflect(lobe):
    """Whether any light goes on by a lobe; textures may be anything."""
    return bool(textures_of(lobe)) or any(albedo_of(lobe))


def may_emit(material):
    """Whether a material emits anything; textures may be anything."""
    return is_texture(material.emission) or any(material.emission)


def may_hold_out(material):
    """Whether the camera sees anything of a material as clear; textures may be anything."""
    return is_texture(material.holdout) or any(material.holdout)


def is_number(value, field):
    """Whether the parameter `field` of a lobe or material is a number: it takes the luminance of a texture."""
    return not isinstance(type(value).__dataclass_fields__[field].default, tuple)


def luminance(value):
    """The number (N,) that a parameter takes of a texture's value (1, N) or (3, N)."""
    return value[0] if len(value) == 1 else sum(np.float32(share) * channel for share, channel in zip(LUMINANCE, value))


def _replaced(value, found):
    values = {}
    for name, texture in textures_of(value).items():
        colour = np.broadcast_to(found(name, texture), 3)
        values[name] = float(np.dot(LUMINANCE, colour)) if is_number(value, name) else tuple(colour.tolist())
    return dataclasses.replace(value, **values) if values else value


def folded(texture):
    """A texture as the constant that it is, a number or three, where it is a function of constants; else itself."""
    is_constant = is_pure(texture) and not any(is_texture(x) or isinstance(x, Coordinates) for x in inputs_of(texture))
    return constant_of(texture) if is_constant else texture


def is_isotropic(texture):
    """Whether a texture is the same for all rays of one cosine to the shading normal that meet the same side."""
    are_even = all((is_pure(part) or asks_for_cosine(part)) and not has_detail(part) for part in with_inner(texture))
    return are_even and not coordinates_of(texture)


def coordinates_of(texture):
    """The different `Coordinates` that `texture` looks itself up at."""
    found = (value for part in with_inner(texture) for value in inputs_of(part))
    return tuple(dict.fromkeys(value for value in found if isinstance(value, Coordinates)))


def material_textures(material):
    """All textures of a material's lobes, emission, alpha, holdout, relief and passes of its own, without inner ones."""
    own = [value for _, value in material.aovs if is_texture(value)]
    return [*(t for value in (*material.lobes, material) for t in textures_of(value).values()), *material.relief, *own]


def asks_for_around(material):
    """Whether any of a material's textures asks what is around the body, see `textures.relative_index`."""
    return any(getattr(part, "asks_for_around", False) for texture in material_textures(material) for part in with_inner(texture))


def attributes_of(material):
    """What a material's textures ask of meshes and objects, see `asked_by`."""
    return asked_by(material_textures(material))


def asked_by(textures):
    """What textures ask of meshes and objects, keys as in `world.attributes`."""
    found = [c.attribute for texture in textures for c in coordinates_of(texture)]
    return frozenset([*found, *(key for texture in textures for part in with_inner(texture) for key in getattr(part, "attributes", ()))])
