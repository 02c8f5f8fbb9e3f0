"""A transparent film is as clear as in Cycles: cards over nothing, lamps and a world that the camera sees, alpha and all."""

import bpy
import numpy as np

from glanz.engine import plan
from glanz.tests.addon import blender
from glanz.tests.parity import parity
from glanz.tests.parity.test_transparency import cards_over_floor

TOLERANCE = 0.01


def pictures(engine, path):
    """{"Combined": (height, width, 4), "Environment": (height, width, 3)} of the open file, by `engine`."""
    bpy.context.scene.render.engine = engine
    passes = blender.read_exr(blender.render(path / f"{engine}.exr"))
    named = {name.rpartition(".")[2].replace("Environment", "Env"): values.astype(np.float64) for name, values in passes.items()}
    return {name: named[key] for name, key in (("Combined", "Combined"), ("Environment", "Env"))}


def cards():
    """Those over a floor that is cut off, with a lamp and a sun that the camera sees."""
    cards_over_floor("area")
    scene, lamp = bpy.context.scene, bpy.data.objects["Lamp"]
    scene.render.resolution_x = scene.render.resolution_y = 32
    scene.render.film_transparent = scene.view_layers[0].use_pass_environment = True
    bpy.data.objects["Plane"].scale = (0.2, 0.4, 1)
    lamp.location, lamp.visible_camera = (1, 1, 1.8), True
    lamp.rotation_euler, lamp.data.energy = (1.2, 0.25, 0), 100
    # Blocks with a part of the lamp's rim are the noisiest: a third of what is allowed.
    scene.glanz.samples = scene.cycles.samples = 16 * scene.glanz.samples


def deviations(tmp_path):
    """The largest differences of block means: of light, relative; of alpha and of the Environment pass, as they are."""
    ours, theirs = (pictures(engine, tmp_path) for engine in ("GLANZ", "CYCLES"))
    combined = parity.difference(ours["Combined"][..., :3], theirs["Combined"][..., :3])
    alpha, environment = (
        [parity.block_means(picture) for picture in pair]
        for pair in ([np.repeat(p["Combined"][..., 3:], 3, axis=2) for p in (ours, theirs)], [p["Environment"] for p in (ours, theirs)])
    )
    assert 0 < alpha[1].mean() < 1
    return combined, *(float(np.abs(a - b).max()) for a, b in (alpha, environment))


def test_light_alpha_and_the_world_s_own_pass_are_those_of_cycles(tmp_path):
    cards()
    combined, alpha, environment = deviations(tmp_path)
    print(f"light {combined:.2%}, alpha {alpha:.4f}, environment {environment:.4f}")
    assert combined <= TOLERANCE
    assert alpha <= TOLERANCE
    assert environment <= TOLERANCE


def test_the_comparison_catches_a_world_that_is_seen(monkeypatch, tmp_path):
    cards()
    monkeypatch.setattr(plan, "hidden", lambda add_world: add_world)
    assert deviations(tmp_path)[0] > TOLERANCE
