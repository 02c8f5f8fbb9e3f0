"""F12: what is in the saved file, and that there is none when something went wrong."""

import threading
import time
from dataclasses import replace

import bpy
import numpy as np
import pytest

from glanz import engine
from glanz.addon import render_engine, results
from glanz.engine import rendering
from glanz.tests import helpers as h
from glanz.tests.addon import blender


@pytest.fixture
def furnace():
    """A white diffuse plane that fills the frame, 5 m below the camera, in a world of radiance 1: it looks like the world."""
    blender.add_camera()
    plane = blender.add_plane(size=20)
    plane.data.materials.append(blender.new_material("White", "ShaderNodeBsdfDiffuse", Color=(1, 0.5, 0.25, 1)))
    blender.set_world((1, 1, 1))
    return plane


def test_saved_pixels_are_the_radiance(furnace, tmp_path):
    passes = blender.read_exr(blender.render(tmp_path / "a.exr"))
    combined = passes["ViewLayer.Combined"]
    assert combined.shape == (64, 64, 4)
    np.testing.assert_allclose(combined, np.broadcast_to((1, 0.5, 0.25, 1), combined.shape), rtol=1e-4)


def test_passes_are_those_of_the_view_layer(furnace, tmp_path):
    layer = bpy.context.view_layer
    layer.use_pass_z = layer.use_pass_normal = True
    passes = blender.read_exr(blender.render(tmp_path / "a.exr"))
    np.testing.assert_allclose(passes["ViewLayer.Depth"], 5, rtol=1e-5)
    np.testing.assert_allclose(passes["ViewLayer.Normal"], np.broadcast_to((0, 0, 1), (64, 64, 3)), atol=1e-6)
    layer.use_pass_normal = False
    assert "ViewLayer.Normal" not in blender.read_exr(blender.render(tmp_path / "b.exr"))


def test_the_shadow_pass_is_in_files_and_in_the_compositor(furnace, tmp_path):
    """A sun through a pane of colour, behind the camera; EEVEE's name and channels."""
    tint = (0.25, 0.5, 1)
    blender.link("Sun", bpy.data.lights.new("Sun", "SUN"))
    pane = blender.add_plane("Pane", 20, (0, 0, 6))
    pane.data.materials.append(blender.new_material("Pane", "ShaderNodeBsdfTransparent", Color=(*tint, 1)))
    tree, end = blender.compositor()
    layers = tree.nodes.new("CompositorNodeRLayers")
    assert not any(socket.name == "Shadow" and socket.enabled for socket in layers.outputs)
    bpy.context.view_layer.use_pass_shadow = True
    assert layers.outputs["Shadow"].enabled
    tree.links.new(layers.outputs["Shadow"], end)
    for found in (blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Shadow"], blender.composited(tmp_path / "b.exr")):
        np.testing.assert_allclose(found[..., :3], np.broadcast_to(tint, (64, 64, 3)), rtol=1e-5)


def test_pixels_are_divided_at_edges_alone(tmp_path):
    """A plane that glows and covers half of pixel 16: with four levels its coverage to 1 %, and the file says where samples went."""
    blender.add_camera(location=(0, 0, 5), type="ORTHO", ortho_scale=1.0, width=32, height=32)
    lamp = blender.new_material("Lamp", "ShaderNodeEmission", Color=(1, 1, 1, 1), Strength=1)
    blender.add_plane(size=2, location=(1 + 0.5 / 32, 0, 0)).data.materials.append(lamp)
    glanz = bpy.context.scene.glanz
    glanz.samples, glanz.pixel_filter, glanz.adaptive_threshold, glanz.adaptive_levels = 1, "box", 0.2, 4
    bpy.context.view_layer.glanz.use_pass_sample_count = True
    path = blender.render(tmp_path / "a.exr")
    passes = blender.read_exr(path)
    picture, count = passes["ViewLayer.Combined"][..., 0], np.squeeze(passes["ViewLayer.Sample Count"])
    np.testing.assert_allclose(picture[:, 16], 0.5, atol=0.07)
    np.testing.assert_allclose(picture[:, 16].mean(), 0.5, atol=0.01)
    assert (picture[:, :16] == 0).all()
    assert (picture[:, 17:] == 1).all()
    assert (count[:, :14] == 1).all()
    assert (count[:, 16] > 30).all()
    assert blender.header(path)["glanz.adaptive_threshold"] == "0.2"


def test_the_file_says_how_it_was_made(furnace, tmp_path):
    bpy.context.scene.glanz.samples = 3
    header = blender.header(blender.render(tmp_path / "a.exr"))
    assert (header["glanz.samples"], header["glanz.version"]) == ("3", engine.__version__)


def test_the_file_says_how_each_layer_went(furnace, tmp_path, monkeypatch):
    """Samples, time and warnings; and that it was cancelled."""
    scene = bpy.context.scene
    scene.view_layers.new("Other").samples = 2
    blender.link("Smoke", bpy.data.volumes.new("Smoke"))
    began = time.monotonic()
    header = blender.header(blender.render(tmp_path / "a.exr"))
    seconds = [float(header[f"glanz.{layer}.total_time"].removesuffix(" s")) for layer in ("ViewLayer", "Other")]
    assert all(0 < s < time.monotonic() - began for s in seconds)
    assert [header[f"glanz.{layer}.samples"] for layer in ("ViewLayer", "Other")] == ["4", "2"]
    assert [header[f"glanz.{layer}.{what}"] for layer in ("ViewLayer", "Other") for what in ("done", "warnings")] == ["100%", "1"] * 2
    scene.glanz.tile_size = 16
    _CancelledAfter(monkeypatch, 3)
    share = blender.header(blender.render(tmp_path / "a.exr"))["glanz.ViewLayer.done"]
    assert 3 / 16 <= int(share.removesuffix("%")) / 100 + 0.01 < 1


def test_row_0_is_at_the_top_and_column_0_on_the_left(tmp_path):
    blender.add_camera()
    lamp = blender.new_material("Lamp", "ShaderNodeEmission", Color=(1, 1, 1, 1), Strength=1)
    blender.add_plane(size=2, location=(-1.2, 1.1, 0)).data.materials.append(lamp)
    pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"][..., 0]
    assert pixels[:32, :32].sum() > 100
    assert pixels[32:].sum() == pixels[:, 40:].sum() == 0


def test_three_ways_of_rendering_give_the_same_bits(furnace, tmp_path):
    pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"]
    from glanz.addon.capture import capture

    scene, settings, _ = capture()
    np.testing.assert_array_equal(pixels, engine.render_image(scene, settings).passes["Combined"])


@pytest.mark.parametrize("is_cropped", [False, True])
def test_a_border_shows_a_part_of_the_same_picture(is_cropped, tmp_path):
    blender.add_camera(width=70, height=50)
    blender.add_tetrahedron()
    blender.set_world((1, 0.8, 0.6))
    whole = blender.read_exr(blender.render(tmp_path / "whole.exr"))["ViewLayer.Combined"]
    render = bpy.context.scene.render
    render.use_border, render.use_crop_to_border = True, is_cropped
    render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y = 0.3, 0.9, 0.2, 0.71
    part = blender.read_exr(blender.render(tmp_path / "part.exr"))["ViewLayer.Combined"]
    # From the left 21 to 63, from the bottom 10 to 35.
    expected = whole[15:40, 21:63]
    if is_cropped:
        np.testing.assert_array_equal(part, expected)
    else:
        np.testing.assert_array_equal(part[15:40, 21:63], expected)
        assert part.shape == (50, 70, 4)
        assert part[:15].max() == part[:, :21].max() == 0


def test_resolution_percentage_scales_the_frame(furnace, tmp_path):
    bpy.context.scene.render.resolution_percentage = 25
    assert blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"].shape == (16, 16, 4)


def test_each_view_layer_gets_its_own_picture(furnace, tmp_path):
    other = bpy.context.scene.view_layers.new("Other")
    other.material_override = blender.new_material("Red", "ShaderNodeBsdfDiffuse", Color=(1, 0, 0, 1))
    other.use_pass_z = True
    passes = blender.read_exr(blender.render(tmp_path / "a.exr"))
    np.testing.assert_allclose(passes["ViewLayer.Combined"][..., 1], 0.5, rtol=1e-4)
    np.testing.assert_array_equal(passes["Other.Combined"][..., 1], 0)
    assert "Other.Depth" in passes
    assert "ViewLayer.Depth" not in passes


def test_an_animation_renders_every_frame_as_it_is_then(furnace, tmp_path):
    scene = bpy.context.scene
    furnace.location.z = 0
    furnace.keyframe_insert("location", frame=1)
    furnace.location.z = 2
    furnace.keyframe_insert("location", frame=2)
    scene.view_layers[0].use_pass_z = True
    for frame, depth in ((1, 5), (2, 3)):
        scene.frame_set(frame)
        passes = blender.read_exr(blender.render(tmp_path / f"{frame}.exr"))
        np.testing.assert_allclose(passes["ViewLayer.Depth"], depth, rtol=1e-5)


def test_the_status_line_says_which_layer_it_is_of_where_there_are_several(furnace, tmp_path):
    lines = []

    def note(line, *_):
        lines.append(str(line))

    bpy.app.handlers.render_stats.append(note)
    try:
        blender.render(tmp_path / "a.exr")
        assert any("% of 4 samples" in line for line in lines)
        assert not any("ViewLayer" in line for line in lines)
        bpy.context.scene.view_layers.new("Other")
        blender.render(tmp_path / "a.exr")
    finally:
        bpy.app.handlers.render_stats.remove(note)
    assert any("ViewLayer" in line and "% of 4" in line for line in lines)
    assert any("Other" in line and "% of 4" in line for line in lines)


def test_tiles_are_outlined_while_they_are_worked_on_and_none_in_the_end(furnace, tmp_path, monkeypatch):
    place = (16, 0, 16, 16)
    original, shown = engine.render, h.spy(monkeypatch, results.Outlines, "show")
    monkeypatch.setattr(engine, "render", lambda *args: (replace(step, in_work=(place,)) for step in original(*args)))
    blender.render(tmp_path / "a.exr")
    *during, end = [call.args[1] for call in shown]
    assert {*during} == {(place,)}
    assert end == ()


def _fail(error):
    def fail(*args, **kwargs):
        raise error

    return fail


def test_a_strict_scene_is_not_rendered_where_something_would_be_left_out(furnace, tmp_path):
    bpy.context.scene.glanz.strict = True
    whole = blender.render(tmp_path / "whole.exr")
    bpy.context.scene.render.use_freestyle = True
    blender.link("Smoke", bpy.data.volumes.new("Smoke"))
    with pytest.raises(RuntimeError, match=r"(?s)strict.*freestyle.*'Scene'.*volumes.*'Smoke'"):
        blender.render(tmp_path / "part.exr")
    assert list(tmp_path.iterdir()) == [whole]


@pytest.mark.parametrize("error", [ValueError("broken"), SystemExit(0), KeyboardInterrupt(), MemoryError()])
def test_an_error_in_the_export_fails_the_operator_and_writes_no_file(error, furnace, tmp_path, monkeypatch):
    monkeypatch.setattr("glanz.addon.export.objects.export_mesh", _fail(error))
    with pytest.raises(RuntimeError, match=r"object 'Plane'|Glanz") as caught:
        blender.render(tmp_path / "a.exr")
    if isinstance(error, ValueError):
        assert "object 'Plane' cannot be exported: ValueError: broken" in str(caught.value)
    assert not (tmp_path / "a.exr").exists()


def test_an_error_in_a_worker_fails_the_operator_and_leaves_no_thread(furnace, tmp_path, monkeypatch):
    monkeypatch.setattr("glanz.engine.rendering.trace", _fail(FloatingPointError("worker broke")))
    with pytest.raises(RuntimeError, match="worker broke"):
        blender.render(tmp_path / "a.exr")
    assert not (tmp_path / "a.exr").exists()
    assert not [t for t in threading.enumerate() if t.name.startswith("glanz")]


def test_an_error_while_a_tile_is_written_ends_the_result_and_fails(furnace, tmp_path, monkeypatch):
    monkeypatch.setattr("glanz.addon.results.flat_pixels", lambda values: np.zeros(3, np.float32))
    with pytest.raises(RuntimeError, match="Glanz failed"):
        blender.render(tmp_path / "a.exr")
    monkeypatch.undo()
    # Blender is as good as before.
    assert blender.read_exr(blender.render(tmp_path / "b.exr"))["ViewLayer.Combined"][0, 0, 0] == pytest.approx(1, rel=1e-4)


def test_an_unsupported_camera_is_named(furnace, tmp_path):
    camera = bpy.context.scene.camera.data
    camera.type = "PANO"
    camera.panorama_type = "MIRRORBALL"
    with pytest.raises(RuntimeError, match="camera 'Camera' has panorama type MIRRORBALL"):
        blender.render(tmp_path / "a.exr")
    assert not (tmp_path / "a.exr").exists()


class _CancelledAfter:
    """Esc is pressed once this many tiles were written. A tile starts when the last one was written."""

    def __init__(self, monkeypatch, tiles):
        self.written = []
        self._permits = threading.Semaphore(1)
        self._write, self._trace = results.write_tile, rendering.trace
        monkeypatch.setattr(results, "write_tile", self._write_tile)
        monkeypatch.setattr(rendering, "trace", self._trace_when_allowed)
        monkeypatch.setattr(render_engine.GlanzRenderEngine, "is_cancelled", lambda engine: len(self.written) >= tiles)

    def _write_tile(self, engine, tile, *place):
        self._write(engine, tile, *place)
        self.written.append(tile)
        self._permits.release()

    def _trace_when_allowed(self, plan, rays, film, is_cancelled):
        while not self._permits.acquire(timeout=0.01):
            if is_cancelled():
                return False
        return self._trace(plan, rays, film, is_cancelled)


def test_cancelling_keeps_finished_tiles_and_leaves_no_thread(furnace, tmp_path, monkeypatch):
    scene = bpy.context.scene
    scene.glanz.tile_size = 16
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    cancelled = _CancelledAfter(monkeypatch, 3)
    pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"]
    assert not [t for t in threading.enumerate() if t.name.startswith("glanz")]
    assert len(cancelled.written) == 3
    is_finished = np.zeros((64, 64), bool)
    for tile in cancelled.written:
        is_finished[tile.y : tile.y + 16, tile.x : tile.x + 16] = True
    np.testing.assert_array_equal(pixels[..., 3] == 1, is_finished)
    np.testing.assert_allclose(pixels[is_finished][:, 0], 1, rtol=1e-4)


def test_cancelling_stops_the_export(furnace, tmp_path, monkeypatch):
    cancelled = _CancelledAfter(monkeypatch, 0)
    pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"]
    assert not cancelled.written
    assert not pixels.any()


def test_tiles_and_threads_do_not_change_the_picture(tmp_path):
    blender.add_camera()
    blender.add_tetrahedron()
    blender.set_world((1, 0.8, 0.6))
    scene = bpy.context.scene
    scene.render.threads_mode = "FIXED"
    pictures = []
    for tile_size, threads in ((0, 1), (16, 5), (64, 2)):
        scene.glanz.tile_size, scene.render.threads = tile_size, threads
        pictures.append(blender.read_exr(blender.render(tmp_path / f"{threads}.exr"))["ViewLayer.Combined"])
    np.testing.assert_array_equal(pictures[0], pictures[1])
    np.testing.assert_array_equal(pictures[0], pictures[2])


def _pictures(monkeypatch, size):
    """A list that will have the picture as it was shown after each tile, (size, size, 4)."""
    shown, write = [], results.write_tile

    def write_tile(engine, tile, *place):
        shown.append(shown[-1].copy() if shown else np.zeros((size, size, 4), np.float32))
        shown[-1][tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = tile.passes["Combined"]
        write(engine, tile, *place)

    monkeypatch.setattr(results, "write_tile", write_tile)
    return shown


def test_the_whole_frame_refines_to_the_picture_of_the_tiles(tmp_path, monkeypatch):
    """After rounds of 1, 2, 4 and 6 samples the frame is whole and its error falls; the last picture has the bits of the tiles."""
    blender.add_camera()
    blender.add_tetrahedron()
    blender.set_world((1, 0.8, 0.6))
    glanz = bpy.context.scene.glanz
    glanz.samples, glanz.tile_size = 6, 32
    tiles = blender.read_exr(blender.render(tmp_path / "tiles.exr"))["ViewLayer.Combined"]
    shown = _pictures(monkeypatch, 64)
    glanz.progress = "FRAME"
    frame = blender.read_exr(blender.render(tmp_path / "frame.exr"))["ViewLayer.Combined"]
    np.testing.assert_array_equal(frame, tiles)
    assert len(shown) == 4 * 4
    errors = [np.abs(picture[..., :3] - tiles[..., :3]).mean() for picture in shown[3::4]]
    assert errors == sorted(errors, reverse=True)
    assert errors[0] > errors[1] > errors[3] == 0


def test_a_whole_frame_that_is_cancelled_is_whole(furnace, tmp_path, monkeypatch):
    """Unlike tiles: after the first round no pixel is empty, and what the second round has refined stays."""
    glanz = bpy.context.scene.glanz
    glanz.tile_size, glanz.progress = 32, "FRAME"
    cancelled = _CancelledAfter(monkeypatch, 6)
    pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"]
    assert len(cancelled.written) >= 6
    assert not cancelled.written[-1].is_final
    np.testing.assert_allclose(pixels, np.broadcast_to((1, 0.5, 0.25, 1), pixels.shape), rtol=1e-4)


def test_an_empty_scene_shows_the_world(tmp_path):
    blender.add_camera()
    blender.set_world((0.5, 0.25, 0), 2)
    pixels = blender.read_exr(blender.render(tmp_path / "a.exr"))["ViewLayer.Combined"]
    np.testing.assert_allclose(pixels, np.broadcast_to((1, 0.5, 0, 1), pixels.shape), rtol=1e-6)
