"""Blender's shader nodes as closures: to support another node is to add a function and a row of the table."""

from dataclasses import replace

from . import closure
from .closure import Closure
from .colours import cut, inverted, is_texture
from .environment import export_environment
from .nodes import Reader, input_by_identifier
from .principled import principled_lobes
from .relief import relief_of
from .textures import colour_of, number_of

_WHITE = (1.0, 1.0, 1.0)


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
    node = output.node
    read = _TABLE.get(node.type, _approximated)
    return read(reader.beyond(node), node)


def _approximated(reader, node):
    """Nodes that are not understood are diffuse in their colour, and say so."""
    if input_by_identifier(node, "Color") is None:
        reader.note(f"{node.bl_label} is not supported and is rendered black")
        return Closure()
    reader.note(f"{node.bl_label} is not supported and is rendered as Diffuse of its colour")
    return closure.diffuse(share_of(reader, node, "Color"))


def share_of(reader, node, identifier):
    """The colour of an input that is a share of light; a texture is cut off to [0, 1]."""
    colour = colour_of(reader, node, identifier)
    if is_texture(colour) and cut(colour) is not colour:
        reader.note(f"{identifier} of {node.bl_label} has a texture brighter than 1 or below 0, which is cut off")
        return cut(colour)
    return colour


def _bent(reader, node, shader):
    """The closure of a shader node with the relief that bends its normals."""
    return replace(shader, reliefs=(relief_of(reader, node),))


def _diffuse(reader, node):
    if reader.number(node, "Roughness") > 0:
        reader.note("Roughness of Diffuse BSDF is left out")
    return _bent(reader, node, closure.diffuse(share_of(reader, node, "Color")))


def _translucent(reader, node):
    return _bent(reader, node, closure.translucent(share_of(reader, node, "Color")))


def _glossy(reader, node):
    if reader.number(node, "Anisotropy") != 0:
        reader.note("Anisotropy of Glossy BSDF is left out")
    return _bent(reader, node, closure.glossy(share_of(reader, node, "Color"), reader.number(node, "Roughness")))


def _glass(reader, node):
    if reader.is_linked(node, "Roughness") or reader.number(node, "Roughness") > 0:
        reader.note("Roughness of Glass BSDF is left out, it is rendered smooth")
    return _bent(reader, node, closure.glass(share_of(reader, node, "Color"), reader.number(node, "IOR", 1.5)))


def _emission(reader, node):
    return closure.emission(colour_of(reader, node, "Color"), reader.number(node, "Strength"))


def _background(reader, node):
    """Emission of a world, which may be a picture."""
    behind, _, output = reader.source(input_by_identifier(node, "Color"))
    if output is None or output.node.type != "TEX_ENVIRONMENT":
        return _emission(reader, node)
    if (behind := behind.beyond(output.node)) is None:
        return Closure()
    return Closure(environments=(export_environment(behind, output.node, reader.number(node, "Strength")),))


def _transparent(reader, node):
    return closure.transparent(reader.colour(node, "Color"))


def _add(reader, node):
    first, second = (_behind(reader, socket) for socket in node.inputs[:2])
    # What is emitted is not cut out, so it may be added.
    if first.lobes and second.lobes:
        first, second = (_averaged(reader, shader) for shader in (first, second))
    return first + second


def _mix(reader, node):
    factor = number_of(reader, node, "Fac", default=0.5)
    first, second = (_behind(reader, node.inputs[i]) for i in (1, 2))
    if is_texture(factor):
        for clear, other, alpha in ((first, second, factor), (second, first, inverted(factor))):
            if closure.is_clear(clear):
                return _cut_out(reader, alpha, other)
        reader.note("a texture that mixes two shaders counts with its average, unless one of them is Transparent and white")
        factor = closure.average(factor)
    return closure.mix(factor, *(_averaged(reader, shader) for shader in (first, second)))


def _averaged(reader, shader):
    """A closure without a texture for its alpha."""
    if is_texture(shader.alpha):
        reader.note("the texture of an alpha counts with its average where the shader is mixed with another")
    return closure.without_texture(shader)


def _cut_out(reader, alpha, shader):
    """`shader` where the surface is, by `alpha`, a number or texture."""
    if is_texture(alpha) and (is_texture(shader.emission) or any(shader.emission)):
        reader.note("what is emitted is not cut out by a texture for alpha, it counts with its average")
    return closure.with_alpha(alpha, _averaged(reader, shader))


_LEFT_OUT = {
    "Subsurface Weight": "Subsurface of Principled BSDF is rendered as diffuse",
    "Coat Weight": "Coat of Principled BSDF is left out",
    "Sheen Weight": "Sheen of Principled BSDF is left out",
    "Anisotropic": "Anisotropy of Principled BSDF is left out",
    "Thin Film Thickness": "Thin film of Principled BSDF is left out",
    "Thin Wall": "Thin wall of Principled BSDF is left out",
    "Diffuse Roughness": "Diffuse roughness of Principled BSDF is left out",
}


def _principled(reader, node):
    for identifier, note in _LEFT_OUT.items():
        if reader.is_linked(node, identifier) or reader.number(node, identifier):
            reader.note(note)
    transmission = reader.number(node, "Transmission Weight")
    if transmission > 0 and reader.number(node, "Roughness") > 0:
        reader.note("Roughness of what passes a Principled BSDF is left out, it is rendered smooth")
    base = share_of(reader, node, "Base Color")
    if transmission > 0 and is_texture(base):
        reader.note("what passes a Principled BSDF is tinted by the average of the texture of its Base Color")
    lobes = principled_lobes(
        base,
        reader.number(node, "Metallic"),
        reader.number(node, "Roughness"),
        reader.number(node, "IOR", 1.5),
        reader.number(node, "Specular IOR Level", 0.5),
        reader.colour(node, "Specular Tint", _WHITE),
        transmission,
    )
    shine = closure.emission(colour_of(reader, node, "Emission Color"), reader.number(node, "Emission Strength"))
    return _cut_out(reader, number_of(reader, node, "Alpha", 1.0), _bent(reader, node, Closure(lobes, shine.emission)))


_TABLE = {
    "BSDF_PRINCIPLED": _principled,
    "BSDF_DIFFUSE": _diffuse,
    "BSDF_GLOSSY": _glossy,
    "BSDF_GLASS": _glass,
    "BSDF_TRANSLUCENT": _translucent,
    "BSDF_TRANSPARENT": _transparent,
    "EMISSION": _emission,
    "BACKGROUND": _background,
    "MIX_SHADER": _mix,
    "ADD_SHADER": _add,
}
"""Node type -> function (reader, node) -> Closure."""
