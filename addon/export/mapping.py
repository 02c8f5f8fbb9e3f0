"""The mapping that texture nodes have within them, which no panel shows any more."""

from .findings import IGNORED


def note_mapping(reader, node):
    """Note a mapping of coordinates or colours within a texture node: it is left out."""
    mapping, colours = node.texture_mapping, node.color_mapping
    is_plain = (
        tuple(mapping.translation) == tuple(mapping.rotation) == (0, 0, 0)
        and tuple(mapping.scale) == (1, 1, 1)
        and (mapping.mapping_x, mapping.mapping_y, mapping.mapping_z) == ("X", "Y", "Z")
    )
    if not is_plain or colours.use_color_ramp or (colours.brightness, colours.contrast, colours.saturation) != (1, 1, 1):
        reader.note(f"the mapping within {node.bl_label} is left out; use a Mapping node", IGNORED)
