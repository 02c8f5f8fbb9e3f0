"""What is inside of objects: Blender's volume nodes, and Glanz's own settings of a material."""

from dataclasses import replace

import numpy as np

from ...engine import Dielectric, LambertTransmission, Math, Medium, PhongTransmission, RelativeIndex, RoughRefraction
from .colours import typical, varies
from .findings import IGNORED
from .nodes import input_by_identifier
from .values import Reader

DENSEST = 1e30
"""Absorption [m^-1] beyond which products no longer fit into single precision."""


def medium_of(material, output, owner, findings):
    """The `Medium` inside of a material (evaluated) with this output node, or None where it is nothing but clear."""
    reader = Reader(owner, findings)
    absorption = _behind(reader, input_by_identifier(output, "Volume"))
    clean = np.clip(np.nan_to_num(absorption, nan=0.0), 0.0, DENSEST)
    if not np.array_equal(clean, absorption):
        findings.note("a colour or density of the volume is negative, above 1 or not finite and is cut off", owner)
    priority = getattr(getattr(material, "glanz", None), "priority", 0)
    return Medium(absorption=tuple(clean.tolist()), priority=priority) if clean.any() or priority else None


def absorbs(medium):
    """Whether a `Medium` (or None) weakens light."""
    return medium is not None and any(medium.absorption)


def with_dispersion(lobes, material):
    """`lobes` of which glass has the material's Abbe number, if any."""
    abbe = getattr(getattr(material, "glanz", None), "abbe", 0.0)
    return tuple(replace(lobe, abbe=max(abbe, 1.0)) if abbe > 0 and type(lobe) is Dielectric else lobe for lobe in lobes)


def with_one_index(lobes):
    """`lobes` of which all scale radiance by one index of refraction, that of what is behind them: the first one's, on average.

    Else light that came in by one index and leaves by another, where shaders are mixed or the index varies, would be won or lost.
    What lets light through without an index, as paper does, scales none: beside it that of a vacuum, by which nothing is scaled.
    """
    indices = [typical(_index(lobe)) for lobe in lobes if _has_index(lobe)]
    inside = indices[0] if indices and not any(isinstance(lobe, LambertTransmission | PhongTransmission) for lobe in lobes) else 1.0
    return tuple(replace(lobe, etendue=_etendue(_index(lobe), inside)) if _has_index(lobe) else lobe for lobe in lobes)


def _has_index(lobe):
    return isinstance(lobe, Dielectric | RoughRefraction)


def _index(lobe):
    # What a rough boundary has is a relative one.
    return lobe.ior.ior if isinstance(lobe, RoughRefraction) and varies(lobe.ior) else lobe.ior


def _etendue(ior, inside):
    if not varies(ior) and ior == inside:
        return 1.0
    ratio = Math(RelativeIndex(ior), RelativeIndex(inside), operation="divide")
    return Math(ratio, ratio, operation="multiply")


def _behind(reader, socket):
    """Absorption (3,) [m^-1] of whatever feeds a volume input."""
    reader, _, output = reader.source(socket)
    if output is None:
        return np.zeros(3)
    node, inside = output.node, reader.beyond(output.node)
    return reader.once(output, lambda: _TABLE.get(node.type, _left_out)(inside, node)) if inside else np.zeros(3)


def _left_out(reader, node):
    reader.note(f"the volume is left out: {node.bl_label} is not supported", IGNORED)
    return np.zeros(3)


def _absorption(reader, node):
    """As Cycles has it: what a colour lacks is lost, at this density [m^-1]."""
    return reader.number(node, "Density", 1.0) * (1 - np.array(reader.colour(node, "Color")))


def _add(reader, node):
    return _behind(reader, node.inputs[0]) + _behind(reader, node.inputs[1])


def _mix(reader, node):
    factor = min(max(reader.number(node, "Fac", default=0.5), 0.0), 1.0)
    first, second = (_behind(reader, node.inputs[i]) for i in (1, 2))
    return (1 - factor) * first + factor * second


_TABLE = {"VOLUME_ABSORPTION": _absorption, "ADD_SHADER": _add, "MIX_SHADER": _mix}
"""Node type -> function (reader, node) -> absorption."""
