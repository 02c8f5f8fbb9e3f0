"""The same files for both engines at the extremes: scaled and moved, a closed room with all light outside, and a floor in grazing sun.

Files hold single precision: what is moved far is rounded there, before any engine sees it. So the Cornell box is moved by 2^20 m, its
objects on eighths of a metre, where nothing is.
"""

import math

import bpy
import numpy as np
from mathutils import Matrix

from . import blender

SIDE, SAMPLES, BLOCK = 128, 64, 16
FAR = 2.0**20
PLACES = {
    "tiny": Matrix.Scale(1e-6, 4),
    "huge": Matrix.Scale(1e6, 4),
    "far": Matrix.Translation((FAR, FAR, 0.0)),
}
ENGINES = {"glanz": ("GLANZ", "fast"), "exact": ("GLANZ", "exact"), "cycles": ("CYCLES", "")}
ROOM = {"samples": 64, "bounces": 32, "side": 64}
GRAZING = (1e-2, 1e-3, 1e-4)
"""Of the sun above the floor [rad]."""


def main():
    result = {}
    for name in ENGINES:
        plain = moved_box(name, Matrix())
        for place, matrix in PLACES.items():
            result[f"box_{place}_{name}"], result[f"box_{place}_median_{name}"] = differences(moved_box(name, matrix), plain)
            result[f"room_{place}_{name}"] = leaks(name, matrix)
        result[f"room_{name}"] = leaks(name, Matrix())
        for angle in GRAZING:
            result[f"floor_{angle:g}_{name}"] = shadowed(name, angle)
    blender.finish(result)


def moved_box(name, matrix):
    """The Cornell box (SIDE, SIDE, 3), with all that is in it placed anew."""
    scene = blender.open_cornell_box(SAMPLES, SIDE, SIDE)
    for thing in scene.objects:
        thing.location = [round(x * 8) / 8 for x in thing.location]
    place(scene, matrix)
    return picture(name)


def differences(a, b):
    """(the greatest, the median) difference of the means of blocks, over the mean of all.

    A block is 16,384 paths: one that passes an edge on its other side, where it was closer than float32 tells, moves it by 1e-5 or more.
    """
    blocks = [p.reshape(SIDE // BLOCK, BLOCK, SIDE // BLOCK, BLOCK, 3).mean(axis=(1, 3), dtype=np.float64) for p in (a, b)]
    away = np.abs(blocks[0] - blocks[1]) / b.mean(dtype=np.float64)
    return float(away.max()), float(np.median(away))


def leaks(name, matrix):
    """Of a million segments of paths in a closed white room, how many escape into the light outside."""
    scene = empty(ROOM["samples"], ROOM["side"], ROOM["side"], ROOM["bounces"])
    scene.world = bpy.data.worlds.new("Light")
    set_world(scene.world)
    room = bpy.data.meshes.new("Room")
    corners = [(x, y, z) for x in (-16, 20) for y in (-24, 16) for z in (-12, 16)]
    room.from_pydata(corners, [], [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    room.materials.append(white())
    add("Room", room)
    scene.camera = add("Camera", bpy.data.cameras.new("Camera"), Matrix.Rotation(0.7, 4, (1.0, 0.5, 0.25)))
    scene.camera.data.lens = 18.0
    place(scene, matrix)
    # Each path that escapes brings the radiance of the world, 1, and there are as many segments as bounces, and one more.
    return 1e6 * float(picture(name).mean()) / (ROOM["bounces"] + 1)


def shadowed(name, angle):
    """The share of the light of a sun, so little above a floor, that the floor does not get."""
    scene = empty(SAMPLES, SIDE, SIDE, 0)
    floor = bpy.data.meshes.new("Floor")
    floor.from_pydata([(-7.0, -5.0, 0.0), (6.0, -4.0, 0.0), (8.0, 9.0, 0.0), (-6.0, 7.0, 0.0)], [], [(0, 1, 2), (0, 2, 3)])
    floor.materials.append(white())
    add("Floor", floor, Matrix.Translation((0.3, -0.2, 0.0)))
    sun = bpy.data.lights.new("Sun", "SUN")
    made = add("Sun", sun, Matrix.Rotation(math.radians(37), 4, "Z") @ Matrix.Rotation(math.pi / 2 - angle, 4, "X"))
    # As high as it is after rounding.
    bpy.context.view_layer.update()
    sun.energy, sun.angle = 1 / made.matrix_world[2][2], 0.0
    scene.camera = add("Camera", bpy.data.cameras.new("Camera"), Matrix.Translation((0.0, 0.0, 4.0)))
    return 1 - math.pi * float(picture(name).mean())


def empty(samples, width, height, bounces):
    """A scene without anything, for both engines alike."""
    scene = blender.open_cornell_box(samples, width, height)
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    cycles = scene.cycles
    scene.glanz.max_depth = cycles.max_bounces = cycles.diffuse_bounces = bounces
    return scene


def add(name, data, matrix=None):
    made = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(made)
    made.matrix_world = matrix or Matrix()
    return made


def white():
    material = bpy.data.materials.new("White")
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    shader, output = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    shader.inputs["Color"].default_value = (1.0, 1.0, 1.0, 1.0)
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def set_world(world):
    if world.node_tree is None:
        world.use_nodes = True
    background = next(node for node in world.node_tree.nodes if node.type == "BACKGROUND")
    background.inputs["Color"].default_value, background.inputs["Strength"].default_value = (1.0, 1.0, 1.0, 1.0), 1.0


def place(scene, matrix):
    """Move all that stands on its own, the camera with its clip range too."""
    bpy.context.view_layer.update()
    for thing in scene.objects:
        if thing.parent is None:
            thing.matrix_world = matrix @ thing.matrix_world
    scale = matrix.median_scale
    # A camera that is scaled sees the same; its range is in metres.
    scene.camera.matrix_world = Matrix.LocRotScale(*scene.camera.matrix_world.decompose()[:2], None)
    scene.camera.data.clip_start, scene.camera.data.clip_end = max(1e-6, 0.01 * scale), 1e3 * scale


def picture(name):
    """(height, width, 3) linear radiance."""
    engine, precision = ENGINES[name]
    if engine == "GLANZ":
        bpy.context.scene.glanz.precision = precision
    return blender.picture(engine)[..., :3]


if __name__ == "__main__":
    main()
