"""Nodes that are made for lights."""

import bpy
import numpy as np

from ...engine import FileError, Geometry, IesTexture, LightFalloff, VectorTransform, parse_ies
from .findings import MISSING

LARGEST = 2**24
"""Bytes of a file of a lamp maker that are read: some thousand times what these have."""
_UNREAD = 100.0
"""What Cycles takes for a file that it cannot read."""
_FROM_LIGHT = VectorTransform(Geometry("incoming"), "normal", "world", "object")


def _ies(reader, node, output):
    strength = reader.value(node, "Strength", 1.0)
    name, text = _text(node)
    try:
        if text is None:
            raise FileError("there is no such text or file")
        table = parse_ies(text) | {"falls_off": bpy.app.version < (5, 0)}
    except FileError as error:
        reader.note(f"the IES file {name} is not read ({error}), so it is {_UNREAD:g} in all directions, as in Cycles", MISSING)
        table = {"intensity": np.full((2, 2), _UNREAD)}
    return IesTexture(reader.vector(node, _FROM_LIGHT), strength, **table)


def _text(node):
    """(name in quotes, text or None) of what an IES Texture node shows."""
    if node.mode == "INTERNAL":
        text = node.ies
        return (repr(text.name), text.as_string()) if text else ("''", None)
    path = bpy.path.abspath(node.filepath, library=node.id_data.library)
    try:
        with open(path, "rb") as file:
            # Names of makers are in any encoding, numbers in all the same.
            return repr(node.filepath), file.read(LARGEST).decode("latin-1")
    except (OSError, ValueError):
        return repr(node.filepath), None


def _light_falloff(reader, node, output):
    return LightFalloff(reader.value(node, "Strength", 100.0), reader.value(node, "Smooth"), output.lower())


TABLE = {"TEX_IES": _ies, "LIGHT_FALLOFF": _light_falloff}
