"""Passes that users name, AOVs and light groups, and ambient occlusion, are those of Cycles."""

import bpy
import numpy as np

from glanz.addon import passes
from glanz.engine.passes.aov import Aov
from glanz.engine.wavefront.film import Film
from glanz.tests.addon import blender
from glanz.tests.parity import parity, test_data_passes
from glanz.tests.parity.test_data_passes import means

GROUPS = ("sun", "panel", "sky")
NAMES = ("Heat", "Tint", *(f"Combined_{name}" for name in GROUPS), "Combined", "Ambient Occlusion")
TOLERANCE = 0.03
"""Of means over blocks, in units of the largest. Other seeds of Cycles differ by up to a third of that."""


def furnished():
    """The table top under a sun, a glowing panel and a sky in groups; the board tells its coordinates, the ball a number."""
    test_data_passes.table_top()
    parity.be_exact(256, 1)
    layer, world = bpy.context.view_layer, bpy.context.scene.world
    layer.use_pass_ambient_occlusion, world.light_settings.distance = True, 1.5
    for name in GROUPS:
        layer.lightgroups.add(name=name)
    for name, kind in (("Heat", "VALUE"), ("Tint", "COLOR")):
        aov = layer.aovs.add()
        aov.name, aov.type = name, kind
    sun = blender.link("Sun", bpy.data.lights.new("Sun", "SUN"))
    sun.rotation_euler, sun.data.energy, sun.lightgroup, world.lightgroup = (0.5, 0.3, 0), 2, "sun", "sky"
    panel = blender.add_plane("Panel", 1.0, (1.5, 1.5, 1.5))
    panel.rotation_euler, panel.lightgroup = (1.2, 0, -0.4), "panel"
    panel.data.materials.append(blender.new_material("Panel", "ShaderNodeEmission", Color=(1, 0.8, 0.6, 1), Strength=3))
    tree = bpy.data.materials["Plane"].node_tree
    aov, coordinates = tree.nodes.new("ShaderNodeOutputAOV"), tree.nodes.new("ShaderNodeTexCoord")
    aov.aov_name = "Tint"
    tree.links.new(coordinates.outputs["UV"], aov.inputs["Color"])
    inner = bpy.data.node_groups.new("Inner", "ShaderNodeTree")
    inner.interface.new_socket("In", in_out="INPUT", socket_type="NodeSocketFloat")
    given, aov = inner.nodes.new("NodeGroupInput"), inner.nodes.new("ShaderNodeOutputAOV")
    aov.aov_name = "Heat"
    inner.links.new(given.outputs[0], aov.inputs["Value"])
    group = bpy.data.materials["Sphere"].node_tree.nodes.new("ShaderNodeGroup")
    group.node_tree = inner
    group.inputs[0].default_value = 0.75


def rendered(engine, path):
    """{pass: (height, width, channels) float64} as the file has them."""
    bpy.context.scene.render.engine = engine
    found = blender.read_exr(blender.render(path / f"{engine}.exr"))
    by_name = {name.split(".")[-1]: values.astype(np.float64) for name, values in found.items()}
    return {name: by_name[passes.name_of(name) if name in passes.TABLE else name] for name in NAMES}


def beyond(ours, theirs):
    """{pass: how far the means of its blocks are from Cycles', in bars} where that is more than one."""
    result = {}
    for name in NAMES:
        a, b = means(ours[name]), means(theirs[name])
        assert a.shape == b.shape
        assert b.max() > 0.1
        result[name] = float(np.abs(a - b).max() / np.abs(b).max() / TOLERANCE)
    return {name: bars for name, bars in result.items() if not bars <= 1}


def test_named_passes_are_those_of_cycles(tmp_path):
    furnished()
    ours = rendered("GLANZ", tmp_path)
    assert beyond(ours, rendered("CYCLES", tmp_path)) == {}
    whole = sum(ours[f"Combined_{name}"] for name in GROUPS)
    np.testing.assert_allclose(whole, ours["Combined"][..., :3], atol=1e-5)


def test_the_comparison_catches_what_is_wrong(monkeypatch, tmp_path):
    """The mutants: light of the next group, and an alpha that is 1 where there is no AOV."""
    furnished()
    add, values = Film.add, Aov.values

    def of_another(film, plan, rays, lanes, L, light, bounces):
        add(film, plan, rays, lanes, L, 0 if light is None else (light + 1) % plan.world.lights.count, bounces)

    def everywhere(aov, *where):
        found = values(aov, *where)
        found[3:] = 1
        return found

    monkeypatch.setattr(Film, "add", of_another)
    monkeypatch.setattr(Aov, "values", everywhere)
    lost = beyond(rendered("GLANZ", tmp_path), rendered("CYCLES", tmp_path))
    assert {"Tint", *(f"Combined_{name}" for name in GROUPS)} <= lost.keys()
    assert not {"Heat", "Combined"} & lost.keys()
