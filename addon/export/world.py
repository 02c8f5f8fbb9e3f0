"""Blender's world as the engine's: an even radiance from every direction, a picture, or a texture of all directions."""

from dataclasses import replace

from ...engine import RAY_KINDS, Mist, World
from .environment import as_picture
from .findings import IGNORED
from .material import clean_colour
from .missing import note_missing
from .nodes import aov_nodes, has_nodes, output_node
from .shaders import surface_of
from .values import Reader


def export_world(world, findings, bitmaps, aovs=()):
    """The engine's `World` for a world (evaluated), its images by `bitmaps`; none is black.

    aovs  the names of those that passes show, of which a world has none
    """
    if world is None:
        return World()
    _note_aovs(world, findings, {name for _, name in aovs})
    # Cycles stores them, where it is enabled.
    own, mist = getattr(world, "cycles_visibility", None), world.mist_settings
    return replace(
        _surroundings(world, findings, bitmaps),
        mist=Mist(start=mist.start, depth=mist.depth, falloff=mist.falloff.lower()),
        group=world.lightgroup,
        occlusion_distance=world.light_settings.distance,
        hidden_from=tuple(kind for kind in RAY_KINDS[:-1] if not getattr(own, kind, True)),
    )


def _note_aovs(world, findings, names):
    owner = f"world '{world.name}'"
    if names and has_nodes(world) and any(node.aov_name in names for _, node in aov_nodes(Reader(owner, findings), world.node_tree)):
        findings.note("its AOVs are left out, they are 0 where the world is seen", owner, IGNORED)


def _surroundings(world, findings, bitmaps):
    owner = f"world '{world.name}'"
    note_missing(world, owner, findings)
    if not has_nodes(world):
        return World(name=world.name, radiance=clean_colour(world.color, owner, findings))
    output = output_node(world.node_tree)
    if output is None:
        findings.note("the node tree has no active output, so the world is black", owner)
        return World(name=world.name)
    if Reader(owner, findings).is_linked(output, "Volume"):
        findings.note("the volume is left out", owner, IGNORED)
    radiance, picture = as_picture(surface_of(output, owner, findings, bitmaps).emission)
    if picture is None:
        return World(name=world.name, radiance=clean_colour(radiance, owner, findings))
    strength = clean_colour(picture.strength, owner, findings)
    return World(name=world.name, radiance=clean_colour(radiance, owner, findings), environment=replace(picture, strength=strength))
