"""Light through coloured panes: surfaces that let light pass straight on weaken it by their colour, and so do their shadows."""

import math

import bpy
import common

COLUMNS, ROWS, PANE, LEAD = 5, 4, 0.5, 0.03
COLOURS = ((0.9, 0.1, 0.08), (0.95, 0.65, 0.1), (0.1, 0.35, 0.9), (0.15, 0.7, 0.25), (0.6, 0.2, 0.8), (0.95, 0.9, 0.8))


def pane(name, colour):
    """A pane that passes `colour`, and is a little dull."""
    made = bpy.data.materials.new(name)
    made.diffuse_color = (*colour, 1.0)
    tree = common.empty_tree(made)
    clear, dull, mix, output = (
        tree.nodes.new(f"ShaderNode{kind}") for kind in ("BsdfTransparent", "BsdfDiffuse", "MixShader", "OutputMaterial")
    )
    for i, node in enumerate((clear, dull, mix, output)):
        node.location = (250 * max(i - 1, 0), -150 * (i == 1))
    clear.inputs["Color"].default_value = (*colour, 1.0)
    dull.inputs["Color"].default_value = (*(0.5 * c for c in colour), 1.0)
    mix.inputs[0].default_value = 0.12
    tree.links.new(clear.outputs[0], mix.inputs[1])
    tree.links.new(dull.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    return made


def window(panes, lead):
    """Panes side by side in the plane y = 0, with strips of lead around each."""
    vertices, faces, indices = [], [], []

    def rectangle(x, z, width, height, material, y=0.0):
        first = len(vertices)
        vertices.extend(((x, y, z), (x + width, y, z), (x + width, y, z + height), (x, y, z + height)))
        faces.append((first, first + 1, first + 2, first + 3))
        indices.append(material)

    for row in range(ROWS):
        for column in range(COLUMNS):
            x, z = (column - 0.5 * COLUMNS) * PANE, row * PANE
            rectangle(x, z, PANE, PANE, (2 * row + column + row * column) % len(panes))
    for column in range(COLUMNS + 1):
        rectangle((column - 0.5 * COLUMNS) * PANE - 0.5 * LEAD, 0.0, LEAD, ROWS * PANE, len(panes), y=-0.01)
    for row in range(ROWS + 1):
        rectangle(-0.5 * COLUMNS * PANE, row * PANE - 0.5 * LEAD, COLUMNS * PANE, LEAD, len(panes), y=-0.01)
    return common.mesh("Window", vertices, faces, [*panes, lead], material_indices=indices)


def build():
    """The scene."""
    scene = common.new_scene("Stained glass", 480, 320, samples=128, max_depth=6)
    scene.glanz.sampler = "sobol"
    panes = [pane(f"Pane {number}", colour) for number, colour in enumerate(COLOURS)]
    common.add(scene, "Window", window(panes, common.diffuse("Lead", (0.04, 0.04, 0.05))))
    stone = common.diffuse("Stone", (0.62, 0.59, 0.54))
    common.add(scene, "Floor", common.quad("Floor", (-8, -8, 0), (16, 0, 0), (0, 16, 0), stone))
    for side in (-1, 1):
        pillar = common.box(f"Pillar {side}", (0.3, 0.3, 2.3), stone)
        made = common.add(scene, f"Pillar {side}", pillar)
        made.location.x = side * (0.5 * COLUMNS * PANE + 0.15)
    ball = common.sphere("Ball", 0.32, common.diffuse("Chalk", (0.8, 0.8, 0.8)), segments=48, rings=24)
    common.add(scene, "Ball", ball).location = (0.35, -1.5, 0.32)
    common.light(scene, "Sun", "SUN", (1.2, 4.0, 3.4), (0, 0, 0), 3.6, angle=math.radians(0.8))
    scene.world = common.world((0.5, 0.65, 1.0), 0.22)
    common.camera(scene, (-1.3, -5.4, 2.5), (0.0, -0.6, 0.65), lens=40.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
