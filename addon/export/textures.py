"""Blender's texture nodes as the engine's textures: to support another one is to add a function and a row of the table."""

import numpy as np

from ...engine import CheckerTexture, GradientTexture, ImageTexture, NoiseTexture
from .coordinates import coordinates_of
from .nodes import input_by_identifier

_BLACK, _WHITE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)


def colour_of(reader, node, identifier, default=_BLACK):
    """The colour of an input: a constant (r, g, b), or a texture where one feeds it and `reader` reads textures."""
    found = texture_behind(reader, node, identifier)
    return reader.colour(node, identifier, default) if found is None else found


def number_of(reader, node, identifier, default=0.0):
    """The number of an input: a constant, or a texture where one feeds it and `reader` reads textures."""
    found = texture_behind(reader, node, identifier)
    return reader.number(node, identifier, default) if found is None else found


def texture_behind(reader, node, identifier):
    """The texture that feeds an input, or None."""
    socket = input_by_identifier(node, identifier)
    if socket is None or reader.bitmaps is None:
        return None
    behind, _, output = reader.source(socket)
    if output is None or (output.node.type, output.identifier) not in _TABLE:
        return None
    inside = behind.beyond(output.node)
    if inside is None:
        return None
    texture = _TABLE[output.node.type, output.identifier](inside, output.node, output.identifier == "Color")
    _note_mapping(inside, output.node)
    return texture


def _note_mapping(reader, node):
    mapping, colours = node.texture_mapping, node.color_mapping
    is_plain = (
        tuple(mapping.translation) == tuple(mapping.rotation) == (0, 0, 0)
        and tuple(mapping.scale) == (1, 1, 1)
        and (mapping.mapping_x, mapping.mapping_y, mapping.mapping_z) == ("X", "Y", "Z")
    )
    if not is_plain or colours.use_color_ramp or (colours.brightness, colours.contrast, colours.saturation) != (1, 1, 1):
        reader.note(f"the mapping within {node.bl_label} is left out; use a Mapping node")


def _image(reader, node, is_colour):
    if is_colour:
        # As Cycles has it: whoever asks for the alpha cuts the colour out with it.
        is_cut = any(s.identifier == "Alpha" and s.is_linked for s in node.outputs)
        bitmap = reader.bitmaps.of(node.image, reader.owner, "uncut" if is_cut else "colour")
    else:
        bitmap = reader.bitmaps.of(node.image, reader.owner, "alpha")
    if node.projection != "FLAT":
        reader.note(f"{node.projection.capitalize()} projection of Image Texture is left out, it is rendered flat")
    if node.interpolation in ("Cubic", "Smart"):
        reader.note(f"{node.interpolation} interpolation of Image Texture is rendered as Linear")
    return ImageTexture(bitmap, coordinates_of(reader, node, "uv"), node.extension.lower(), node.interpolation != "Closest")


def _checker(reader, node, is_colour):
    scale = reader.number(node, "Scale", 5.0)
    colours = [reader.colour(node, identifier) for identifier in ("Color1", "Color2")] if is_colour else [_WHITE, _BLACK]
    return CheckerTexture(*colours, coordinates_of(reader, node, "generated", scale))


def _noise(reader, node, is_colour):
    if node.noise_dimensions != "3D":
        reader.note(f"Noise Texture in {node.noise_dimensions} is rendered in 3D")
    if getattr(node, "noise_type", "FBM") != "FBM":
        reader.note(f"Noise Texture of type {node.noise_type} is rendered as fBM")
    return NoiseTexture(
        coordinates_of(reader, node, "generated", reader.number(node, "Scale", 5.0)),
        detail=float(np.clip(reader.number(node, "Detail", 2.0), 0, 15)),
        roughness=max(reader.number(node, "Roughness", 0.5), 0.0),
        lacunarity=max(reader.number(node, "Lacunarity", 2.0), 0.0),
        distortion=reader.number(node, "Distortion"),
        is_normalized=bool(getattr(node, "normalize", True)),
        is_coloured=is_colour,
    )


def _gradient(reader, node, is_colour):
    shape = node.gradient_type.lower().replace("_", " ")
    return GradientTexture(shape, coordinates_of(reader, node, "generated"))


_TABLE = {
    ("TEX_IMAGE", "Color"): _image,
    ("TEX_IMAGE", "Alpha"): _image,
    ("TEX_CHECKER", "Color"): _checker,
    ("TEX_CHECKER", "Fac"): _checker,
    ("TEX_NOISE", "Color"): _noise,
    ("TEX_NOISE", "Fac"): _noise,
    ("TEX_GRADIENT", "Color"): _gradient,
    ("TEX_GRADIENT", "Fac"): _gradient,
}
"""(node type, output) -> function (reader, node, whether the output is the colour) -> texture."""
