"""A glass of water with ice and a bubble: bodies that overlap, of which at every place the one of highest priority is there."""

import math
import random
from itertools import pairwise

import bpy
import common
from mathutils import Matrix, Vector

SEGMENTS = 64
RADIUS, WALL, BOTTOM, HEIGHT, LEVEL = 0.42, 0.035, 0.09, 1.15, 0.82
"""Of the glass and of the water in it [m]; far larger than a real one, which changes nothing but the absorption."""
INDEX = {"Glass": 1.52, "Water": 1.333, "Ice": 1.31, "Air": 1.0}
PRIORITY = {"Glass": 3, "Ice": 2, "Air": 2, "Water": 1}


def clear(name, colour=None, distance=1.0):
    """A clear body; light of `colour` is left after `distance` metres of it (None: all of it)."""
    made = common.glass(name, (1.0, 1.0, 1.0), INDEX[name])
    made.glanz.priority = PRIORITY[name]
    if colour is not None:
        # Blender: absorption = density (1 - colour).
        sigma = [-math.log(c) / distance for c in colour]
        density = max(sigma)
        volume = made.node_tree.nodes.new("ShaderNodeVolumeAbsorption")
        volume.location = (0, -200)
        volume.inputs["Color"].default_value = (*(1 - s / density for s in sigma), 1.0)
        volume.inputs["Density"].default_value = density
        (output,) = (node for node in made.node_tree.nodes if node.type == "OUTPUT_MATERIAL")
        made.node_tree.links.new(volume.outputs[0], output.inputs["Volume"])
    return made


def turned(name, profile, material, smooth=True):
    """The closed body of a profile (r, z) turned about z, from the axis to the axis, outside first; corners stay sharp."""
    vertices, faces = [], []
    for (r0, z0), (r1, z1) in pairwise(profile):
        first = len(vertices)
        for r, z in ((r0, z0), (r1, z1)):
            vertices += [(r * math.cos(a), r * math.sin(a), z) for a in (2 * math.pi * i / SEGMENTS for i in range(SEGMENTS))]
        for i in range(SEGMENTS):
            j = (i + 1) % SEGMENTS
            corners = [first + i, first + j, first + SEGMENTS + j, first + SEGMENTS + i]
            if r0 == 0:
                corners = [first + i, first + SEGMENTS + j, first + SEGMENTS + i]
            elif r1 == 0:
                corners = [first + i, first + j, first + SEGMENTS + i]
            faces.append(corners)
    return common.mesh(name, vertices, faces, [material], smooth=smooth)


def cup(material):
    """The glass: outside from the middle of the bottom up, over the rim, and down the inside."""
    inner = RADIUS - WALL
    return turned("Cup", [(0, 0), (RADIUS, 0), (RADIUS, HEIGHT), (inner, HEIGHT), (inner, BOTTOM), (0, BOTTOM)], material)


def water(material):
    """The water reaches half way into wall and bottom, where the glass is in its place."""
    r = RADIUS - 0.5 * WALL
    return turned("Water", [(0, 0.5 * BOTTOM), (r, 0.5 * BOTTOM), (r, LEVEL), (0, LEVEL)], material)


def ice(number, material, rng):
    """A cube with edges of a fifth of a metre, slightly crooked."""
    half = 0.12
    corners = [Vector((sx, sy, sz)) * half for sz in (-1, 1) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    corners = [c * rng.uniform(0.93, 1.07) for c in corners]
    faces = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    triangles = [t for a, b, c, d in faces for t in ((a, b, c), (a, c, d))]
    return common.mesh(f"Ice {number}", corners, triangles, [material])


def build():
    """The scene."""
    scene = common.new_scene("Glass of water", 400, 480, samples=256, max_depth=24)
    scene.glanz.sampler = "sobol"
    rng = random.Random(3)
    common.add(scene, "Cup", cup(clear("Glass", (0.75, 0.95, 0.85), 0.6)))
    common.add(scene, "Water", water(clear("Water", (0.45, 0.8, 0.92), 1.2)))
    frozen = clear("Ice")
    for number, place in enumerate(((-0.13, 0.02, 0.78), (0.16, 0.12, 0.76), (0.1, -0.17, 0.79))):
        turn = Matrix.Rotation(rng.uniform(0, 3), 4, "Z") @ Matrix.Rotation(rng.uniform(-0.4, 0.4), 4, "X")
        common.add(scene, f"Ice {number}", ice(number, frozen, rng), Matrix.Translation(place) @ turn)
    bubble = common.sphere("Bubble", 0.07, clear("Air"), segments=32, rings=16)
    common.add(scene, "Bubble", bubble, Matrix.Translation((-0.08, -0.12, 0.38)))
    small = common.sphere("Small bubble", 0.035, bpy.data.materials["Air"], segments=32, rings=16)
    common.add(scene, "Small bubble", small, Matrix.Translation((0.13, -0.1, 0.55)))
    straw = common.box("Straw", (0.05, 0.05, 1.5), common.diffuse("Straw", (0.75, 0.12, 0.08)))
    leaning = Matrix.Translation((-0.2, 0.1, 0.13)) @ Matrix.Rotation(0.32, 4, "Y") @ Matrix.Rotation(-0.06, 4, "X")
    common.add(scene, "Straw", straw, leaning)
    common.add(scene, "Table", common.quad("Table", (-5, -5, 0), (10, 0, 0), (0, 10, 0), common.diffuse("Linen", (0.55, 0.5, 0.44))))
    common.add(scene, "Wall", common.quad("Wall", (-5, 3, -1), (10, 0, 0), (0, 0, 8), common.diffuse("Wall", (0.3, 0.36, 0.42))))
    common.light(scene, "Window", "AREA", (-2.6, -0.6, 3.2), (0, 0, 0.4), 170.0, shape="SQUARE", size=1.8)
    scene.world = common.world((0.75, 0.85, 1.0), 0.35)
    common.camera(scene, (0.25, -3.6, 1.55), (0.0, 0.0, 0.62), lens=75.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
