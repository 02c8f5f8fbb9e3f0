"""Previews: the icons and panels of materials, worlds and lights, which Blender shows by little scenes of its own."""

from contextlib import closing

from ..engine import render
from .export import export_scene
from .results import make_room, write_tile
from .settings import ALL_SAMPLES, doubling, settings_of

SAMPLES = 16
MAX_DEPTH = 6
"""Through a ball of glass, and off what is behind it."""


def preview_settings(scene, view_layer, width, height):
    """`Settings` that are quick: Blender's little scene knows nothing of those of the user's."""
    quick = {"samples": SAMPLES, "max_depth": MAX_DEPTH, **ALL_SAMPLES}
    return settings_of(scene, view_layer, width=width, height=height, passes=("Combined",), **quick)


def render_preview(engine, depsgraph, check):
    """Render what Blender's render `engine` is to preview. `check` is called now and then, and may raise to stop."""
    settings = preview_settings(depsgraph.scene_eval, depsgraph.view_layer_eval, engine.resolution_x, engine.resolution_y)
    layer = depsgraph.view_layer.name
    make_room(engine, settings, layer)
    # What is not as in Blender is told when the scene itself is rendered.
    scene, _ = export_scene(depsgraph, settings, check=check)
    with closing(render(scene, settings, doubling(settings))) as progress:
        for step in progress:
            check()
            for tile in step.tiles:
                write_tile(engine, tile, settings.region, layer)
