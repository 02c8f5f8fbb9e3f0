"""Nodes that show pictures."""

from ...engine import Coordinates, Geometry, ImageTexture
from .images import is_cut_by_alpha
from .mapping import note_mapping

_UV = Coordinates()
_UP = (0.0, 0.0, 1.0)
_NORMAL = Geometry("object normal")


def _image(reader, node, output):
    note_mapping(reader, node)
    image, is_box = node.image, node.projection == "BOX"
    # As Cycles has it: whoever asks for the alpha cuts the colour out with it.
    is_uncut = is_cut_by_alpha(image) and any(socket.identifier == "Alpha" and socket.is_linked for socket in node.outputs)
    tiles = reader.bitmaps.tiles(image, reader.note, is_uncut)
    # Of a tiled image whose tiles are all missing nothing is known but that.
    bitmap = tiles[0][1] if tiles else reader.bitmaps.of(image, reader.note, node.image_user, is_uncut)
    return ImageTexture(
        bitmap,
        reader.vector(node, _UV),
        node.extension.lower(),
        is_smooth=node.interpolation != "Closest",
        is_cubic=node.interpolation in ("Cubic", "Smart"),
        output="alpha" if output == "Alpha" else "uncut" if is_uncut else "colour",
        projection=node.projection.lower(),
        blend=node.projection_blend if is_box else 0.0,
        normal=_NORMAL if is_box else _UP,
        tiles=tiles,
    )


TABLE = {"TEX_IMAGE": _image}
