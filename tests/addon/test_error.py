"""The error of a picture in Blender: its passes, what ends a render, and what the status line and files say of it."""

import bpy
import numpy as np
import pytest

from glanz.addon import status
from glanz.engine.ending import Reached
from glanz.tests.addon import blender


@pytest.fixture
def lit():
    """A white diffuse plane under a large lamp."""
    blender.add_camera(width=32, height=32)
    blender.add_plane(size=20)
    lamp = blender.link("Lamp", bpy.data.lights.new("Lamp", "AREA"), (0, 0, 4))
    lamp.data.size, lamp.data.energy = 4, 100
    bpy.context.scene.glanz.samples = 1024


def header_of(path):
    return {name.removeprefix("glanz.ViewLayer."): value for name, value in blender.header(path).items()}


def test_an_error_target_ends_a_render_and_the_file_says_so(lit, tmp_path):
    bpy.context.scene.glanz.error_target = 0.05
    bpy.context.view_layer.glanz.use_pass_standard_error = True
    path = blender.render(tmp_path / "a.exr")
    header, passes = header_of(path), blender.read_exr(path)
    assert (header["ended_by"], header["done"]) == ("error", "100%")
    assert 0.001 < float(header["error"]) <= 0.05
    assert 32 <= int(header["samples"]) < 1024
    error, picture = passes["ViewLayer.Standard Error"], passes["ViewLayer.Combined"][..., :3]
    assert np.sqrt(np.square(error).mean()) / picture.mean() == pytest.approx(float(header["error"]), rel=1e-4)


def test_the_passes_of_the_error_are_those_of_the_view_layer(lit, tmp_path):
    bpy.context.scene.glanz.samples = 16
    layer = bpy.context.view_layer.glanz
    layer.use_pass_standard_error = layer.use_pass_confidence = True
    path = blender.render(tmp_path / "a.exr")
    passes = blender.read_exr(path)
    # Student's t of eight replicates.
    np.testing.assert_allclose(passes["ViewLayer.Confidence"], 2.3646 * passes["ViewLayer.Standard Error"], rtol=1e-3)
    assert header_of(path)["error"] != "not measured"


def test_without_being_asked_nothing_is_measured(lit, tmp_path):
    bpy.context.scene.glanz.samples = 16
    header = header_of(blender.render(tmp_path / "a.exr"))
    assert (header["ended_by"], header["error"], header["samples"]) == ("samples", "not measured", "16")


def test_a_time_limit_ends_a_render(lit, tmp_path):
    scene = bpy.context.scene.glanz
    scene.samples, scene.time_limit = 2**24, 0.2
    path = blender.render(tmp_path / "a.exr")
    assert header_of(path)["ended_by"] == "time"
    assert (blender.read_exr(path)["ViewLayer.Combined"][..., 3] == 1).all()


def test_the_status_line_says_the_error_when_it_is_known():
    assert status.text(0.5, 64, 10.0, reached=Reached(32, 0.0213)) == "50% of 64 samples, 0:10 left, error 2.1 % after 32"
    assert "error" not in status.text(0.5, 64, 10.0, reached=Reached(32))


def test_what_is_greyed_out_counts_for_nothing(lit, tmp_path):
    """Where pixels are divided the end is known; a preset may have switched that on."""
    glanz = bpy.context.scene.glanz
    glanz.samples, glanz.error_target, glanz.time_limit, glanz.adaptive_threshold = 4, 0.5, 60.0, 0.1
    assert header_of(blender.render(tmp_path / "a.exr"))["ended_by"] == "samples"
