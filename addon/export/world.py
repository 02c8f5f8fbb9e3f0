"""Blender's world as the engine's: an even radiance from every direction, and a picture."""

from dataclasses import replace

from ...engine import World
from .material import clean_colour
from .nodes import has_nodes, output_node
from .shaders import surface_of
from .values import Reader


def export_world(world, findings):
    """The engine's `World` for a world (evaluated); none is black."""
    if world is None:
        return World()
    owner = f"world '{world.name}'"
    if not has_nodes(world):
        return World(name=world.name, radiance=clean_colour(world.color, owner, findings))
    output = output_node(world.node_tree)
    if output is None:
        findings.note("the node tree has no active output, so the world is black", owner)
        return World(name=world.name)
    if Reader(owner, findings).is_linked(output, "Volume"):
        findings.note("the volume is left out", owner)
    surface = surface_of(output, owner, findings)
    radiance = clean_colour(surface.emission, owner, findings)
    return World(name=world.name, radiance=radiance, environment=_environment(surface.environments, owner, findings))


def _environment(environments, owner, findings):
    """The one picture that the engine takes, or None."""
    if not environments:
        return None
    if len(environments) > 1:
        findings.note("of several Environment Textures only the first is rendered", owner)
    first = environments[0]
    return replace(first, strength=clean_colour(first.strength, owner, findings))
