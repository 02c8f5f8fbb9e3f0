"""The whole scene of a render depsgraph as the engine's value."""

from contextlib import nullcontext
from dataclasses import replace

from ...engine import Scene
from ..passes import aovs, attributes
from .camera import export_camera
from .findings import IGNORED, Findings
from .kept import Kept
from .missing import note_missing
from .motion import STILL, Beside, CameraTrack, Shutter, Tracks
from .objects import export_objects
from .world import export_world


def export_scene(depsgraph, settings, view=None, check=lambda: None, frame_set=None, findings=None):
    """(scene, warnings): the engine's `Scene` of one view of an evaluated `depsgraph`; see `export_views`."""
    scenes, warnings = export_views(depsgraph, settings, (view,), check, frame_set, findings)
    return scenes[0], warnings


def export_views(depsgraph, settings, views, check=lambda: None, frame_set=None, findings=None, kept=None):
    """(scenes, warnings): the engine's `Scene` for each view of an evaluated `depsgraph`, and what is not as in Blender, in lines.

    settings   the engine's `Settings`, for the size of the frame
    views      functions that say (evaluated camera object, matrix, horizontal shift), see `export_camera`, as Blender has them at
               the time of the call; None: the scene's own camera. The scenes differ in nothing but their cameras
    check      called now and then; may raise to stop the export
    frame_set  goes to (frame, fraction of a frame), for motion blur and vectors; the frame is restored. None: nothing moves
    findings   `Findings` that keep the warnings as notes, too
    kept       what was exported before, a `Kept`, if any
    Raises SceneError naming the object for which no picture is possible.
    """
    findings = findings or Findings()
    shutter = Shutter.of(depsgraph, frame_set, findings)
    if shutter is None and "Vector" in settings.passes:
        shutter = Shutter.beside(depsgraph, frame_set)
    blurs = shutter is None or shutter.blurs
    with shutter or nullcontext():
        scene = depsgraph.scene_eval
        # The cameras first: where there is none, no one should wait for the meshes.
        cameras = [_camera_track(depsgraph, settings, view, blurs) for view in views]
        _note_ignored(scene, findings)
        tracks = (Tracks if blurs else Beside)(shutter, depsgraph, cameras, findings, check) if shutter else STILL
        asked = {"asked": attributes(settings.passes), "aovs": aovs(settings.passes)}
        contents = _contents(depsgraph, findings, kept or Kept(), check, tracks, **asked)
    scenes = tuple(
        Scene(name=scene.name, camera=camera.moved(shutter, findings), camera_beside=camera.beside(), **contents) for camera in cameras
    )
    return scenes, findings.lines()


def export_contents(depsgraph, kept, is_shown=lambda ob: True, findings=None):
    """(scene, warnings) as of a 3D view: the engine's `Scene` without a camera, at one time.

    kept      what was exported before, a `Kept`
    is_shown  whether an object (evaluated) is to be seen
    findings  `Findings` that keep the warnings as notes, too
    """
    findings = findings or Findings()
    _note_ignored(depsgraph.scene_eval, findings)
    contents = _contents(depsgraph, findings, kept, is_shown=is_shown)
    return Scene(name=depsgraph.scene_eval.name, camera=None, **contents), findings.lines()


def export_still(depsgraph, settings, findings):
    """The engine's `Scene` as far as the depsgraph of a 3D view tells: what will be rendered, at one time.

    settings  the engine's `Settings`, for the size of the frame
    findings  `Findings` that are told
    Raises SceneError naming the object for which no picture is possible.
    """
    scene = depsgraph.scene_eval
    camera = export_camera(scene.camera, scene.render, settings.width, settings.height)
    hidden = _hidden_in_renders(depsgraph.view_layer_eval.layer_collection)
    contents, _ = export_contents(depsgraph, Kept(), lambda ob: not (ob.hide_render or ob.original in hidden), findings)
    return replace(contents, camera=camera)


def _hidden_in_renders(layer_collection):
    """The objects (original) of a layer collection that are in none that is rendered."""
    hidden, shown, todo = set(), set(), [(layer_collection, True)]
    while todo:
        here, is_on = todo.pop()
        is_on = is_on and not here.collection.hide_render
        # What is excluded is there as instances alone.
        if not here.exclude:
            (shown if is_on else hidden).update(ob.original for ob in here.collection.objects)
        todo += [(child, is_on) for child in here.children]
    return hidden - shown


def _contents(depsgraph, findings, kept, check=lambda: None, tracks=STILL, is_shown=lambda ob: True, **asked):
    """What `Scene`s have but for their cameras, {name: value}."""
    layer, bitmaps = depsgraph.view_layer_eval, kept.begin(depsgraph.scene_eval.frame_current)
    override = _evaluated(layer.material_override, depsgraph)
    datablock = _evaluated(getattr(layer, "world_override", None) or depsgraph.scene_eval.world, depsgraph)
    shown = asked.get("aovs", ())
    world = kept.looks.of(datablock, frozenset(shown), findings, lambda findings: export_world(datablock, findings, bitmaps, shown))
    # Last, for to see what moves Blender has to leave the frame.
    objects, lights = export_objects(depsgraph, findings, bitmaps, override, check, tracks, kept, is_shown, **asked)
    return {"objects": objects, "lights": lights, "world": world}


def _camera_track(depsgraph, settings, view, blurs):
    scene = depsgraph.scene_eval

    def export():
        ob, matrix, shift_x = view() if view else (None, None, None)
        return export_camera(ob or scene.camera, scene.render, settings.width, settings.height, matrix, shift_x)

    return CameraTrack(scene.camera, export, blurs)


def _is_spherical(camera):
    return bool(camera and camera.type == "CAMERA" and camera.data.type == "PANO" and camera.data.stereo.use_spherical_stereo)


def _evaluated(datablock, depsgraph):
    return datablock and datablock.evaluated_get(depsgraph)


_NOT_FOLLOWED = {
    "the film is not transparent behind glass, the world is seen through it": lambda scene: (
        scene.render.film_transparent and _is_on_in_cycles(scene, "film_transparent_glass")
    ),
    "nothing is culled, what is far away or out of the picture is there": lambda scene: (
        scene.render.use_simplify and any(_is_on_in_cycles(scene, f"use_{kind}_cull") for kind in ("camera", "distance"))
    ),
    "freestyle lines are not rendered": lambda scene: scene.render.use_freestyle,
    "spherical stereo is not rendered, each eye stays where it is": lambda scene: (
        scene.render.use_multiview and _is_spherical(scene.camera)
    ),
}
"""What to note -> whether a scene (evaluated) asks for it."""


def _is_on_in_cycles(scene, setting):
    return getattr(getattr(scene, "cycles", None), setting, False)


def _note_ignored(scene, findings):
    """Note the scene's render settings that Glanz does not follow."""
    for what, is_on in _NOT_FOLLOWED.items():
        if is_on(scene):
            findings.note(what, f"scene '{scene.name}'", IGNORED)
    for collection in scene.original.collection.children_recursive:
        note_missing(collection, f"collection '{collection.name}'", findings)
