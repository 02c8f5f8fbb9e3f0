"""A zone plate, (1 + cos(64 r^2)) / 2 on [-1, 1]^2: rings that get finer outwards until no pixel can hold them.

What is seen beyond the first rings depends on the sampler, the pixel filter and the samples; extra centres of rings are
aliases. The rings are one row of an image, a period of the cosine, repeated along u = 64 r^2 / (2 pi). The image is
not filtered, as what is to be seen is the sampling of the picture.
"""

import math

import bpy
import common
from mathutils import Matrix

PHASE = 64.0
"""What r^2 [m^2] is multiplied with under the cosine."""
CELL, CELLS = 1 / 48, 54
"""The side of a cell [m], between whose corners u is straight instead of a parabola, and how many a quarter has along each side.

They reach beyond the frame, as wide pixel filters do.
"""
TEXELS = 256


def period():
    """An image of one row, one period of (1 + cos) / 2; its texels are the values at their centres."""
    image = bpy.data.images.new("Period", TEXELS, 1, float_buffer=True)
    image.colorspace_settings.name = "Non-Color"
    values = [0.5 + 0.5 * math.cos(2 * math.pi * (i + 0.5) / TEXELS) for i in range(TEXELS)]
    image.pixels = [channel for value in values for channel in (value, value, value, 1.0)]
    image.pack()
    return image


def quarter(material):
    """A square from the middle on, with u at the corners of its cells so that the error between them is as large above as below."""
    lines = range(CELLS + 1)
    vertices = [(CELL * x, CELL * y, 0.0) for y in lines for x in lines]
    row = len(lines)
    faces = [(i, i + 1, i + row + 1, i + row) for y in range(CELLS) for i in range(y * row, y * row + CELLS)]
    made = common.mesh("Quarter", vertices, faces, [material])
    # Between two corners that are a diagonal apart the parabola is at most CELL^2 / 2 below the straight line.
    layer = made.uv_layers.new(name="UVMap")
    for loop in made.loops:
        x, y, _ = vertices[loop.vertex_index]
        layer.uv[loop.index].vector = (PHASE * (x * x + y * y - 0.25 * CELL**2) / (2 * math.pi), 0.5)
    return made


def build():
    """The scene."""
    scene = common.new_scene("Zone plate", 128, 128, samples=1, max_depth=0)
    scene.glanz.sampler, scene.glanz.pixel_filter, scene.glanz.filter_textures = "grid", "box", False
    material = common.emission("Rings", (1.0, 1.0, 1.0), 1.0)
    tree = material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.image = period()
    texture.location = (-300, 0)
    shader = next(node for node in tree.nodes if node.type == "EMISSION")
    tree.links.new(texture.outputs["Color"], shader.inputs["Color"])
    mesh = quarter(material)
    for x, y in ((1, 1), (-1, 1), (1, -1), (-1, -1)):
        common.add(scene, f"Quarter {x:+} {y:+}", mesh, Matrix.Diagonal((x, y, 1, 1)))
    camera = common.camera(scene, (0.0, 0.0, 2.0), (0.0, 0.0, 0.0), lens=50.0)
    camera.data.type = "ORTHO"
    camera.data.ortho_scale = 2.0
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
