"""Nodes that make and change colours."""

import numpy as np

from ...engine import (
    Blackbody,
    BrightnessContrast,
    ColourRamp,
    Combine,
    Curves,
    Gamma,
    HueSaturation,
    Invert,
    Luminance,
    MixColour,
    Separate,
    Wavelength,
)
from .nodes import words

_PLACES = np.linspace(0, 1, 257)
"""Where ramps and curves are evaluated, as Cycles does."""


def _own(reader, node, output):
    """RGB and Value hold their value in their output."""
    value = node.outputs[0].default_value
    return float(value) if isinstance(value, float) else tuple(float(c) for c in value)[:3]


def _mix_rgb(reader, node, output):
    inputs = (reader.value(node, identifier) for identifier in ("Fac", "Color1", "Color2"))
    return MixColour(*inputs, words(node.blend_type), clamps_result=node.use_clamp)


def _ramp(reader, node, output):
    ramp = node.color_ramp
    table = np.array([ramp.evaluate(place) for place in _PLACES], np.float32).T
    return ColourRamp(reader.value(node, "Fac", 0.5), table[:3] if output == "Color" else table[3:], ramp.interpolation != "CONSTANT")


def _curves(reader, node, output):
    mapping = node.mapping
    low = min(curve.points[0].location[0] for curve in mapping.curves)
    high = max(curve.points[-1].location[0] for curve in mapping.curves)
    # Curves that are single points: the same everywhere.
    high = high if high > low else low + 1
    # The fourth curve of colours comes first, and is that of all channels.
    *curves, shared = mapping.curves if node.type == "CURVE_RGB" else (*mapping.curves, None)
    places = [low + place * (high - low) for place in _PLACES]
    places = [mapping.evaluate(shared, place) for place in places] if shared else places
    table = np.array([[mapping.evaluate(curve, place) for place in places] for curve in curves], np.float32)
    value, factor = _CURVED[node.type]
    extends = mapping.extend == "EXTRAPOLATED"
    return Curves(reader.value(node, value), reader.value(node, factor, 1.0), table, float(low), float(high), extends)


_CURVED = {"CURVE_RGB": ("Color", "Fac"), "CURVE_VEC": ("Vector", "Fac"), "CURVE_FLOAT": ("Value", "Factor")}


def _brightness_contrast(reader, node, output):
    return BrightnessContrast(*(reader.value(node, identifier) for identifier in ("Color", "Bright", "Contrast")))


def _hue_saturation(reader, node, output):
    return HueSaturation(*(reader.value(node, identifier) for identifier in ("Color", "Hue", "Saturation", "Value", "Fac")))


def _combine(reader, node, output):
    return Combine(*(reader.value_of(socket) for socket in node.inputs), _model(node))


def _separate(reader, node, output):
    component = [socket.identifier for socket in node.outputs].index(output)
    return Separate(reader.value_of(node.inputs[0]), component, _model(node))


def _model(node):
    return "hsv" if node.type in ("COMBHSV", "SEPHSV") else getattr(node, "mode", "RGB").lower()


TABLE = {
    "RGB": _own,
    "VALUE": _own,
    "MIX_RGB": _mix_rgb,
    "VALTORGB": _ramp,
    "CURVE_RGB": _curves,
    "CURVE_VEC": _curves,
    "CURVE_FLOAT": _curves,
    "BRIGHTCONTRAST": _brightness_contrast,
    "HUE_SAT": _hue_saturation,
    "GAMMA": lambda reader, node, output: Gamma(reader.value(node, "Color"), reader.value(node, "Gamma")),
    "INVERT": lambda reader, node, output: Invert(reader.value(node, "Color"), reader.value(node, "Fac")),
    "RGBTOBW": lambda reader, node, output: Luminance(reader.value(node, "Color")),
    "BLACKBODY": lambda reader, node, output: Blackbody(reader.value(node, "Temperature")),
    "WAVELENGTH": lambda reader, node, output: Wavelength(reader.value(node, "Wavelength")),
    **dict.fromkeys(("COMBINE_COLOR", "COMBXYZ", "COMBRGB", "COMBHSV"), _combine),
    **dict.fromkeys(("SEPARATE_COLOR", "SEPXYZ", "SEPRGB", "SEPHSV"), _separate),
}
