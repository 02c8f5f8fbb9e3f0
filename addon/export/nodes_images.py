"""Nodes that show pictures."""

from ...engine import Coordinates, ImageTexture
from .mapping import note_mapping

_UV = Coordinates()


def _image(reader, node, output):
    note_mapping(reader, node)
    if output == "Color":
        # As Cycles has it: whoever asks for the alpha cuts the colour out with it.
        is_cut = any(s.identifier == "Alpha" and s.is_linked for s in node.outputs)
        bitmap = reader.bitmaps.of(node.image, reader.owner, "uncut" if is_cut else "colour")
    else:
        bitmap = reader.bitmaps.of(node.image, reader.owner, "alpha")
    if node.projection != "FLAT":
        reader.note(f"{node.projection.capitalize()} projection of Image Texture is left out, it is rendered flat")
    if node.interpolation in ("Cubic", "Smart"):
        reader.note(f"{node.interpolation} interpolation of Image Texture is rendered as Linear")
    return ImageTexture(bitmap, reader.vector(node, _UV), node.extension.lower(), node.interpolation != "Closest")


TABLE = {"TEX_IMAGE": _image}
