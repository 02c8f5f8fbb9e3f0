"""Rendered 3D views of Blender: hands over what is to be seen, draws what there is.

Blender calls `update` when data has changed and `draw` for each redraw; both only copy. A timer asks for redraws while there is
more to come, so that nothing of Blender's is ever touched by another thread.
"""

import weakref

import bpy
import gpu
import numpy as np
from gpu_extras.presets import draw_texture_2d

from .export import Kept, export_contents
from .reports import explain
from .settings import ALL_SAMPLES, settings_of
from .viewport import ENDLESS, Session
from .viewport_camera import view_of

_TICK_SECONDS = 1 / 60
_TILE = 128
"""Pixels: batches large enough to be worth their while, and small enough to be given up soon."""
_LOOKS = ("MATERIAL", "NODETREE", "WORLD", "LIGHT", "IMAGE", "TEXTURE", "LINESTYLE")
"""Blender's types of data-blocks that change how things look, and not where they are."""

_viewports = weakref.WeakSet()


class Viewport:
    """What one 3D view shows, for the render engine of Blender's that serves it."""

    def __init__(self, engine):
        self._engine = weakref.ref(engine)
        self._session, self._kept = Session(), Kept()
        # When Blender frees an engine nothing of it can be asked for any more, also not in a `__del__`.
        weakref.finalize(engine, self._session.close)
        self._scene, self._notes, self._failure = None, (), ""
        self._is_local, self._cast = None, ()
        self._drawn, self._texture, self._text = None, None, None
        self._is_ticking = False
        _viewports.add(self)

    @property
    def is_closed(self):
        """Whether it shows nothing any more."""
        return self._session.is_closed

    def update(self, context, depsgraph):
        """Copy what has changed."""
        if self._scene is not None and _concerns_cameras_alone(depsgraph):
            return
        if self._scene is None or _may_look_different(depsgraph) or _cast(context.space_data, depsgraph) != self._cast:
            self._export(context.space_data, depsgraph)

    def draw(self, context, depsgraph):
        """Draw what there is, and see to it that there will be what the view now looks at."""
        space = context.space_data
        if bool(space.local_view) != self._is_local:
            self._export(space, depsgraph)
        view, failure = None, self._failure
        try:
            view = view_of(context.region, context.region_data, space, depsgraph)
            self._session.look(view, view and self._settings(view, depsgraph))
        except Exception as error:
            failure = explain(error)
            self._session.look(None, None)
        if view:
            self._show(view.rectangle, depsgraph.scene)
        self._tell(failure or self._session.status, _ignored(space, context.region_data, depsgraph.scene))
        if self._session.is_busy and not self._is_ticking:
            self._is_ticking = True
            bpy.app.timers.register(self._tick, first_interval=_TICK_SECONDS)

    def close(self):
        """End what is going on."""
        self._session.close()
        self._texture = None

    def _export(self, space, depsgraph):
        self._is_local, self._cast = bool(space.local_view), _cast(space, depsgraph)
        self._kept.forget(depsgraph)
        self._kept.tidy()
        try:
            self._scene, self._notes = export_contents(depsgraph, self._kept, lambda ob: ob.visible_in_viewport_get(space))
            self._failure = ""
        except Exception as error:
            self._scene, self._failure = None, explain(error)
        self._session.show(self._scene)

    def _settings(self, view, depsgraph):
        # The evaluated ones know what scripts have set only after the next change.
        scene, (_, _, width, height) = depsgraph.scene, view.rectangle
        pixel = max(self._engine().get_preview_pixel_size(scene), 1)
        film = {"width": -(-width // pixel), "height": -(-height // pixel), "border": (), "tile_size": _TILE, "adaptive_threshold": 0.0}
        samples = scene.glanz.viewport_samples or ENDLESS
        return settings_of(scene, depsgraph.view_layer, samples=samples, passes=("Combined",), **ALL_SAMPLES, **film)

    def _show(self, rectangle, scene):
        picture = self._session.picture
        if picture is None:
            return
        if picture is not self._drawn:
            height, width, _ = picture.pixels.shape
            buffer = gpu.types.Buffer("FLOAT", picture.pixels.size, np.ascontiguousarray(picture.pixels).reshape(-1))
            self._texture, self._drawn = gpu.types.GPUTexture((width, height), format="RGBA32F", data=buffer), picture
        x, y, width, height = rectangle
        gpu.state.blend_set("ALPHA_PREMULT")
        self._engine().bind_display_space_shader(scene)
        draw_texture_2d(self._texture, (x, y), width, height)
        self._engine().unbind_display_space_shader()
        gpu.state.blend_set("NONE")

    def _tell(self, status, ignored):
        lines = (*ignored, *self._notes, *self._session.warnings)
        more = f" and {len(lines) - 1} more" if len(lines) > 1 else ""
        text = status, f"{lines[0]}{more}" if lines else ""
        if text != self._text:
            self._engine().update_stats(*text)
            self._text = text

    def _tick(self):
        session, engine = self._session, self._engine()
        if session.is_closed or engine is None:
            return None
        self._is_ticking = session.is_busy
        if session.picture is not self._drawn or not self._is_ticking:
            engine.tag_redraw()
        return _TICK_SECONDS if self._is_ticking else None


def close_all():
    """End what all 3D views are at."""
    for viewport in tuple(_viewports):
        viewport.close()


def _ignored(space, region_data, scene):
    """What a 3D view, or its scene (original), asks for and does not get there, in lines."""
    shading = space.shading
    return (
        *(("the clipping region is ignored",) if region_data.use_clip_planes else ()),
        *(("motion blur is rendered by F12 alone",) if scene.render.use_motion_blur else ()),
        *(() if shading.use_scene_lights_render else ("Scene Lights is off, but they are rendered",)),
        *(() if shading.use_scene_world_render else ("Scene World is off, but it is rendered",)),
    )


def _flagged(depsgraph):
    """The data-blocks of which Blender says in which way they have changed."""
    return [u.id for u in depsgraph.updates if u.is_updated_geometry or u.is_updated_transform or u.is_updated_shading]


def _concerns_cameras_alone(depsgraph):
    """Whether nothing has changed but cameras, which are looked at for each redraw."""
    flagged = _flagged(depsgraph)
    return bool(flagged) and all(_is_camera(datablock) for datablock in flagged) and not any(map(depsgraph.id_type_updated, _LOOKS))


def _is_camera(datablock):
    return isinstance(datablock, bpy.types.Camera) or (isinstance(datablock, bpy.types.Object) and datablock.type == "CAMERA")


def _may_look_different(depsgraph):
    """Whether anything may have changed but who is there: not where Blender tells of things selected or hidden."""
    return bool(_flagged(depsgraph)) or not depsgraph.updates or any(map(depsgraph.id_type_updated, _LOOKS))


def _cast(space, depsgraph):
    """Who is there and to be seen in a 3D view, the world, and which collections the camera sees otherwise."""
    seen = (i.object.name_full for i in depsgraph.object_instances if i.show_self and i.object.visible_in_viewport_get(space))
    world = depsgraph.scene_eval.world
    return world and world.name_full, *_masks(depsgraph.view_layer_eval.layer_collection), *seen


def _masks(collection):
    """Whether a layer collection, and each inside of it, is held out and only indirectly seen."""
    yield collection.holdout, collection.indirect_only
    for child in collection.children:
        yield from _masks(child)
