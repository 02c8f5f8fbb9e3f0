"""A Blender scene's settings as the engine's `Settings`: the file's own, or whatever overrides them."""

import dataclasses

import numpy as np

from ..engine import SceneError, Settings
from . import passes

FIELDS = tuple(field.name for field in dataclasses.fields(Settings))
_OWN = (
    "integrator",
    "samples",
    "max_depth",
    "max_transparent",
    "branches",
    "min_contribution",
    "light_falloff",
    "clamp_direct",
    "clamp_indirect",
    "seed",
    "sampler",
    "pixel_filter",
    "filter_width",
    "filter_textures",
    "error_target",
    "error_measure",
    "adaptive_sampling",
    "time_limit",
    "replicates",
    "adaptive_threshold",
    "adaptive_levels",
    "precision",
    "tile_size",
    "motion_steps",
)
"""Read from `scene.glanz`; the names are the same on both sides."""
ALL_SAMPLES = {"replicates": 1, "error_target": 0.0, "time_limit": 0.0}
"""Overrides for pictures that are looked at while they refine: nobody asks for their error, and nothing else ends them."""


def settings_of(scene, view_layer, **overrides):
    """`Settings` for `scene` (evaluated, so that animated settings count) and the passes of `view_layer`.

    `overrides` are fields of `Settings`. Raises SceneError for a name that is none, and for values out of range.
    """
    unknown = sorted(set(overrides) - set(FIELDS))
    if unknown:
        raise SceneError(f"unknown settings {', '.join(unknown)}; known: {', '.join(FIELDS)}")
    render = scene.render
    width, height = resolution(render.resolution_x, render.resolution_y, render.resolution_percentage)
    values = {"width": width, "height": height, "threads": render.threads if render.threads_mode == "FIXED" else 0}
    values["film_transparent"] = render.film_transparent
    values |= {name: getattr(scene.glanz, name) for name in _OWN}
    if values["adaptive_threshold"]:
        # The panel greys them out.
        values |= {"error_target": 0.0, "time_limit": 0.0}
    lost = [name for name in ("integrator", "sampler", "pixel_filter") if not values[name]]
    if lost and not set(lost) <= set(overrides):
        raise SceneError(f"scene '{scene.name}': this version of Glanz does not know its {', '.join(lost)}: choose anew")
    # A view layer may have samples of its own; 0 means the scene's.
    values["samples"] = view_layer.samples or values["samples"]
    values["passes"] = passes.chosen(view_layer, scene)
    values |= overrides
    if render.use_border and "border" not in overrides:
        fractions = (render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y)
        values["border"] = border(fractions, values["width"], values["height"])
    return Settings(**values)


def doubling(settings):
    """The ends of rounds over the whole frame, of which each has as many samples as all before it: 1, 2, 4, 8 ..."""
    begin, end = settings.rendered_samples
    return tuple(begin + 2**i for i in range((end - begin).bit_length()))


def resolution(width, height, percentage):
    """(width, height) [px] of the full frame, rounded down as Blender does."""
    return width * percentage // 100, height * percentage // 100


def border(fractions, width, height):
    """(x0, y0, x1, y1) [px] from the top left, of Blender's border (min x, max x, min y, max y) in [0, 1] from the bottom left.

    Blender truncates in single precision; to differ by a pixel is to have no room in its result. The whole frame is ().
    """
    sizes = (width, width, height, height)
    left, right, bottom, top = (int(np.float32(f) * np.float32(n)) for f, n in zip(fractions, sizes, strict=True))
    edges = (left, height - top, right, height - bottom)
    return () if edges == (0, 0, width, height) else edges
