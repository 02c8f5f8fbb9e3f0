"""The render engine that Blender sees: export, render, write tiles, listen for Esc."""

import sys
import time
from contextlib import closing, suppress
from dataclasses import replace
from functools import partial

import bpy

from . import backend, command_line, passes
from .checks import Check, keep
from .reports import Warnings, errors_logged, errors_shown, errors_told
from .status import Status

_rendering = []
"""The engines that render a picture just now; Blender itself ends previews and 3D views."""


class Cancelled(Exception):
    """The user pressed Esc during the export."""


class GlanzRenderEngine(bpy.types.RenderEngine):
    """Glanz: a ray tracer that is read as easily as it renders"""

    bl_idname = "GLANZ"
    bl_label = "Glanz"
    bl_use_preview = True
    # Material Preview is drawn by EEVEE, and the shader editor offers the usual nodes.
    bl_use_eevee_viewport = True
    bl_use_shading_nodes_custom = False

    # What serves the 3D view, in engines that are for one.
    viewport = None
    # What is kept from frame to frame, see `persistent`.
    persistent = None
    # Whether a view layer of the frame was rendered, or failed to be.
    has_rendered = False

    def __init__(self, *args, **kwargs):
        # Blender runs this twice for each engine, so there is nothing here.
        super().__init__(*args, **kwargs)

    def update_render_passes(self, scene=None, renderlayer=None):
        """Called by Blender, also without a render: which passes there will be."""
        with errors_shown(self):
            passes.register_passes(self, scene, renderlayer)

    def update(self, data=None, depsgraph=None):
        """Called by Blender before each `render`, with the scene as it will be: what has changed is told now, and only now."""
        if self.persistent:
            with errors_shown(self):
                self.persistent.kept.forget(depsgraph)

    def render_frame_finish(self):
        """Called by Blender when all view layers of a frame are rendered, which may be none."""
        if self.persistent:
            self.persistent.kept.tidy()
        if not (self.has_rendered or self.is_preview or self.is_cancelled()):
            # Blender would save a picture that it does not have, which is a crash.
            message = "no view layer is rendered: switch on Use for Rendering in the View Layer properties"
            self.report({"ERROR"}, message)
            command_line.end_after_failure(message)
        self.has_rendered = False

    def render(self, depsgraph):
        """Called by Blender for each view layer of each frame."""
        self.has_rendered = True
        # Blender knows when it was cancelled; what is finished stays.
        with (errors_logged if self.is_preview else errors_shown)(self), suppress(Cancelled):
            backend.load_or_raise()
            if self.is_preview:
                self._preview(depsgraph)
                return
            _rendering.append(self)
            try:
                self._render(depsgraph)
            finally:
                _rendering.remove(self)

    def _preview(self, depsgraph):
        from .preview import render_preview

        render_preview(self, depsgraph, self._check)

    def _render(self, depsgraph):
        from ..engine import Requirements, metadata, render
        from .checkpoints import checkpoint_of
        from .export import Findings, Kept, export_views
        from .results import Outlines, make_room, outcome, stamp, write_tile
        from .settings import doubling, settings_of
        from .written import refuse_unwritable

        asked = {**command_line.overrides(), "width": self.resolution_x, "height": self.resolution_y}
        settings = settings_of(depsgraph.scene_eval, depsgraph.view_layer_eval, **asked)
        layer = depsgraph.view_layer.name
        views = make_room(self, settings, layer, depsgraph.scene_eval)
        begun = time.monotonic()
        self.update_stats("", "Exporting the scene")
        warnings = Warnings(self)
        refuse_unwritable(self, depsgraph.scene_eval, warnings.show)
        findings, cameras = Findings(), [partial(self._camera, view) for view in views]
        persistent = self._persistent(depsgraph.scene_eval)
        frame_set = persistent.watched(depsgraph, self.frame_set) if persistent else self.frame_set
        kept = persistent.kept if persistent else Kept()
        scenes, notes = export_views(depsgraph, settings, cameras, self._check, frame_set, findings, kept)
        requirements = Requirements.of(scenes[0], settings)
        self._keep(depsgraph, requirements, findings)
        findings.is_strict = depsgraph.scene_eval.glanz.strict
        findings.refuse_lost(depsgraph.scene_eval.name)
        warnings.show(notes)
        stamp(self, metadata(scenes[0], settings, layer, requirements))
        self.update_stats("", "Preparing the scene")
        ends = doubling(settings) if depsgraph.scene_eval.glanz.progress == "FRAME" else ()
        rendering = persistent.render if persistent else lambda key, *asked: render(*asked)
        status, outlines = Status(self, settings.samples), Outlines(self, settings.region)
        for number, (view, scene) in enumerate(zip(views, scenes, strict=True)):
            where = ", ".join((*((layer,) if len(depsgraph.scene_eval.view_layers) > 1 else ()), *((view,) if view else ())))
            # The eyes differ in their camera, and in their noise, or it would seem to float in depth.
            settings = replace(settings, seed=settings.seed + bool(number))
            checkpoint = checkpoint_of(depsgraph.scene_eval, layer, view, scene, settings, lambda line: warnings.show((line,)))
            # Closing the generator joins its threads, so none is left when Blender goes on, whatever happens here.
            with closing(rendering((layer, view), scene, settings, ends, checkpoint)) as progress:
                for step in progress:
                    reached = step.reached
                    if step.warnings:
                        warnings.show(findings.take(step.warnings))
                        self._keep(depsgraph, requirements, findings)
                        findings.refuse_lost(depsgraph.scene_eval.name)
                    for tile in step.tiles:
                        write_tile(self, tile, settings.region, layer, view)
                    outlines.show(step.in_work)
                    done = (number + step.done) / len(views)
                    status.show(done, len(warnings), where, reached)
                    if self.is_cancelled():
                        break
            if self.is_cancelled():
                break
            checkpoint.remove()
        outlines.show(())
        stamp(self, outcome(layer, reached, done, time.monotonic() - begun, len(warnings)))
        self._keep(depsgraph, requirements, findings)
        warnings.close()

    def _persistent(self, scene):
        """What stays from frame to frame, where the scene asks for persistent data: Blender then keeps this engine. Else None."""
        if not scene.render.use_persistent_data:
            self.persistent = None
            return None
        from .persistent import Persistent

        self.persistent = self.persistent or Persistent()
        return self.persistent

    @staticmethod
    def _keep(depsgraph, requirements, findings):
        """Let panels know what was found out."""
        origin = f"Rendered at frame {depsgraph.scene_eval.frame_current}"
        keep(depsgraph.scene, depsgraph.view_layer.name, Check(requirements.in_words(), findings.notes, origin))

    def _camera(self, view):
        """(camera object, matrix, horizontal shift) of `view`, a name of Blender's; "" where there is but one."""
        self.active_view_set(view)
        camera = self.camera_override
        return camera, camera and self.camera_model_matrix(camera), camera and self.camera_shift_x(camera)

    def view_update(self, context, depsgraph):
        """Called by Blender for a 3D view whose data has changed."""
        with errors_told(self):
            self._opened().update(context, depsgraph)

    def view_draw(self, context, depsgraph):
        """Called by Blender for each redraw of a 3D view."""
        with errors_told(self):
            self._opened().draw(context, depsgraph)

    def _opened(self):
        backend.load_or_raise()
        from .viewport_draw import Viewport

        if self.viewport is None or self.viewport.is_closed:
            self.viewport = Viewport(self)
        return self.viewport

    def is_cancelled(self):
        """Whether the user pressed Esc."""
        return self.test_break()

    def _check(self):
        if self.is_cancelled():
            raise Cancelled


def refuse_while_rendering():
    """Raises RuntimeError while a picture is rendered: Blender crashes when its engine is taken away."""
    if _rendering:
        raise RuntimeError("Glanz renders a picture just now: end that, then switch Glanz off")


def register():
    bpy.utils.register_class(GlanzRenderEngine)


def unregister():
    drawing = sys.modules.get(f"{__package__}.viewport_draw")
    if drawing:
        drawing.close_all()
    bpy.utils.unregister_class(GlanzRenderEngine)
