"""The sky is that of Cycles, all around, and lights what it lights there; so does the sun in it."""

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender
from glanz.tests.parity import parity

KINDS = [e.identifier for e in bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items]
SINGLE = "SINGLE_SCATTERING" if "SINGLE_SCATTERING" in KINDS else "NISHITA"
AEROSOLS = "aerosol_density" if "aerosol_density" in bpy.types.ShaderNodeTexSky.bl_rna.properties else "dust_density"
CASES = {
    "morning": (SINGLE, {"sun_elevation": 0.26, "sun_rotation": 0.7}, 0.06),
    "noon": (SINGLE, {"sun_elevation": 1.3, "sun_rotation": -2.0}, 0.06),
    "dusk": (SINGLE, {"sun_elevation": 0.02, "sun_rotation": 2.0}, 0.06),
    "thick air": (SINGLE, {"sun_elevation": 0.5, "altitude": 5000, "air_density": 2.0, "ozone_density": 3.0, AEROSOLS: 0.5}, 0.06),
    "Preetham, clear": ("PREETHAM", {"sun_direction": (0, 0.5, 0.8), "turbidity": 2.0}, 0.002),
    "Preetham, hazy": ("PREETHAM", {"sun_direction": (0.7, 0.1, 0.4), "turbidity": 6.0}, 0.002),
}
"""Kind, attributes, and how far blocks of the picture may be off: around the sun the tables of both are coarse."""


def set_sky(kind, has_sun=False, **attributes):
    tree = blender.set_world((1, 1, 1)).node_tree
    sky = tree.nodes.new("ShaderNodeTexSky")
    sky.sky_type, sky.sun_disc = kind, has_sun
    for name, value in attributes.items():
        setattr(sky, name, value)
    background = next(n for n in tree.nodes if n.type == "BACKGROUND")
    tree.links.new(sky.outputs[0], background.inputs["Color"])
    return background


@pytest.mark.parametrize("name", CASES)
def test_a_sky_is_that_of_cycles_all_around(name, tmp_path):
    kind, attributes, tolerance = CASES[name]
    camera = blender.add_camera((0, 0, 0), 96, 48, type="PANO")
    owner = camera.data if hasattr(camera.data, "panorama_type") else camera.data.cycles
    owner.panorama_type = "EQUIRECTANGULAR"
    camera.rotation_euler = (np.pi / 2, 0, 0)
    set_sky(kind, **attributes)
    parity.be_exact(1, max_depth=0)
    scene = bpy.context.scene
    scene.glanz.pixel_filter, scene.cycles.pixel_filter_type = "blackman_harris", "BLACKMAN_HARRIS"
    scene.glanz.filter_width = scene.cycles.filter_width = 0.01
    ours, theirs = parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path)
    assert parity.difference(ours, theirs, blocks=4) <= tolerance
    assert np.abs(ours.mean(axis=(0, 1)) / theirs.mean(axis=(0, 1)) - 1).max() <= 0.01


@pytest.mark.parametrize(("kind", "angle"), [(SINGLE, 0.2), (SINGLE, 0.0095), ("PREETHAM", 0)])
def test_a_sky_and_its_sun_light_a_plane_as_in_cycles(kind, angle, tmp_path):
    """One bounce, so what arrives; to 1 %."""
    blender.add_camera((0, 0, 5), 16, 16, type="ORTHO", ortho_scale=1.0)
    plane = blender.add_plane(size=4)
    plane.data.materials.append(blender.new_material("Dull", "ShaderNodeBsdfDiffuse", Color=(0.5, 0.5, 0.5, 1), Roughness=0))
    sun = {"sun_size": angle, "sun_elevation": 0.6, "has_sun": True} if angle else {"sun_direction": (0.3, 0.2, 0.8)}
    set_sky(kind, **sun)
    parity.be_exact(256, max_depth=1)
    ours, theirs = (parity.pixels(engine, tmp_path).mean(axis=(0, 1)) for engine in ("GLANZ", "CYCLES"))
    assert np.abs(ours / theirs - 1).max() <= 0.01


def test_the_disc_is_seen_beyond_the_clip_range(tmp_path):
    camera = blender.add_camera((0, 0, 0), 32, 32, lens=50.0)
    camera.data.clip_end = 10.0
    camera.rotation_euler = (np.pi / 2 + 0.6, 0, 0)
    set_sky(SINGLE, has_sun=True, sun_size=0.2, sun_elevation=0.6)
    parity.be_exact(4, max_depth=0)
    ours, theirs = parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path)
    middle = (slice(12, 20), slice(12, 20))
    # Its rim is not darker in Glanz: the mean over the disc is the same.
    assert ours[middle].mean() == pytest.approx(theirs[middle].mean(), rel=0.25)
    assert ours[middle].mean() > 20 * ours[0].mean()


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind in ("HOSEK_WILKIE", "MULTIPLE_SCATTERING")])
def test_a_sky_that_is_approximated_is_named(kind):
    set_sky(kind)
    _, warnings = blender.export()
    assert any("rendered as" in line and "world 'World'" in line for line in warnings)
