"""The engine's tiles into Blender's render result: the one place that knows its layout.

Blender counts rows from the bottom, and positions from the corner of the border. A result that was begun must be
ended exactly once: twice is a crash, never is a leak.
"""

from contextlib import contextmanager

import numpy as np

from ..engine import PASSES, MemoryShortage, require_memory
from .passes import chosen, name_of


def flat_pixels(values):
    """(height, width, channels) with row 0 at the top, as the flat float32 array with row 0 at the bottom that Blender wants."""
    return np.ascontiguousarray(values[::-1], np.float32).reshape(-1)


def place_in_result(tile, region):
    """(x, y, width, height) of a tile in Blender's result: from the bottom left of `region` (x0, y0, x1, y1) [px]."""
    x0, _, _, y1 = region
    return tile.x - x0, y1 - (tile.y + tile.height), tile.width, tile.height


@contextmanager
def open_result(engine, place, layer, view=""):
    """Blender's result for `place`; kept when the block ends well, dropped when it raises.

    Raises RuntimeError where Blender does not grant the whole of `place`.
    """
    result = engine.begin_result(*place, layer=layer, view=view)
    if result is None:
        raise RuntimeError(f"Blender has no room for the tile at {place[:2]} px of view layer '{layer}'")
    keep = False
    try:
        if (result.resolution_x, result.resolution_y) != place[2:]:
            raise RuntimeError(f"Blender's tile is {result.resolution_x}x{result.resolution_y} px, expected {place[2]}x{place[3]}")
        yield result
        keep = True
    finally:
        engine.end_result(result, cancel=not keep)


def make_room(engine, settings, layer, scene=None):
    """Let Blender allocate its picture now, before anything can go wrong.

    It does so at the first result, and saving a picture that never had one is a crash; so is having no memory for it.
    Blender has room for all passes of all view layers and eyes of a `scene` at once; without, for those of `settings` alone.
    Raises GlanzError where the memory is not to be had. Returns the names of the views, ("",) where there is but one.
    """
    x0, y0, x1, y1 = settings.region
    channels = _channels(scene) if scene else sum(len(PASSES[key].channels) for key in settings.passes)
    # Blender's picture, and a copy of it for the display; what is not cut to its border is put into the full frame.
    region = (x1 - x0) * (y1 - y0)
    is_uncut = scene and scene.render.use_border and not scene.render.use_crop_to_border
    size = 4 * channels * (region + (settings.width * settings.height if is_uncut else region))
    what, cure = (
        f"Blender's picture and its copy, {x1 - x0}x{y1 - y0} px with {channels} channels,",
        "lower the resolution, or switch off passes",
    )
    require_memory(size, what, cure)
    try:
        # Where the system does not say how much is free.
        np.empty(size, np.uint8)
    except MemoryError:
        raise MemoryShortage(f"{what} take {size / 2**30:.1f} GiB of memory, which are not to be had: {cure}") from None
    with open_result(engine, (0, 0, 1, 1), layer) as result:
        return tuple(view.name for view in result.views) or ("",)


def _channels(scene):
    """Of all that Blender has room for."""
    render = scene.render
    eyes = sum(view.use for view in render.views) if render.use_multiview else 1
    return eyes * sum(len(PASSES[key].channels) for layer in scene.view_layers if layer.use for key in chosen(layer, scene))


def write_tile(engine, tile, region, layer, view=""):
    """Show and keep a finished `tile`; passes that the tile does not have stay empty."""
    known = {name_of(key): values for key, values in tile.passes.items()}
    with open_result(engine, place_in_result(tile, region), layer, view) as result:
        for render_pass in result.layers[0].passes:
            values = known.get(render_pass.name)
            if values is not None:
                render_pass.rect.foreach_set(flat_pixels(values))


class Outlines:
    """The tiles that Blender's render `engine` outlines in its picture, which is that of `region` (x0, y0, x1, y1) [px].

    Blender takes the outline of a tile away when it gets its result, even where that is unfinished; and Blender 5.2 does not
    draw anew for an outline that is taken away by itself.
    """

    def __init__(self, engine, region):
        engine.use_highlight_tiles = True
        self._engine, (self._left, _, _, self._bottom) = engine, region

    def show(self, places):
        """Outline `places`, (x, y, width, height) [px] from the top left of the full frame, and no others."""
        self._engine.tile_highlight_clear_all()
        for x, y, width, height in places:
            self._engine.tile_highlight_set(x - self._left, self._bottom - y - height, width, height, True)


def outcome(layer, reached, done, seconds, warnings):
    """What saved files should say of each of their layers once it is rendered, {str: str}; below 100 % `done` it was cancelled.

    reached  the engine's `Reached` of its last picture
    """
    facts = {**reached.facts(), "done": f"{int(100 * done)}%", "total_time": f"{seconds:.2f} s", "warnings": warnings}
    return {f"glanz.{layer}.{name}": str(value) for name, value in facts.items()}


def stamp(engine, facts):
    """Let saved files say how the picture was made; `facts` is {str: str}."""
    result = engine.get_result()
    for name, value in facts.items():
        result.stamp_data_add_field(name, value)
