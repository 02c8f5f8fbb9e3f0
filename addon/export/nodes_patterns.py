"""Nodes that make patterns."""

from dataclasses import replace

import numpy as np

from ...engine import CheckerTexture, Coordinates, GradientTexture, LinearTexture, NoiseTexture
from .mapping import note_mapping

_GENERATED = Coordinates(source="generated")
_BLACK, _WHITE = (0.0, 0.0, 0.0), (1.0, 1.0, 1.0)


def _scaled(reader, node):
    """The vector of a texture node times its Scale."""
    vector, scale = reader.vector(node, _GENERATED), reader.value(node, "Scale", 5.0)
    if isinstance(vector, Coordinates) and isinstance(scale, float):
        return replace(vector, matrix=np.diag((scale, scale, scale, 1.0)) @ np.array(vector.matrix))
    return LinearTexture((vector,), (scale,))


def _checker(reader, node, output):
    note_mapping(reader, node)
    colours = [reader.value(node, identifier) for identifier in ("Color1", "Color2")] if output == "Color" else [_WHITE, _BLACK]
    return CheckerTexture(*colours, _scaled(reader, node))


def _noise(reader, node, output):
    note_mapping(reader, node)
    if node.noise_dimensions != "3D":
        reader.note(f"Noise Texture in {node.noise_dimensions} is rendered in 3D")
    if getattr(node, "noise_type", "FBM") != "FBM":
        reader.note(f"Noise Texture of type {node.noise_type} is rendered as fBM")
    return NoiseTexture(
        _scaled(reader, node),
        detail=float(np.clip(reader.number(node, "Detail", 2.0), 0, 15)),
        roughness=max(reader.number(node, "Roughness", 0.5), 0.0),
        lacunarity=max(reader.number(node, "Lacunarity", 2.0), 0.0),
        distortion=reader.number(node, "Distortion"),
        is_normalized=bool(getattr(node, "normalize", True)),
        is_coloured=output == "Color",
    )


def _gradient(reader, node, output):
    note_mapping(reader, node)
    return GradientTexture(node.gradient_type.lower().replace("_", " "), reader.vector(node, _GENERATED))


TABLE = {"TEX_CHECKER": _checker, "TEX_NOISE": _noise, "TEX_GRADIENT": _gradient}
