"""Passes of data are those of Cycles, under its names: what the compositor, masks and denoisers are fed with."""

import bpy
import numpy as np
import pytest

from glanz.addon import passes
from glanz.engine.passes.denoising import DenoisingNormal
from glanz.engine.passes.mist import MistShare
from glanz.engine.passes.uv import Uv
from glanz.tests.addon import blender
from glanz.tests.parity import parity

AVERAGED = ("Mist", "UV", "Denoising Albedo", "Denoising Normal", "Denoising Depth")
OF_ONE_SAMPLE = ("Position", "Object Index", "Material Index")
BLOCKS = 4
TOLERANCE = 0.01
"""Of means over blocks, in units of the largest. Other seeds of Cycles differ by a third of that."""


def table_top(falloff="LINEAR"):
    """A ball and a card without texture coordinates on a tilted board, seen by a camera that is turned about all axes."""
    camera = blender.add_camera(location=(3, -5, 3), width=32, height=32)
    camera.rotation_euler = (1.05, 0.1, 0.5)
    world = blender.set_world((0.3, 0.35, 0.4))
    world.mist_settings.start, world.mist_settings.depth, world.mist_settings.falloff = 3.0, 5.0, falloff
    bpy.ops.mesh.primitive_plane_add(size=4, location=(0, 0, 0), rotation=(0.1, 0.05, 0.3))
    board = bpy.context.object
    bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=0.8, location=(0.4, 0, 0.9))
    bpy.ops.object.shade_smooth()
    ball = bpy.context.object
    card = blender.add_plane("Card", 1.0, (-1, 1, 1))
    card.rotation_euler = (1.2, 0.3, 0.2)
    for i, (ob, colour) in enumerate(((board, (0.7, 0.5, 0.3, 1)), (ball, (0.2, 0.5, 0.8, 1)), (card, (0.1, 0.6, 0.2, 1)))):
        material = blender.new_material(ob.name, "ShaderNodeBsdfDiffuse", Color=colour)
        ob.data.materials.append(material)
        ob.pass_index, material.pass_index = 3 + i, 10 * (i + 1)
    parity.be_exact(64, 0)
    layer = bpy.context.view_layer
    for key in (*AVERAGED, *OF_ONE_SAMPLE):
        setattr(*passes.switch(layer, passes.TABLE[key].flag), True)


def rendered(engine, path):
    """{pass: (height, width, channels) float64} as the file has them."""
    bpy.context.scene.render.engine = engine
    found = blender.read_exr(blender.render(path / f"{engine}.exr"))
    by_name = {name.split(".")[-1]: values.astype(np.float64) for name, values in found.items()}
    return {key: by_name[passes.name_of(key)] for key in (*AVERAGED, *OF_ONE_SAMPLE)}


def means(image):
    height, width, channels = image.shape
    return image.reshape(BLOCKS, height // BLOCKS, BLOCKS, width // BLOCKS, channels).mean(axis=(1, 3))


def beyond(ours, theirs):
    """{pass: how far the means of its blocks are from Cycles', in bars} where that is more than one."""
    result = {}
    for key in AVERAGED:
        a, b = means(ours[key]), means(theirs[key])
        assert a.shape == b.shape
        # What is behind everything is as far as can be from 5.1 on.
        known = b < 1e9
        assert known.sum() > 2
        result[key] = float(np.abs(a - b)[known].max() / np.abs(b)[known].max() / TOLERANCE)
    return {key: bars for key, bars in result.items() if not bars <= 1}


@pytest.mark.parametrize("falloff", ["LINEAR", "QUADRATIC", "INVERSE_QUADRATIC"])
def test_averages_are_those_of_cycles(falloff, tmp_path):
    table_top(falloff)
    ours, theirs = rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path)
    assert beyond(ours, theirs) == {}
    if falloff != "LINEAR":
        return
    # Of one sample: pixels that one thing fills have the same in both, and places differ by less than a pixel on the board.
    same = (ours["Object Index"] == theirs["Object Index"])[..., 0]
    assert same.mean() > 0.9
    for key in ("Object Index", "Material Index"):
        assert np.unique(ours[key]).size == 4
        assert (ours[key] == theirs[key])[same].all()
    apart = np.linalg.norm(ours["Position"] - theirs["Position"], axis=-1)[same]
    assert np.median(apart) < 0.15
    assert np.quantile(apart, 0.95) < 0.6


def test_the_comparison_catches_what_is_wrong(monkeypatch, tmp_path):
    """The mutants: mist by the depth along the axis, coordinates that are exchanged, normals of the world."""
    table_top()

    def mist_along_the_axis(plan, rays, surface, reflection):
        p = plan.seen_from_camera(plan, rays, surface.p)
        return plan.scene.world.mist.at(plan.camera.depth(plan.camera_k, p) / plan.world.frame.scale)[None]

    of_uv = Uv.values
    monkeypatch.setattr(MistShare, "values", staticmethod(mist_along_the_axis))
    monkeypatch.setattr(Uv, "values", staticmethod(lambda *all: of_uv(*all)[[1, 0, 2]]))
    monkeypatch.setattr(DenoisingNormal, "values", staticmethod(lambda plan, rays, surface, reflection: surface.ns))
    lost = beyond(rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path))
    assert lost.keys() == {"Mist", "UV", "Denoising Normal"}


def test_the_compositor_denoises_what_glanz_has_rendered(tmp_path):
    """Two samples through Denoise, with albedo and normal: much closer to the clean picture than they were."""
    table_top()
    bpy.context.scene.render.engine = "GLANZ"
    clean = parity.pixels("GLANZ", tmp_path)
    bpy.context.scene.glanz.samples = 2
    noisy = parity.pixels("GLANZ", tmp_path)
    tree, end = blender.compositor()
    layers, denoise = tree.nodes.new("CompositorNodeRLayers"), tree.nodes.new("CompositorNodeDenoise")
    for source, target in (("Image", "Image"), ("Denoising Albedo", "Albedo"), ("Denoising Normal", "Normal")):
        assert layers.outputs[source].enabled
        tree.links.new(layers.outputs[source], denoise.inputs[target])
    tree.links.new(denoise.outputs[0], end)
    denoised = blender.composited(tmp_path / "denoised.exr")
    error, before = (np.sqrt(np.square(image - clean).mean()) for image in (denoised[..., :3], noisy))
    assert before > 0.01
    assert error < 0.6 * before
