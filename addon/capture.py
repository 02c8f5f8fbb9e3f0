"""A .blend file's scene as engine values, outside a picture render: what the command line works with.

The evaluated scene as it will be rendered exists only inside `RenderEngine.render`, so a second render engine, which
exports and does nothing else, is let run for it.
"""

from contextlib import contextmanager
from importlib import import_module

import bpy

from ..engine import GlanzError, SceneError
from . import SETTINGS
from .export import Findings, export_scene
from .export.findings import IGNORED, KINDS
from .files import open_blend, save_png
from .reports import describe
from .settings import settings_of

__all__ = ["KINDS", "Findings", "capture", "open_blend", "save_png"]


class GlanzCaptureEngine(bpy.types.RenderEngine):
    """Keeps the exported scene and draws nothing; not for users"""

    bl_idname = "GLANZ_CAPTURE"
    bl_label = "Glanz Capture"
    bl_use_postprocess = False

    # What the next run shall do, and what came of it; Blender makes the instances, so the class carries both.
    overrides = None
    findings = None
    strict = None
    outcome = None

    def __init__(self, *args, **kwargs):
        super().__init__(*args, **kwargs)

    def render(self, depsgraph):
        try:
            GlanzCaptureEngine.outcome = self._export(depsgraph)
        except BaseException as error:
            # Blender would print it and go on.
            GlanzCaptureEngine.outcome = error

    def _export(self, depsgraph):
        settings = settings_of(depsgraph.scene_eval, depsgraph.view_layer_eval, **self.overrides)
        views = [view.name for view in depsgraph.scene.render.views if view.use] if depsgraph.scene.render.use_multiview else []
        self.active_view_set(views[0] if views else "")
        scene, _ = export_scene(depsgraph, settings, self._camera, frame_set=self.frame_set, findings=self.findings)
        if len(views) > 1:
            self.findings.note(f"only view '{views[0]}' is rendered, not: {', '.join(views[1:])}", "", IGNORED)
        self.findings.is_strict = depsgraph.scene_eval.glanz.strict if self.strict is None else self.strict
        self.findings.refuse_lost(depsgraph.scene_eval.name)
        return scene, settings, self.findings.lines()

    def _camera(self):
        camera = self.camera_override
        return camera, camera and self.camera_model_matrix(camera), camera and self.camera_shift_x(camera)


def capture(frame=None, scene_name=None, view_layer=None, overrides=None, strict=None, findings=None):
    """(scene, settings, warnings) of the open file: engine `Scene` and `Settings`, and a tuple of lines.

    frame       to go to first; None: where the file is. The file stays there, since simulations cannot go back
    scene_name  None: the active scene
    view_layer  its name; None: the first one that is used for rendering
    overrides   {field of `Settings`: value}; the file's settings hold for all others
    strict      whether it is an error that something is left out or missing; None: as the scene says
    findings    `Findings` that keep the warnings as notes, too
    Raises GlanzError naming the cause where there is nothing to render. Nothing on disk changes, and in memory
    nothing but the frame.
    """
    scene = _scene(scene_name)
    findings = findings or Findings()
    layer = _view_layer(scene, view_layer, findings)
    if bpy.app.autoexec_fail:
        findings.note(f"scripts of the file are not run, what they drive stays as it is ({bpy.app.autoexec_fail_message})", "")
    if frame is not None:
        scene.frame_set(frame)
    with _registered(), _render_settings(scene.render), _used(layer):
        GlanzCaptureEngine.overrides, GlanzCaptureEngine.findings = dict(overrides or {}), findings
        GlanzCaptureEngine.strict = strict
        GlanzCaptureEngine.outcome = None
        try:
            bpy.ops.render.render(scene=scene.name, layer=layer.name)
        except RuntimeError as error:
            if GlanzCaptureEngine.outcome is None:
                raise SceneError(_refusal(scene, error)) from None
        outcome, GlanzCaptureEngine.outcome = GlanzCaptureEngine.outcome, None
    if outcome is None:
        raise SceneError(f"Blender rendered nothing for view layer '{layer.name}' of scene '{scene.name}'")
    if isinstance(outcome, BaseException):
        if isinstance(outcome, (GlanzError, KeyboardInterrupt)):
            raise outcome
        raise SceneError(f"scene '{scene.name}' cannot be exported: {describe(outcome)}") from outcome
    return outcome


def _scene(name):
    if name is None:
        return bpy.context.scene
    if name not in bpy.data.scenes:
        raise SceneError(f"unknown scene '{name}'; the file has: {', '.join(scene.name for scene in bpy.data.scenes)}")
    return bpy.data.scenes[name]


def _view_layer(scene, name, findings):
    """The view layer called `name`, or the first that is used; then the others are noted."""
    if name is not None:
        if name not in scene.view_layers:
            raise SceneError(f"scene '{scene.name}' has no view layer '{name}'; it has: {', '.join(v.name for v in scene.view_layers)}")
        return scene.view_layers[name]
    used = [layer for layer in scene.view_layers if layer.use] or list(scene.view_layers)
    if others := ", ".join(layer.name for layer in used[1:]):
        findings.note(f"only view layer '{used[0].name}' is rendered, not: {others}", "", IGNORED)
    return used[0]


def _refusal(scene, error):
    """Why Blender did not even start to render, one line."""
    if scene.camera is None:
        return f"scene '{scene.name}' has no camera: add one, and make it the active camera"
    cause = " ".join(str(error).split()).removeprefix("Error: ")
    return f"scene '{scene.name}' cannot be rendered: {cause}"


@contextmanager
def _registered():
    """The settings and the capture engine known to Blender, and forgotten again if they were not before."""
    own = [] if hasattr(bpy.types.Scene, "glanz") else [import_module(f"{__package__}.{name}") for name in SETTINGS]
    for module in own:
        module.register()
    bpy.utils.register_class(GlanzCaptureEngine)
    try:
        yield
    finally:
        bpy.utils.unregister_class(GlanzCaptureEngine)
        for module in own:
            module.unregister()


@contextmanager
def _used(layer):
    """A view layer switched on, or Blender would render another one in its place; restored afterwards."""
    before, layer.use = layer.use, True
    try:
        yield
    finally:
        layer.use = before


@contextmanager
def _render_settings(render):
    """`render` set to run the capture engine alone: no sequencer, no compositor; restored afterwards."""
    wanted = {"engine": GlanzCaptureEngine.bl_idname, "use_sequencer": False, "use_compositing": False}
    before = {name: getattr(render, name) for name in wanted}
    try:
        for name, value in wanted.items():
            setattr(render, name, value)
        yield
    finally:
        for name, value in before.items():
            setattr(render, name, value)
