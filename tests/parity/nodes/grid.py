"""Many cases in one picture: a square of pixels for each, all rendered at once by both engines."""

import math

import bpy
import numpy as np

from glanz.tests.addon import blender
from glanz.tests.parity import parity
from glanz.tests.parity.nodes.cases import build

SIDE = 20
"""Pixels of a square, the edge that is not compared included."""
NEAR = 1 / 255


def shares(cases, path, change=None, build=build):
    """The share of pixels of each case in which both engines agree, to 1/255 of what is seen, or of 1 where that is less.

    `change`(picture) may spoil Glanz's picture first, for a test of the test; `build`(tree, case) makes nodes and their inputs.
    """
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    columns = math.ceil(math.sqrt(len(cases)))
    rows = math.ceil(len(cases) / columns)
    wide = 2.0 * max(columns, rows)
    blender.add_camera((columns - 1.0, 1.0 - rows, 50), SIDE * columns, SIDE * rows, type="ORTHO", ortho_scale=wide)
    mesh = _bowl()
    for number, case in enumerate(cases):
        row, column = divmod(number, columns)
        data = mesh.copy()
        square = blender.add_plane(f"{case.kind} {number}", mesh=data, location=(2 * column, -2 * row, 0))
        square.color = (0.2, 0.5, 0.8, 0.7)
        square.pass_index = number % 5
        data.materials.append(_glow(case, number, build))
    ours, theirs = rendered(path)
    # Negative light is none.
    theirs = np.maximum(theirs, 0)
    ours = ours if change is None else change(ours)
    found = {}
    for number, case in enumerate(cases):
        row, column = divmod(number, columns)
        part = (slice(SIDE * row + 1, SIDE * (row + 1) - 1), slice(SIDE * column + 1, SIDE * (column + 1) - 1))
        # There is no negative light in Glanz.
        a, b = ours[part], np.maximum(theirs[part], 0)
        found[case] = float((np.abs(a - b) <= NEAR * np.maximum(1, np.abs(b))).all(axis=2).mean())
    return found


def rendered(path):
    parity.be_exact(1, max_depth=0)
    scene = bpy.context.scene
    scene.glanz.pixel_filter, scene.cycles.pixel_filter_type = "blackman_harris", "BLACKMAN_HARRIS"
    scene.glanz.filter_width = scene.cycles.filter_width = 0.01
    scene.glanz.filter_textures = False
    # The points that docs/nodes.md was made with: near poles a share of a hundredth hangs on them.
    scene.glanz.sampler = "stratified"
    return parity.pixels("GLANZ", path), parity.pixels("CYCLES", path)


def _glow(case, number, build):
    """What a case gives, times 1/4 and plus 1/2, as emission: negative values are seen as well."""
    material = bpy.data.materials.new(f"{case.kind} {number}")
    material.pass_index = number % 7
    tree = blender.new_nodes(material)
    glows = [blender.add_node(tree, "ShaderNodeEmission", Strength=strength) for strength in (0.25, 0.5)]
    tree.links.new(build(tree, case), glows[0].inputs["Color"])
    glows[1].inputs["Color"].default_value = (1, 1, 1, 1)
    both, output = tree.nodes.new("ShaderNodeAddShader"), tree.nodes.new("ShaderNodeOutputMaterial")
    for glow, socket in zip(glows, both.inputs):
        tree.links.new(glow.outputs[0], socket)
    tree.links.new(both.outputs[0], output.inputs["Surface"])
    if hasattr(material, "cycles") and hasattr(material.cycles, "emission_sampling"):
        material.cycles.emission_sampling = "NONE"
    return material


def _bowl(cells=7, rows=9):
    """A square from -1 to 1, bent a little, smooth, with texture coordinates and a colour at each corner.

    Its cells are uneven, to keep the edges of triangles off the middles of pixels.
    """
    x, y = (a.ravel() for a in np.meshgrid(np.linspace(-1, 1, cells + 1), np.linspace(-1, 1, rows + 1)))
    x, y = x + 0.031 * (1 - x * x), y + 0.023 * (1 - y * y)
    z = 0.35 * (1 - 0.6 * x * x - 0.4 * y * y)
    i = [row * (cells + 1) + column for row in range(rows) for column in range(cells)]
    mesh = blender.new_mesh("Bowl", np.stack((x, y, z)).T.tolist(), [(a, a + 1, a + cells + 2, a + cells + 1) for a in i])
    mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
    corners = np.array([loop.vertex_index for loop in mesh.loops])
    uvs = np.stack((0.5 + 0.45 * x + 0.1 * y, 0.5 - 0.1 * x + 0.4 * y)).T[corners]
    mesh.uv_layers.new(name="UVMap").uv.foreach_set("vector", uvs.ravel())
    colours = mesh.color_attributes.new("Color", "FLOAT_COLOR", "POINT")
    colours.data.foreach_set("color", np.stack((0.5 + 0.5 * x, 0.5 + 0.5 * y, z, 1 - z)).T.ravel())
    return mesh
