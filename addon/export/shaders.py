"""Blender's shader nodes as closures: to support another node is to add a function and a row of the table."""

from dataclasses import replace

from ...engine import Clamp
from . import closure
from .closure import Closure
from .colours import varies
from .findings import APPROXIMATED, IGNORED
from .nodes import input_by_identifier
from .principled import Layers, fibres
from .relief import relief_of
from .values import Reader

_WHITE = (1.0, 1.0, 1.0)
_IORS = (0.001, 1000.0)
"""What boundaries may have, the engine says."""


def surface_of(output, owner, findings, bitmaps=None):
    """The `Closure` behind the surface of an output node of a material, world or light; `owner` is named in notes.

    Textures are read where there are `bitmaps` for their images.
    """
    return _behind(Reader(owner, findings, bitmaps), input_by_identifier(output, "Surface"))


def _behind(reader, socket):
    """The closure of whatever feeds a shader input; nothing feeds it: black."""
    reader, _, output = reader.source(socket)
    if output is None:
        return Closure()
    node, inside = output.node, reader.beyond(output.node)
    read = _TABLE.get(node.type, _approximated)
    return reader.once(output, lambda: read(inside, node)) if inside else Closure()


def _approximated(reader, node):
    """Nodes that are not understood are diffuse in their colour, and say so."""
    if input_by_identifier(node, "Color") is None:
        reader.note(f"{node.bl_label} is not supported and is rendered black", IGNORED)
        return Closure()
    reader.note(f"{node.bl_label} is not supported and is rendered as Diffuse of its colour")
    return closure.diffuse(reader.value(node, "Color"))


def _bent(reader, node, shader):
    """The closure of a shader node with the relief that bends its normals."""
    return replace(shader, reliefs=(relief_of(reader, node),))


def _diffuse(reader, node):
    return _bent(reader, node, closure.diffuse(reader.value(node, "Color"), reader.value(node, "Roughness")))


def _translucent(reader, node):
    return _bent(reader, node, closure.translucent(reader.value(node, "Color")))


def _glossy(reader, node):
    _without_anisotropy(reader, node, "Anisotropy")
    return _bent(reader, node, closure.glossy(reader.value(node, "Color"), reader.value(node, "Roughness"), _preserves(node)))


def _glass(reader, node):
    _without_film(reader, node)
    values = reader.value(node, "Color"), _ior(reader, node), reader.value(node, "Roughness"), _preserves(node)
    return _bent(reader, node, closure.glass(*values))


def _preserves(node):
    """Whether light that the microfacets scatter several times is not lost."""
    return getattr(node, "distribution", "MULTI_GGX") == "MULTI_GGX"


def _ior(reader, node, identifier="IOR", default=1.5):
    ior = reader.value(node, identifier, default)
    if varies(ior):
        return Clamp(ior, *_IORS)
    allowed = min(max(ior, _IORS[0]), _IORS[1])
    if allowed != ior:
        reader.note("an IOR is beyond 0.001 to 1000 and is cut off")
    return allowed


def _emission(reader, node):
    return closure.emission(reader.value(node, "Color"), reader.value(node, "Strength"))


def _transparent(reader, node):
    return closure.transparent(reader.value(node, "Color"))


def _add(reader, node):
    first, second = (_behind(reader, socket) for socket in node.inputs[:2])
    return first + second


def _mix(reader, node):
    first, second = (_behind(reader, node.inputs[i]) for i in (1, 2))
    return closure.mix(reader.value(node, "Fac", 0.5), first, second)


def _refraction(reader, node):
    values = reader.value(node, "Color"), _ior(reader, node, default=1.45), reader.value(node, "Roughness")
    return _bent(reader, node, closure.refraction(*values))


def _metallic(reader, node):
    _without_anisotropy(reader, node, "Anisotropy")
    _without_film(reader, node)
    roughness = reader.value(node, "Roughness", 0.5)
    if getattr(node, "fresnel_type", "F82") == "F82":
        values = reader.value(node, "Base Color"), reader.value(node, "Edge Tint", _WHITE)
        return _bent(reader, node, closure.metal(*values, roughness, _preserves(node)))
    values = reader.value(node, "IOR"), reader.value(node, "Extinction")
    return _bent(reader, node, closure.conductor(*values, roughness, _preserves(node)))


def _sheen(reader, node):
    reader.note("Sheen BSDF is rendered as Diffuse that is brightest at the rim")
    kind = getattr(node, "distribution", "MICROFIBER").lower()
    return _bent(reader, node, closure.diffuse(fibres(reader.value(node, "Color"), reader.value(node, "Roughness", 0.5), kind)))


def _holdout(reader, node):
    return Closure(holdout=_WHITE)


def _without_film(reader, node):
    if reader.is_linked(node, "Thin Film Thickness") or reader.number(node, "Thin Film Thickness"):
        reader.note(f"Thin film of {node.bl_label} is left out", IGNORED)


def _without_anisotropy(reader, node, identifier):
    if reader.is_linked(node, identifier) or reader.number(node, identifier) != 0:
        reader.note(f"Anisotropy of {node.bl_label} is left out", IGNORED)


_LEFT_OUT = {
    "Subsurface Weight": ("Subsurface of Principled BSDF is rendered as diffuse", APPROXIMATED),
    "Sheen Weight": ("Sheen of Principled BSDF is rendered as diffuse, brighter towards the rim", APPROXIMATED),
    "Anisotropic": ("Anisotropy of Principled BSDF is left out", IGNORED),
    "Thin Film Thickness": ("Thin film of Principled BSDF is left out", IGNORED),
    "Thin Wall": ("Thin wall of Principled BSDF is left out", IGNORED),
}


def _principled(reader, node):
    for identifier, (what, kind) in _LEFT_OUT.items():
        if reader.is_linked(node, identifier) or reader.number(node, identifier):
            reader.note(what, kind)
    if reader.is_linked(node, "Coat Normal") and (reader.is_linked(node, "Coat Weight") or reader.number(node, "Coat Weight")):
        reader.note("Coat Normal of Principled BSDF is left out, the coat has the normal of the base", IGNORED)
    lobes, left = Layers(
        base=reader.value(node, "Base Color"),
        metallic=reader.value(node, "Metallic"),
        roughness=reader.value(node, "Roughness", 0.5),
        ior=_ior(reader, node),
        specular_level=reader.value(node, "Specular IOR Level", 0.5),
        tint=reader.value(node, "Specular Tint", _WHITE),
        transmission=reader.value(node, "Transmission Weight"),
        coat=reader.value(node, "Coat Weight"),
        coat_roughness=reader.value(node, "Coat Roughness", 0.03),
        coat_ior=_ior(reader, node, "Coat IOR"),
        coat_tint=reader.value(node, "Coat Tint", _WHITE),
        sheen=reader.value(node, "Sheen Weight"),
        sheen_tint=reader.value(node, "Sheen Tint", _WHITE),
        sheen_roughness=reader.value(node, "Sheen Roughness", 0.5),
        diffuse_roughness=reader.value(node, "Diffuse Roughness"),
    ).lobes()
    shine = closure.emission(reader.value(node, "Emission Color"), reader.value(node, "Emission Strength")).scaled(left)
    return closure.with_alpha(reader.value(node, "Alpha", 1.0), _bent(reader, node, Closure(lobes, shine.emission)))


_TABLE = {
    "BSDF_PRINCIPLED": _principled,
    "BSDF_DIFFUSE": _diffuse,
    "BSDF_GLOSSY": _glossy,
    "BSDF_GLASS": _glass,
    "BSDF_REFRACTION": _refraction,
    "BSDF_METALLIC": _metallic,
    "BSDF_SHEEN": _sheen,
    "BSDF_TRANSLUCENT": _translucent,
    "BSDF_TRANSPARENT": _transparent,
    "EMISSION": _emission,
    "BACKGROUND": _emission,
    "HOLDOUT": _holdout,
    "MIX_SHADER": _mix,
    "ADD_SHADER": _add,
}
"""Node type -> function (reader, node) -> Closure."""
