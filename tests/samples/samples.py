"""The sample scenes, and what is in an open file."""

from pathlib import Path

import bpy
import numpy as np

import glanz

FOLDER = Path(glanz.__file__).resolve().parent / "sample_scenes"
NAMES = (
    "checkerboard",
    "cornell_box",
    "depth_of_field",
    "environment",
    "glass_balls",
    "glass_of_water",
    "instances",
    "lights",
    "many_lights",
    "materials",
    "metal_balls",
    "mirror_and_glass",
    "moving_balls",
    "phong_exponents",
    "phong_lobes",
    "prism",
    "ring_caustic",
    "soft_shadow",
    "stained_glass",
    "textures",
    "translucency",
    "zone_plate",
)


def open_sample(name, samples=None, side=None):
    """Open a sample scene; with few samples, and the longer side of the frame `side` pixels long, unless None."""
    bpy.ops.wm.open_mainfile(filepath=str(FOLDER / f"{name}.blend"))
    scene = bpy.context.scene
    if samples is not None:
        scene.glanz.samples = samples
    if side is not None:
        width, height = scene.render.resolution_x, scene.render.resolution_y
        scene.render.resolution_x = side * width // max(width, height)
        scene.render.resolution_y = side * height // max(width, height)
    return scene


def contents():
    """What the open file holds, as plain values that can be compared; numbers rounded to what survives another version."""
    scene = bpy.context.scene
    render, glanz_settings = scene.render, scene.glanz
    frame = (render.resolution_x, render.resolution_y, scene.camera.name, scene.view_settings.view_transform)
    return {
        "scene": (scene.name, render.engine, *frame),
        "settings": {name: getattr(glanz_settings, name) for name in ("integrator", "samples", "max_depth", "sampler", "pixel_filter")},
        "objects": {ob.name: (ob.type, _numbers(ob.matrix_world), _slots(ob), [m.type for m in ob.modifiers]) for ob in bpy.data.objects},
        "meshes": {mesh.name: _mesh(mesh) for mesh in bpy.data.meshes},
        "materials": {material.name: _nodes(material.node_tree) for material in bpy.data.materials if material.node_tree},
        "lights": {light.name: (light.type, round(light.energy, 4), _numbers(light.color)) for light in bpy.data.lights},
        "collections": {collection.name: sorted(collection.objects.keys()) for collection in bpy.data.collections},
    }


def _mesh(mesh):
    corners = np.zeros(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", corners)
    return len(mesh.vertices), len(mesh.polygons), _numbers(corners.reshape(-1, 3).sum(axis=0)) if corners.size else ()


def _slots(ob):
    return [(slot.link, slot.material and slot.material.name) for slot in ob.material_slots]


def _nodes(tree):
    return sorted(
        (node.type, [_numbers(np.atleast_1d(s.default_value)) for s in node.inputs if s.name in ("Color", "Roughness", "Strength")])
        for node in tree.nodes
    )


def _numbers(values):
    return [round(float(v), 3) for v in np.ravel(np.array(values))]
