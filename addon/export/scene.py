"""The whole scene of a render depsgraph as the engine's value."""

from ...engine import Scene
from .camera import export_camera
from .findings import Findings
from .objects import export_objects
from .world import export_world


def export_scene(depsgraph, settings, camera=None, matrix=None, shift_x=None, check=lambda: None):
    """(scene, warnings): the engine's `Scene` for an evaluated `depsgraph`, and a line for each thing that is not as in Blender.

    settings         the engine's `Settings`, for the size of the frame
    camera           evaluated camera object; None: the scene's
    matrix, shift_x  replace the camera's own, see `export_camera`
    check            called now and then; may raise to stop the export
    Raises SceneError naming the object for which no picture is possible.
    """
    findings = Findings()
    scene = depsgraph.scene_eval
    view_layer = depsgraph.view_layer_eval
    # The camera first: where there is none, no one should wait for the meshes.
    camera = export_view(depsgraph, settings, camera, matrix, shift_x)
    _note_ignored(scene, findings)
    override = _evaluated(view_layer.material_override, depsgraph)
    objects, lights = export_objects(depsgraph, findings, override, check)
    world = _evaluated(getattr(view_layer, "world_override", None) or scene.world, depsgraph)
    result = Scene(
        name=scene.name,
        camera=camera,
        objects=objects,
        lights=lights,
        world=export_world(world, findings),
    )
    return result, findings.lines()


def _is_spherical(camera):
    return bool(camera and camera.type == "CAMERA" and camera.data.type == "PANO" and camera.data.stereo.use_spherical_stereo)


def export_view(depsgraph, settings, camera=None, matrix=None, shift_x=None):
    """The camera of another view of the same scene; as in `export_scene`."""
    scene = depsgraph.scene_eval
    return export_camera(camera or scene.camera, scene.render, settings.width, settings.height, matrix, shift_x)


def _evaluated(datablock, depsgraph):
    return datablock and datablock.evaluated_get(depsgraph)


def _note_ignored(scene, findings):
    """Note the scene's render settings that Glanz does not follow."""
    render, name = scene.render, f"scene '{scene.name}'"
    for is_on, what in (
        (render.use_motion_blur, "motion blur is not rendered"),
        (render.film_transparent, "the film is not transparent, the world is always seen"),
        (render.use_freestyle, "freestyle lines are not rendered"),
        (render.use_multiview and _is_spherical(scene.camera), "spherical stereo is not rendered, each eye stays where it is"),
    ):
        if is_on:
            findings.note(what, name)
