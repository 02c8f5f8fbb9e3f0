"""Blender's materials as the engine's."""

from dataclasses import replace
from functools import reduce

import numpy as np

from ...engine import Material, Transparent
from .closure import Closure, colours_of, diffuse, merged, scaled_lobe, transparent, with_colours
from .colours import BLACK, added, as_texture, cut, inverted, varies
from .findings import IGNORED, Findings
from .inside import absorbs, medium_of, with_dispersion, with_one_index
from .lecture import is_lecture, lecture_medium, lecture_surface
from .missing import note_missing
from .nodes import aov_nodes, has_nodes, output_node
from .principled import Layers
from .relief import displacement_of
from .shaders import surface_of
from .values import Reader

BRIGHTEST = 1e30
"""Radiance [W m^-2 sr^-1] beyond which products no longer fit into single precision."""

DEFAULT = Material(name="default_surface", lobes=Layers().lobes()[0])
"""What faces without a material wear: Blender's default Principled BSDF. Mattes know it by the name that Cycles gives it."""


def export_material(material, findings, bitmaps=None, aovs=()):
    """The engine's `Material` for a material (evaluated); None is `DEFAULT`. Without `bitmaps` textures are not read.

    aovs  the names of those that passes show
    """
    if material is None:
        return DEFAULT
    index = float(getattr(material, "pass_index", 0))
    return replace(_surface(material, findings, bitmaps), index=index, aovs=_aovs(material, findings, bitmaps, aovs))


def _aovs(material, findings, bitmaps, names):
    """{name: value} of the AOV Output nodes of `names`, as pairs; those inside of groups count, too."""
    if not names or is_lecture(material) or not has_nodes(material):
        return ()
    found = {}
    for reader, node in aov_nodes(Reader(f"material '{material.name}'", findings, bitmaps), material.node_tree):
        name, is_value = node.aov_name, ("Value", node.aov_name) in names
        if is_value or ("Color", name) in names:
            found[name] = as_texture(reader.value(node, "Value" if is_value else "Color"))
    return tuple(found.items())


def _surface(material, findings, bitmaps):
    owner = f"material '{material.name}'"
    note_missing(material, owner, findings)
    if is_lecture(material):
        checked = _checked(material.name, owner, lecture_surface(material, owner, findings), findings)
        return replace(checked, ambient=clean_colour(material.glanz.k_a, owner, findings), medium=lecture_medium(material))
    if not has_nodes(material):
        return _checked(material.name, owner, diffuse(tuple(material.diffuse_color)[:3]), findings)
    output = output_node(material.node_tree)
    if output is None:
        findings.note("the node tree has no active output, so the material is black", owner)
        return Material(name=material.name)
    reader = Reader(owner, findings, bitmaps)
    medium = medium_of(material, output, owner, findings)
    # Without a surface a volume has a boundary that is not seen.
    is_bare = absorbs(medium) and not reader.is_linked(output, "Surface")
    surface = transparent((1.0, 1.0, 1.0)) if is_bare else surface_of(output, owner, findings, bitmaps)
    if not getattr(material, "use_transparent_shadow", True) and any(isinstance(lobe, Transparent) for lobe in surface.lobes):
        findings.note("Transparent Shadows is off, but transparent surfaces let shadow rays pass all the same", owner, IGNORED)
    checked = _checked(material.name, owner, surface, findings)
    relief = displacement_of(reader, output) + next(filter(None, surface.reliefs), ())
    if len(surface.reliefs) > 1:
        findings.note("its shaders have different normals, all are rendered with those of the first that is bent", owner)
    return replace(checked, lobes=with_one_index(with_dispersion(checked.lobes, material)), medium=medium, relief=relief)


def held_out(material):
    """An engine `Material` as the camera sees it on objects that are held out: nothing is left but what passes straight on."""
    lobes = tuple(lobe for lobe in material.lobes if isinstance(lobe, Transparent))
    passed = reduce(added, (lobe.transmittance for lobe in lobes), BLACK)
    return Material(name=material.name, lobes=lobes, holdout=inverted(passed), index=material.index)


def is_volume_only(material):
    """Whether a material (or None) has but an inside that is not rendered, and no surface, so that nothing is left of it."""
    if material is None or is_lecture(material) or not has_nodes(material):
        return False
    output = output_node(material.node_tree)
    if output is None:
        return False
    reader = Reader(f"material '{material.name}'", Findings())
    if not reader.is_linked(output, "Volume") or reader.is_linked(output, "Surface"):
        return False
    return not absorbs(medium_of(material, output, reader.owner, reader.findings))


def _checked(name, owner, closure, findings):
    """A material whose colours are what the engine allows: finite, not negative, reflecting at most what arrives."""
    lobes = tuple(_clean_lobe(lobe, owner, findings) for lobe in merged(closure.lobes))
    most = Closure(lobes).albedo().max()
    if most > 1:
        if most > 1 + 1e-6:  # rounding is nobody's fault
            findings.note("the material reflects more than it receives, so it is darkened", owner)
        lobes = tuple(scaled_lobe(lobe, 1 / most) for lobe in lobes)
    held = closure.holdout if varies(closure.holdout) else cut(clean_colour(closure.holdout, owner, findings))
    return Material(name=name, lobes=lobes, emission=clean_colour(closure.emission, owner, findings), holdout=held)


def _clean_lobe(lobe, owner, findings):
    return with_colours(lobe, (clean_colour(colour, owner, findings) for colour in colours_of(lobe)))


def clean_colour(colour, owner, findings):
    """`colour` as three finite numbers from 0 to BRIGHTEST, textures as they are; notes what had to be changed."""
    if varies(colour):
        return colour
    values = np.array(colour, np.float64)
    clean = np.clip(np.nan_to_num(values, nan=0.0, posinf=BRIGHTEST, neginf=0.0), 0.0, BRIGHTEST)
    if not np.array_equal(values, clean):
        findings.note("a colour or strength is negative or not finite and is cut off", owner)
    return tuple(clean.tolist())
