"""Vectors are those of Cycles: of a camera that turns, an object that flies, and one that changes its shape."""

import bpy
import numpy as np

from glanz.addon import passes
from glanz.addon.export import motion
from glanz.engine.passes.vector import Vector
from glanz.tests.addon import blender
from glanz.tests.parity import parity

OF_MEAN, OF_PIXEL = 0.015, 0.06
"""Of the longest vector; ours is that of one point in a pixel, Cycles' is averaged."""


def moving():
    camera = blender.add_camera(location=(0, -6, 2), width=48, height=32)
    camera.rotation_euler = (1.25, 0, 0)
    camera.keyframe_insert("rotation_euler", frame=0)
    camera.rotation_euler = (1.25, 0.02, 0.06)
    camera.keyframe_insert("rotation_euler", frame=4)
    board = blender.add_plane("Board", 12.0)
    board.data.materials.append(blender.new_material("Board", "ShaderNodeBsdfDiffuse"))
    card = blender.add_plane("Card", 1.6, (-1.2, 0, 1))
    card.rotation_euler = (1.4, 0, 0.2)
    card.keyframe_insert("location", frame=0)
    card.location = (0.3, -1, 1.5)
    card.keyframe_insert("location", frame=4)
    flag = blender.add_plane("Flag", 1.6, (1.5, 0, 1))
    flag.rotation_euler, flag.scale = (1.5, 0.2, 0), (1, 1.5, 1)
    flag.shape_key_add(name="Basis")
    key = flag.shape_key_add(name="Bent")
    for vertex, (x, y) in zip(key.data, ((0, 0), (0.5, 0), (0.5, 0.8), (0, 0))):
        vertex.co.x += x
        vertex.co.y += y
    for frame, value in ((0, 0.0), (4, 1.0)):
        key.value = value
        key.keyframe_insert("value", frame=frame)
    bpy.context.scene.frame_set(1)
    parity.be_exact(16, 0)
    bpy.context.view_layer.use_pass_vector = bpy.context.view_layer.use_pass_object_index = True
    for index, ob in enumerate((board, card, flag)):
        ob.pass_index = index + 1


def rendered(engine, path):
    """(vectors (height, width, 4), object indices (height, width))."""
    bpy.context.scene.render.engine = engine
    found = blender.read_exr(blender.render(path / f"{engine}.exr"), "XYZW")
    index = next(values for name, values in found.items() if name.split(".")[-1] in ("Object Index", "IndexOB"))
    return found[f"{bpy.context.view_layer.name}.Vector"].astype(np.float64), index[..., 0]


def apart(ours, theirs):
    """{object: how far vectors are from Cycles', in bars} where 3 x 3 pixels are all of one object."""
    (a, index), (b, _) = ours, theirs
    result = {}
    for number in (1, 2, 3):
        same = np.pad(index == number, 1)
        inside = np.logical_and.reduce([same[y : y + index.shape[0], x : x + index.shape[1]] for y in range(3) for x in range(3)])
        assert inside.sum() > 10
        difference, longest = (a - b)[inside], np.linalg.norm(b, axis=-1)[inside].max()
        of_pixel = np.linalg.norm(difference, axis=-1).max() / longest / OF_PIXEL
        result[number] = float(max(of_pixel, np.linalg.norm(difference.mean(axis=0)) / longest / OF_MEAN))
    return result


def test_vectors_are_those_of_cycles(tmp_path):
    moving()
    ours, theirs = rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path)
    assert np.abs(theirs[0]).max() > 3
    assert max(apart(ours, theirs).values()) < 1
    assert bpy.context.scene.frame_current == 1
    bpy.context.scene.render.use_motion_blur = True
    assert "Vector" not in passes.chosen(bpy.context.view_layer, bpy.context.scene)


def test_the_comparison_catches_what_stands_still(monkeypatch, tmp_path):
    """The mutants: the next frame's sign the other way round; shapes that stay."""
    moving()
    values = Vector.values

    def turned(plan, *where):
        return values(plan, *where) * np.array([[1], [1], [-1], [-1]])

    monkeypatch.setattr(Vector, "values", staticmethod(turned))
    assert min(apart(rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path)).values()) > 1
    monkeypatch.setattr(Vector, "values", staticmethod(values))
    monkeypatch.setattr(motion._Shapes, "beside", lambda shapes: shapes._mesh)
    found = apart(rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path))
    assert [number for number, bars in found.items() if bars > 1] == [3]
