"""Objects that some rays do not see, and that are held out, look as in Cycles: cards over a floor, between a mirror and a pane.

Where shadow rays see what scattered rays do not, or the other way round, it is a matter of weights how much light comes: avoided here.
"""

import bpy
import pytest

from glanz.engine import plan
from glanz.engine.wavefront.visibility import closest
from glanz.tests.addon import blender
from glanz.tests.parity import parity
from glanz.tests.parity.test_clear_film import pictures

TOLERANCE = 0.01
SAMPLES = 500


def cards(*names):
    """Glowing and dull cards over a dull floor with a mirror and a pane of glass; those of `names` are as they say."""
    camera = blender.add_camera(location=(0, -7, 3.5), width=32, height=32)
    camera.rotation_euler = (1.15, 0, 0)
    blender.set_world((0.3, 0.4, 0.5))
    blender.add_plane(size=12).data.materials.append(blender.new_material("Floor", "ShaderNodeBsdfDiffuse", Color=(0.6, 0.5, 0.4, 1)))
    mirror = blender.add_plane("Mirror", 4, (0, 3, 1.5))
    mirror.rotation_euler = (1.57, 0, 0)
    mirror.data.materials.append(blender.new_material("Mirror", "ShaderNodeBsdfAnisotropic", Color=(0.8, 0.8, 0.8, 1), Roughness=0))
    pane = blender.add_plane("Pane", 1.5, (1.4, -2, 1.2))
    pane.rotation_euler = (1.2, 0, 0)
    pane.data.materials.append(blender.new_material("Pane", "ShaderNodeBsdfGlass", Color=(0.7, 0.8, 0.8, 1), Roughness=0, IOR=1.001))
    glowing = blender.new_material("Glow", "ShaderNodeEmission", Color=(1, 0.6, 0.3, 1), Strength=1.5)
    dull = blender.new_material("Dull", "ShaderNodeBsdfDiffuse", Color=(0.2, 0.4, 0.7, 1))
    # A point: nothing but shadow rays finds it, so mirrors throw no sparks.
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy, lamp.shadow_soft_size = 300, 0
    blender.link("Lamp", lamp, (0, -1, 4))
    for i, flags in enumerate(names):
        card = blender.add_plane(f"Card {i}", 1.3, (1.5 * i - 2, 0.4 * i - 0.3, 0.8))
        card.rotation_euler = (1.0, 0.2 * i, 0.3)
        card.data.materials.append(glowing if i == 1 else dull)
        for flag in flags.split():
            setattr(card, flag, flag == "is_holdout")
    parity.be_exact(SAMPLES, 3)
    cycles = bpy.context.scene.cycles
    cycles.glossy_bounces = cycles.transmission_bounces = 3
    cycles.caustics_reflective = cycles.caustics_refractive = True


CASES = {
    "camera": ("visible_camera",) * 3,
    "diffuse and shadow": ("visible_diffuse visible_shadow",) * 3,
    "glossy and transmission": ("visible_glossy visible_transmission",) * 3,
    "holdout": ("is_holdout",) * 3,
}


def deviations(tmp_path):
    ours, theirs = (pictures(engine, tmp_path)["Combined"] for engine in ("GLANZ", "CYCLES"))
    alpha = abs(ours[..., 3] - theirs[..., 3]).mean()
    return parity.difference(ours[..., :3], theirs[..., :3]), alpha, theirs[..., 3].mean()


@pytest.mark.parametrize("name", CASES)
def test_what_rays_see_is_what_they_see_in_cycles(name, tmp_path):
    cards(*CASES[name])
    bpy.context.view_layer.use_pass_environment = True
    light, alpha, mean = deviations(tmp_path)
    print(f"{name}: light {light:.2%}, alpha {alpha:.4f} of {mean:.4f}")
    assert light <= TOLERANCE
    assert alpha <= TOLERANCE
    assert (mean < 1) == (name == "holdout")


@pytest.mark.parametrize(("lamp", "world"), [("", "camera diffuse"), ("diffuse", "glossy transmission")])
def test_lights_light_what_they_light_in_cycles(lamp, world, tmp_path):
    cards("", "", "")
    bpy.context.view_layer.use_pass_environment = True
    for kind in world.split():
        setattr(bpy.context.scene.world.cycles_visibility, kind, False)
    for kind in lamp.split():
        setattr(bpy.data.objects["Lamp"], f"visible_{kind}", False)
    light, alpha, mean = deviations(tmp_path)
    print(f"lamp hidden from {lamp}, world from {world}: light {light:.2%}, alpha {alpha:.4f} of {mean:.4f}")
    assert light <= TOLERANCE
    assert alpha <= TOLERANCE


def test_the_comparison_catches_flags_that_are_ignored(monkeypatch, tmp_path):
    cards(*CASES["glossy and transmission"])
    bpy.context.view_layer.use_pass_environment = True
    monkeypatch.setattr(plan, "closest_in_sight", closest)
    assert deviations(tmp_path)[0] > TOLERANCE
