"""Sky Texture is that of Cycles, and lights what it lights in Cycles, in every model that this version of Blender offers."""

import math

import bpy
import numpy as np
import pytest

from glanz.addon.export import nodes_sky
from glanz.tests.addon import blender
from glanz.tests.parity import parity

AIR = {"altitude": 900.0, "air_density": 1.5, "aerosol_density": 2.0, "ozone_density": 3.0}
# A sun whose rim passed the middle of a pixel of the first test would be chance: its single sample may be on either side.
SKIES = {
    "single": ("SINGLE_SCATTERING", {"sun_elevation": 0.26, "sun_rotation": 0.7}),
    "single, sun setting": ("SINGLE_SCATTERING", {"sun_size": 0.33, "sun_elevation": 0.08, "sun_rotation": 2.5, **AIR}),
    "multiple": ("MULTIPLE_SCATTERING", {"sun_elevation": 0.6, "sun_rotation": -1.0}),
    "multiple, past zenith": ("MULTIPLE_SCATTERING", {"sun_size": 0.3, "sun_intensity": 0.5, "sun_elevation": 2.5, **AIR}),
    "multiple, sun has set": ("MULTIPLE_SCATTERING", {"sun_size": 0.1, "sun_elevation": -0.06, "sun_rotation": 4.0}),
    "preetham": ("PREETHAM", {"sun_direction": (0.3, 0.5, 0.6), "turbidity": 3.0}),
    "hosek wilkie": ("HOSEK_WILKIE", {"sun_direction": (0.3, 0.5, 0.6), "turbidity": 3.7, "ground_albedo": 0.4}),
    "hosek wilkie, sun has set": ("HOSEK_WILKIE", {"sun_direction": (0.6, -0.5, -0.1), "turbidity": 10.0, "ground_albedo": 1.0}),
}
each = pytest.mark.parametrize(("model", "values"), SKIES.values(), ids=SKIES)


def set_sky(model, values, **others):
    tree = blender.set_world((1, 1, 1), 0.01).node_tree
    node = tree.nodes.new("ShaderNodeTexSky")
    models = [item.identifier for item in node.bl_rna.properties["sky_type"].enum_items]
    node.sky_type = model if model in models else "NISHITA"
    for name, value in (values | others).items():
        setattr(node, name if hasattr(node, name) else "dust_density", value)
    tree.links.new(node.outputs["Color"], next(n for n in tree.nodes if n.type == "BACKGROUND").inputs["Color"])
    return node


@each
def test_a_sky_is_that_of_cycles_in_every_direction(model, values, tmp_path):
    """To 1 % in blocks of 4 x 4 degrees and in its irradiance; single directions to 1/255, a sun to the pixels of its rim."""
    camera = blender.add_camera((0, 0, 0), 180, 90, type="PANO")
    if hasattr(camera.data, "panorama_type"):
        camera.data.panorama_type = "EQUIRECTANGULAR"
    else:
        camera.data.cycles.panorama_type = "EQUIRECTANGULAR"
    camera.rotation_euler = (0.5 * math.pi, 0, 0)
    set_sky(model, values)
    parity.be_exact(1, max_depth=0)
    scene = bpy.context.scene
    scene.glanz.pixel_filter, scene.cycles.pixel_filter_type = "blackman_harris", "BLACKMAN_HARRIS"
    scene.glanz.filter_width = scene.cycles.filter_width = 0.01
    ours, theirs = parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path)
    assert theirs.std() > 0
    scale = np.median(theirs[theirs > 0])
    assert (np.abs(ours - theirs).max(axis=2) <= np.maximum(theirs.max(axis=2), scale) / 255).mean() >= 0.99
    a, b = (image.reshape(45, 2, 90, 2, 3).mean(axis=(1, 3)) for image in (ours, theirs))
    assert np.quantile(np.abs(a - b) / np.maximum(b, 0.1 * scale), 0.99) <= 0.01
    z = np.cos(np.pi * (np.arange(90) + 0.5) / 90)[:, None, None]
    up = np.maximum(z, 0) * np.sqrt(1 - z * z)
    np.testing.assert_allclose((ours * up).sum(axis=(0, 1)), (theirs * up).sum(axis=(0, 1)), rtol=0.01)


@each
def test_a_sky_lights_what_it_lights_in_cycles(model, values, tmp_path):
    camera = blender.add_camera((0, -5, 0), 32, 32, type="ORTHO", ortho_scale=2.0)
    camera.rotation_euler = (1.5, 0, 0)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.9)
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(blender.new_material("Dull", "ShaderNodeBsdfDiffuse", Color=(0.8, 0.8, 0.8, 1), Roughness=0))
    set_sky(model, values)
    parity.be_exact(256, max_depth=1)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path), blocks=2) <= 0.01


def test_the_sun_is_seen_beyond_the_clip_range(tmp_path):
    camera = blender.add_camera((0, 0, 0), 32, 32, lens=50.0)
    camera.data.clip_end = 10.0
    camera.rotation_euler = (0.5 * math.pi + 0.6, 0, 0)
    set_sky("SINGLE_SCATTERING", {"sun_size": 0.2, "sun_elevation": 0.6})
    parity.be_exact(4, max_depth=0)
    ours, theirs = parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path)
    middle = (slice(12, 20), slice(12, 20))
    assert ours[middle].mean() == pytest.approx(theirs[middle].mean(), rel=0.05)
    assert ours[middle].mean() > 20 * ours[0].mean()


def test_the_comparison_catches_a_sun_that_turns_the_other_way(monkeypatch, tmp_path):
    monkeypatch.setattr(nodes_sky, "_above", lambda elevation, rotation: (elevation, -rotation))
    with pytest.raises(AssertionError):
        test_a_sky_is_that_of_cycles_in_every_direction(*SKIES["single"], tmp_path)
