"""Cryptomattes have the numbers, shares and manifests of Cycles'."""

import json

import bpy
import numpy as np

from glanz.engine.passes import cryptomatte
from glanz.tests.addon import blender
from glanz.tests.parity import parity, test_data_passes

KINDS = ("Object", "Material", "Asset")
SHARE = 0.16
"""Of a pixel: 5 standard deviations of the mean of 256 samples, each all or nothing, on either side."""


def half_hidden():
    """A board and a ball behind a card that hides 0.3 of what is behind it, and is a part of the ball."""
    test_data_passes.table_top()
    parity.be_exact(256, 0)
    bpy.data.objects["Card"].parent = bpy.data.objects["Sphere"]
    bpy.data.objects["Card"].location = (0.5, -1.5, 0.5)
    tree = bpy.data.materials["Card"].node_tree
    mix, clear = blender.add_node(tree, "ShaderNodeMixShader", Fac=0.3), tree.nodes.new("ShaderNodeBsdfTransparent")
    output = next(node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    surface = output.inputs["Surface"].links[0].from_socket
    for source, target in ((clear.outputs[0], mix.inputs[1]), (surface, mix.inputs[2]), (mix.outputs[0], output.inputs["Surface"])):
        tree.links.new(source, target)
    layer = bpy.context.view_layer
    layer.pass_cryptomatte_depth = 4
    for kind in KINDS:
        setattr(layer, f"use_pass_cryptomatte_{kind.lower()}", True)


def rendered(engine, path):
    """({kind: {number's bits: (height, width) shares}}, {kind: manifest})."""
    bpy.context.scene.render.engine = engine
    file = blender.render(path / f"{engine}.exr")
    shares = {}
    for name, values in blender.read_exr(file, "rgba").items():
        kind = name.split(".")[-1].removeprefix("Crypto")[:-2]
        if ".Crypto" in name:
            for number, share in ((values[..., 0], values[..., 1]), (values[..., 2], values[..., 3])):
                for bits in np.unique(np.ascontiguousarray(number).view(np.uint32)[share > 0]):
                    of_one = shares.setdefault(kind, {}).setdefault(f"{bits:08x}", np.zeros(share.shape))
                    of_one += np.where(np.ascontiguousarray(number).view(np.uint32) == bits, share, 0)
    header = {name: value for name, value in blender.header(file).items() if name.startswith("cryptomatte/")}
    heads = {value: name.removesuffix("name") for name, value in header.items() if name.endswith("/name")}
    layers = {kind: heads[f"{bpy.context.view_layer.name}.Crypto{kind}"] for kind in KINDS}
    for head in layers.values():
        assert (header[f"{head}hash"], header[f"{head}conversion"]) == ("MurmurHash3_32", "uint32_to_float32")
    return shares, {kind: (head, json.loads(header[f"{head}manifest"])) for kind, head in layers.items()}


def wrong(ours, theirs):
    """What differs between the shares and manifests of two engines, as text."""
    (shares, manifests), (their_shares, their_manifests) = ours, theirs
    found = []
    for kind in KINDS:
        (head, manifest), (their_head, their_manifest) = manifests[kind], their_manifests[kind]
        if head != their_head or not manifest.items() <= their_manifest.items():
            found.append(f"{kind} manifest")
        if shares[kind].keys() != their_shares[kind].keys():
            found.append(f"{kind} numbers")
        elif max(np.abs(shares[kind][bits] - their_shares[kind][bits]).max() for bits in shares[kind]) > SHARE:
            found.append(f"{kind} shares")
    return found


def test_cryptomattes_are_those_of_cycles(tmp_path):
    half_hidden()
    assert wrong(rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path)) == []


def test_the_comparison_catches_surfaces_that_hide_too_much(monkeypatch, tmp_path):
    """The mutant counts every surface where paths have stayed as whole."""
    half_hidden()
    monkeypatch.setattr(cryptomatte, "opacity", lambda plan, rays, surface: rays.beta.mean(axis=0))
    assert wrong(rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path)) == [f"{kind} shares" for kind in KINDS]


def test_the_compositor_makes_mattes_of_what_glanz_has_rendered(tmp_path):
    """By the name in the manifest: where the card is, it covers 0.3, and nothing elsewhere."""
    half_hidden()
    scene = bpy.context.scene
    scene.render.engine = "GLANZ"
    tree, end = blender.compositor()
    node = tree.nodes.new("CompositorNodeCryptomatteV2")
    node.source, node.matte_id = "RENDER", "Card"
    node.layer_name = f"{bpy.context.view_layer.name}.CryptoObject"
    tree.links.new(node.outputs["Matte"], end)
    matte = blender.composited(tmp_path / "matte.exr")
    covered = matte[..., 0][matte[..., 0] > 0.2]
    assert 50 < covered.size < 200
    assert abs(np.median(covered) - 0.3) < 0.01
    assert (matte[..., 0] == 0).mean() > 0.8
