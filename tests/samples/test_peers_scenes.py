"""The scenes of `make bench-peers` ask of every renderer what all of them have alike, and let Cycles cut nothing off."""

import pytest

from glanz.addon.capture import capture
from glanz.benchmarks.peers import __main__ as command, scenes
from glanz.engine import Dielectric, Lambert, Mirror

QUICK = ("cornell_box", "glass", "environment", "depth_of_field")
"""The others take Blender seconds to build; the measurement refuses them as well if anything is left out."""


def test_the_command_knows_all_scenes():
    assert tuple(scenes.SCENES) == command.SCENES


@pytest.mark.parametrize("name", QUICK)
def test_nothing_of_a_scene_is_left_out_or_of_one_renderer_alone(name):
    blender = scenes.build(name)
    scenes.set_frame(blender, samples=4, side=16, seed=3)
    scene, settings, warnings = capture()
    assert not warnings
    assert (settings.samples, settings.seed, settings.pixel_filter, settings.filter_textures) == (4, 3, "box", False)
    assert max(settings.width, settings.height) == 16
    lobes = {type(lobe) for o in scene.objects for material in o.materials for lobe in material.lobes}
    assert lobes <= {Lambert, Mirror, Dielectric}
    glows = [material.name for o in scene.objects for material in o.materials if any(material.emission)]
    assert glows or scene.lights or scene.world.environment


def test_cycles_is_unbiased():
    scene = scenes.build("cornell_box")
    scenes.set_frame(scene, samples=4, side=16)
    cycles = scene.cycles
    assert (cycles.samples, cycles.pixel_filter_type, cycles.device) == (4, "BOX", "CPU")
    bounces = {getattr(cycles, f"{kind}_bounces") for kind in ("max", "diffuse", "glossy", "transmission", "transparent_max")}
    assert bounces == {scene.glanz.max_depth}
    assert not (cycles.use_adaptive_sampling or cycles.use_denoising or cycles.blur_glossy or cycles.light_sampling_threshold)
    assert not (cycles.sample_clamp_direct or cycles.sample_clamp_indirect)
    assert cycles.caustics_reflective and cycles.caustics_refractive
    assert (scene.render.threads_mode, scene.render.threads) == ("FIXED", 2)
