"""Every sample scene opens, is what its script makes, and renders without a complaint."""

import dataclasses
import os
import runpy
import subprocess
import sys

import bpy
import numpy as np
import pytest

from glanz.addon.capture import capture
from glanz.engine import AreaLight, Gloss, PointLight, SpotLight, SunLight, render_image
from glanz.tests.addon import blender
from glanz.tests.samples import samples

APPROXIMATED = {"materials": ["Sheen of Principled BSDF", "Subsurface of Principled BSDF"]}
"""What is said to be rendered as something near."""
every_sample = pytest.mark.parametrize("name", samples.NAMES)


def test_every_file_has_a_script_and_a_line_and_nothing_is_forgotten():
    files = {path.stem for path in samples.FOLDER.glob("*.blend")}
    scripts = {path.stem for path in samples.FOLDER.glob("*.py")} - {"balls", "common", "nets"}
    assert files == scripts == set(samples.NAMES)
    readme = (samples.FOLDER / "README.md").read_text(encoding="utf-8")
    assert all(f"[{name}]({name}.py)" in readme for name in samples.NAMES)


@every_sample
def test_a_file_is_small(name):
    assert (samples.FOLDER / f"{name}.blend").stat().st_size < 200_000


@every_sample
def test_a_file_is_what_its_script_makes(name, tmp_path, monkeypatch):
    made = tmp_path / "made.blend"
    script = samples.FOLDER / f"{name}.py"
    monkeypatch.setattr(sys, "argv", [str(script), str(made)])
    monkeypatch.syspath_prepend(str(samples.FOLDER))
    monkeypatch.chdir(tmp_path)
    # Scripts leave without the interpreter's clean-up, and would take this process along.
    monkeypatch.setattr(os, "_exit", sys.exit)
    with pytest.raises(SystemExit) as left:
        runpy.run_path(str(script), run_name="__main__")
    assert left.value.code == 0
    assert list(tmp_path.iterdir()) == [made]
    samples.open_sample(name)
    stored = samples.contents()
    bpy.ops.wm.open_mainfile(filepath=str(made))
    assert samples.contents() == stored
    assert stored["scene"][1] == "GLANZ"
    bpy.data.objects[0].location.x += 0.01
    bpy.context.view_layer.update()
    assert samples.contents() != stored


@every_sample
def test_a_sample_renders_to_a_well_exposed_picture_and_names_what_is_approximated(name):
    samples.open_sample(name, samples=4, side=48)
    scene, settings, warnings = capture()
    assert sorted(line.partition(" is ")[0] for line in warnings) == APPROXIMATED.get(name, [])
    image = render_image(scene, settings)
    assert image.warnings == ()
    # What F12 saves has the same bits: see test_three_ways.
    pixels = image.passes["Combined"]
    assert np.isfinite(pixels).all()
    assert pixels.min() >= 0
    shown = np.minimum(pixels[..., :3], 1)
    assert 0.03 < np.median(shown) < 0.6
    assert 0.1 < shown.mean() < 0.6
    assert shown.std() > 0.08
    assert np.mean(shown.min(axis=2) >= 1) < 0.1, "too much of the picture is white"


def test_a_script_runs_by_itself(tmp_path):
    """As README.md says; what each one makes is tested above, in this process."""
    command = [sys.executable, str(samples.FOLDER / "cornell_box.py"), "made.blend"]
    done = subprocess.run(command, capture_output=True, text=True, cwd=tmp_path, check=False)
    assert done.returncode == 0, done.stderr
    assert [path.name for path in tmp_path.iterdir()] == ["made.blend"]


def test_the_cornell_box_is_a_closed_room_but_for_its_front_with_a_lamp_flush_in_the_ceiling():
    samples.open_sample("cornell_box")
    scene, _, _ = capture()
    assert scene.lights == ()
    assert sum(o.mesh.triangles.shape[1] for o in scene.objects) == 7974
    ceiling = next(o for o in scene.objects if o.name == "Ceiling")
    assert [max(m.emission) > 0 for m in ceiling.materials] == [False, True]
    assert np.count_nonzero(ceiling.mesh.material_indices) == 2
    assert np.ptp(ceiling.mesh.vertices[2]) == 0
    assert ceiling.mesh.vertices.shape[1] == 16


def test_the_row_of_spheres_has_the_exponents_on_its_labels():
    samples.open_sample("phong_exponents")
    scene, _, _ = capture()
    labels = {ob.data.body for ob in bpy.data.objects if ob.type == "FONT"}
    found = {}
    for o in scene.objects:
        if o.name.startswith("Ball"):
            (lobe,) = o.materials[0].lobes
            assert isinstance(lobe, Gloss)
            found[o.name.removeprefix("Ball n=")] = lobe.exponent
    assert set(found) == labels
    np.testing.assert_allclose(list(found.values()), [float(key) for key in found], rtol=1e-4)
    assert (min(found.values()), max(found.values())) == pytest.approx((1, 1000), rel=1e-4)


def test_the_cabinet_has_a_light_of_each_kind():
    samples.open_sample("lights")
    scene, _, _ = capture()
    kinds = [type(light) for light in scene.lights]
    assert {kind: kinds.count(kind) for kind in kinds} == {SunLight: 1, PointLight: 1, SpotLight: 1, AreaLight: 4}
    areas = [light for light in scene.lights if isinstance(light, AreaLight)]
    assert sorted((light.is_ellipse, light.size_x == light.size_y) for light in areas) == [
        (False, False),
        (False, True),
        (True, False),
        (True, True),
    ]
    assert [o.name for o in scene.objects if any(max(m.emission) > 0 for m in o.materials)] == ["mesh"]
    assert len(bpy.data.lights) + 1 == sum(ob.type == "FONT" for ob in bpy.data.objects) == 8


def test_each_light_of_the_cabinet_lights_its_own_box(tmp_path):
    """With all others off, its box is the brightest of the eight, and brighter than by the world alone."""
    scene = samples.open_sample("lights", samples=16, side=128)
    boxes = [["sun", "point", "spot", "mesh"], ["square", "rectangle", "disk", "ellipse"]]
    scene.glanz.max_depth = 1
    scene.world.node_tree.nodes.clear()
    lamps = [ob for ob in bpy.data.objects if ob.name in (*boxes[0], *boxes[1])]
    for lamp in lamps:
        for other in lamps:
            other.hide_render = other is not lamp
        pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"][..., :3].mean(axis=2)
        height, width = pixels.shape
        cells = [
            [pixels[r * height // 2 : (r + 1) * height // 2, c * width // 4 : (c + 1) * width // 4].mean() for c in range(4)]
            for r in range(2)
        ]
        row, column = np.unravel_index(np.argmax(cells), (2, 4))
        assert boxes[row][column] == lamp.name
        assert cells[row][column] > 0.02


def test_the_flowers_are_thousands_of_instances_of_a_few_meshes():
    samples.open_sample("instances")
    scene, _, _ = capture()
    assert len(scene.objects) > 5000
    assert len({id(o.mesh) for o in scene.objects}) == 4


@pytest.mark.parametrize("side", [128, 64, 32])
def test_the_zone_plate_is_its_formula(side):
    """(1 + cos(64 r^2)) / 2 in the middle of each pixel, to 1 / 255; it goes on beyond the frame, where wide filters look."""
    samples.open_sample("zone_plate")
    scene, settings, warnings = capture()
    assert warnings == ()
    assert (settings.sampler, settings.pixel_filter, settings.samples, settings.filter_textures) == ("grid", "box", 1, False)
    picture = render_image(scene, dataclasses.replace(settings, width=side, height=side)).passes["Combined"][..., 1]
    x = (np.arange(side) + 0.5) * 2 / side - 1
    assert np.abs(picture - 0.5 - 0.5 * np.cos(64 * (x**2 + x[:, None] ** 2))).max() <= 1 / 255
    filtered = dataclasses.replace(settings, width=32, height=32, pixel_filter="tent", filter_width=4.0, samples=256)
    border = render_image(scene, filtered).passes["Combined"][0, :, 1]
    assert np.abs(border - 0.5).max() <= 0.15
