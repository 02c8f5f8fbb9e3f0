"""Graphs of textures: what a texture is made of. They share their parts, and may be deeper than Python's stack."""

import dataclasses
import weakref

from ..registry import TEXTURES
from .coordinates import Coordinates

LANDING = 32
"""Textures, one within the other, that are evaluated on Python's stack, which holds 1,000 frames: each takes up to eight."""
_depths = weakref.WeakKeyDictionary()


def is_texture(value):
    """Whether a parameter is a texture."""
    # Most values are numbers: this is asked of all.
    kind = type(value)
    return TEXTURES.get(getattr(kind, "key", None)) is kind


def inputs_of(texture):
    """The values of a texture's inputs, constants and textures, those in tuples one by one."""
    for f in dataclasses.fields(texture):
        if f.type is object:
            yield getattr(texture, f.name)
        elif isinstance(value := getattr(texture, f.name), tuple):
            yield from (x for x in value if is_texture(x) or isinstance(x, Coordinates))


def with_inner(texture, known=()):
    """`texture` and all textures that it is made of, each once, what it is made of first; those `known` are left out."""
    found, stack = {}, [(texture, False)]
    while stack:
        part, is_done = stack.pop()
        if is_done:
            found[id(part)] = part
        elif id(part) not in found:
            stack += [(part, True), *((inner, False) for inner in inputs_of(part) if is_texture(inner) and inner not in known)]
    return tuple(found.values())


def is_landing(texture):
    """Whether a texture is a multiple of LANDING deep: as on stairs, from one to the next it is not far."""
    if texture not in _depths:
        for part in with_inner(texture, _depths):
            _depths[part] = 1 + max((_depths[inner] for inner in inputs_of(part) if is_texture(inner)), default=0)
    return _depths[texture] % LANDING == 0
