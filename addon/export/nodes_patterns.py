"""Nodes that make patterns."""

import bpy

from ...engine import (
    BrickTexture,
    CheckerTexture,
    Coordinates,
    GaborTexture,
    GradientTexture,
    MagicTexture,
    NoiseTexture,
    VoronoiTexture,
    WaveTexture,
    WhiteNoiseTexture,
)
from .mapping import note_mapping

_GENERATED = Coordinates(source="generated")
_PROFILES = {"SIN": "sine", "SAW": "saw", "TRI": "triangle"}


def _words(enum):
    """An item of Blender's, such as SMOOTH_F1, as the engine calls it."""
    return enum.lower().replace("_", " ")


def _inputs(reader, node, **identifiers):
    """{field: value} of inputs by their identifiers; the vector at which the texture is looked up as `coordinates`."""
    note_mapping(reader, node)
    return {
        "coordinates": reader.vector(node, _GENERATED),
        **{field: reader.value(node, identifier) for field, identifier in identifiers.items()},
    }


def _brick(reader, node, output):
    inputs = _inputs(
        reader, node, colour1="Color1", colour2="Color2", mortar="Mortar", scale="Scale", mortar_size="Mortar Size",
        mortar_smooth="Mortar Smooth", bias="Bias", width="Brick Width", height="Row Height",
    )  # fmt: skip
    return BrickTexture(
        **inputs,
        shift=node.offset,
        shift_every=node.offset_frequency,
        squash=node.squash,
        squash_every=node.squash_frequency,
        output=output.lower(),
    )


def _checker(reader, node, output):
    return CheckerTexture(**_inputs(reader, node, odd="Color1", even="Color2", scale="Scale"), output=output.lower())


def _gabor(reader, node, output):
    inputs = _inputs(
        reader, node, scale="Scale", frequency="Frequency", anisotropy="Anisotropy", angle="Orientation 2D", orientation="Orientation 3D"
    )
    return GaborTexture(**inputs, dimensions=_dimensions(node.gabor_type), output=output.lower())


def _gradient(reader, node, output):
    return GradientTexture(**_inputs(reader, node), shape=_words(node.gradient_type))


def _magic(reader, node, output):
    inputs = _inputs(reader, node, scale="Scale", distortion="Distortion")
    return MagicTexture(**inputs, depth=node.turbulence_depth, output=output.lower(), scales_first=bpy.app.version >= (5, 2, 0))


def _noise(reader, node, output):
    inputs = _inputs(
        reader, node, scale="Scale", w="W", detail="Detail", roughness="Roughness", lacunarity="Lacunarity",
        offset="Offset", gain="Gain", distortion="Distortion",
    )  # fmt: skip
    return NoiseTexture(
        **inputs,
        kind=_words(node.noise_type),
        dimensions=_dimensions(node.noise_dimensions),
        is_normalized=node.normalize,
        is_coloured=output == "Color",
    )


def _voronoi(reader, node, output):
    inputs = _inputs(
        reader, node, scale="Scale", w="W", detail="Detail", roughness="Roughness", lacunarity="Lacunarity",
        smoothness="Smoothness", exponent="Exponent", randomness="Randomness",
    )  # fmt: skip
    return VoronoiTexture(
        **inputs,
        feature=_words(node.feature),
        metric=_words(node.distance),
        output=output.lower(),
        dimensions=_dimensions(node.voronoi_dimensions),
        is_normalized=node.normalize,
        is_integer=bpy.app.version >= (5, 0, 0),
    )


def _wave(reader, node, output):
    inputs = _inputs(
        reader, node, scale="Scale", distortion="Distortion", detail="Detail", detail_scale="Detail Scale",
        roughness="Detail Roughness", phase="Phase Offset",
    )  # fmt: skip
    kind = _words(node.wave_type)
    return WaveTexture(**inputs, shape=f"{kind} {_words(getattr(node, f'{kind}_direction'))}", profile=_PROFILES[node.wave_profile])


def _white_noise(reader, node, output):
    return WhiteNoiseTexture(
        reader.vector(node, _GENERATED), reader.value(node, "W"), _dimensions(node.noise_dimensions), output=output.lower()
    )


def _dimensions(enum):
    """How many "3D" are."""
    return int(enum[0])


TABLE = {
    "TEX_BRICK": _brick,
    "TEX_CHECKER": _checker,
    "TEX_GABOR": _gabor,
    "TEX_GRADIENT": _gradient,
    "TEX_MAGIC": _magic,
    "TEX_NOISE": _noise,
    "TEX_VORONOI": _voronoi,
    "TEX_WAVE": _wave,
    "TEX_WHITE_NOISE": _white_noise,
}
