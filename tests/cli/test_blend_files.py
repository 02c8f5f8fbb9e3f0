"""The command line on .blend files, through Blender: one picture whichever way, clean output, true exit status."""

import importlib.util
import json
import signal
import subprocess
import sys

import numpy as np
import pytest

from glanz.engine.io.exr import read_exr, read_exr_metadata
from glanz.tests.command_line import command_line

pytestmark = pytest.mark.skipif(importlib.util.find_spec("bpy") is None, reason="bpy is not installed for this Python")

MAKE = """
import bpy, glanz, os, sys
glanz.register()
bpy.ops.wm.read_factory_settings()
scene = bpy.context.scene
scene.render.resolution_x, scene.render.resolution_y, scene.render.resolution_percentage = 48, 32, 50
scene.view_layers[0].use_pass_z = True
empty = scene.view_layers.new("Empty")
empty.layer_collection.children[0].exclude = True
empty.use = False
cube = bpy.data.objects["Cube"]
for frame, x in ((1, 0.0), (3, 1.0)):
    cube.location.x = x
    cube.keyframe_insert("location", frame=frame)
bpy.data.scenes.new("Blind")
smoke = bpy.data.objects.new("Smoke", bpy.data.volumes.new("Smoke"))
for name in ("Smoky", "Strict"):
    smoky = bpy.data.scenes.new(name)
    smoky.glanz.strict = name == "Strict"
    smoky.camera = scene.camera
    for ob in (scene.camera, smoke):
        smoky.collection.objects.link(ob)
torn = bpy.data.scenes.new("Torn")
torn.glanz.strict, torn.camera = True, scene.camera
mesh = bpy.data.meshes.new("Torn")
mesh.from_pydata([(0, 0, 0), (1, 0, 0), (0, 1, float("nan"))], [], [(0, 1, 2)])
torn.collection.objects.link(scene.camera)
torn.collection.objects.link(bpy.data.objects.new("Torn", mesh))
bpy.ops.wm.save_as_mainfile(filepath=os.path.abspath("scene.blend"))
sys.stdout.flush()
os._exit(0)
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    path = tmp_path_factory.mktemp("blend")
    subprocess.run([sys.executable, "-c", MAKE], cwd=path, check=True, capture_output=True)
    (path / "text.blend").write_text("no scene")
    (path / "cut.blend").write_bytes((path / "scene.blend").read_bytes()[:2000])
    return path


@pytest.fixture(scope="module")
def own_process(folder):
    """A process for each command."""

    def run(words, status=0):
        command = [sys.executable, "-m", "glanz.cli", *words.split()]
        result = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        assert result.returncode == status, result.stderr
        return result

    return run


@pytest.fixture(scope="module")
def glanz(folder):
    """The same, quicker: one process for all."""
    with command_line() as answer:

        def run(words, status=0):
            result = answer(folder, words)
            assert result.returncode == status, result.stderr
            return result

        yield run


def bits(path):
    channels = read_exr(path)
    assert channels["R"].any()
    return {name: values.tobytes() for name, values in channels.items()}


def test_a_blend_file_and_what_is_exported_from_it_give_one_picture(folder, glanz, own_process):
    result = own_process("render scene.blend -o a.exr -o a.png --samples 2")
    assert result.stdout == "wrote a.exr\nwrote a.png\n"
    assert read_exr(folder / "a.exr")["Depth.Z"].shape == (16, 24)
    assert read_exr_metadata(folder / "a.exr")["glanz.frame"] == "1"
    assert own_process("export scene.blend -o a.glanz").stdout == "wrote a.glanz\n"
    glanz("render a.glanz -o b.exr --samples 2 --threads 5")
    assert bits(folder / "b.exr") == bits(folder / "a.exr")


def test_another_shape_of_the_frame_gives_one_picture_too(folder, glanz):
    glanz("export scene.blend -o shape.glanz")
    for shape in ("16x24", "24x24"):
        glanz(f"render scene.blend -o c.exr --samples 1 --resolution {shape}")
        glanz(f"render shape.glanz -o d.exr --samples 1 --resolution {shape}")
        assert bits(folder / "c.exr") == bits(folder / "d.exr")
        height, width = read_exr(folder / "c.exr")["R"].shape
        assert f"{width}x{height}" == shape


def test_a_border_cuts_out_of_the_same_picture(folder, glanz):
    glanz("render scene.blend -o whole.exr --samples 1")
    glanz("render scene.blend -o part.exr --samples 1 --border 0.25,0.5,0.75,1")
    whole, part = read_exr(folder / "whole.exr"), read_exr(folder / "part.exr")
    for name, values in part.items():
        assert values.shape == (8, 12)
        assert values.tobytes() == whole[name][0:8, 6:18].tobytes()


def test_frames_are_numbered_and_differ(folder, glanz):
    result = glanz("render scene.blend -o f.exr -o f##.png --frames 1-3:2 --samples 1")
    assert result.stdout == "wrote f_0001.exr\nwrote f01.png\nwrote f_0003.exr\nwrote f03.png\n"
    assert bits(folder / "f_0001.exr") != bits(folder / "f_0003.exr")
    assert (folder / "f01.png").read_bytes() != (folder / "f03.png").read_bytes()
    glanz("render scene.blend -o g#.exr --frame 3 --samples 1 --quiet")
    assert bits(folder / "g3.exr") == bits(folder / "f_0003.exr")


def test_a_view_layer_is_rendered_by_its_name(folder, glanz):
    """Also where it is not used, and without a note about others: it has no cube in front of the world, which is one colour."""
    result = glanz("render scene.blend --view-layer Empty -o layer.exr --samples 1")
    assert "view layer" not in result.stderr
    red = read_exr(folder / "layer.exr")["R"]
    assert red.any()
    np.testing.assert_allclose(red, red[0, 0], rtol=1e-5)
    glanz("render scene.blend -o first.exr --samples 1")
    first = read_exr(folder / "first.exr")["R"]
    assert first.max() > 1.5 * first.min()
    assert "'Nope'" in glanz("info scene.blend --view-layer Nope", status=1).stderr
    glanz("export scene.blend -o layer.glanz --view-layer Empty")
    assert "has no view layers" in glanz("info layer.glanz --view-layer Empty", status=1).stderr


def test_info_prints_json_and_nothing_else(own_process):
    content = json.loads(own_process("info scene.blend --json --frame 2").stdout)
    assert (content["frame"], content["scene"]) == (2, "Scene")
    assert content["requirements"]["geometry"] == ["Cube"]
    assert (content["settings"]["width"], content["settings"]["height"]) == (24, 16)


def test_info_tells_by_kind_what_is_not_as_in_blender(glanz):
    """Also of a strict scene, which is not rendered."""
    content = json.loads(glanz("info scene.blend --scene Smoky --json").stdout)
    (note,) = content["notes"]
    assert note == {"what": "volumes are not rendered", "kind": "ignored", "datablock": "object", "name": "Smoke", "node": []}
    assert content["counts"]["warnings"] == len(content["warnings"]) == 1
    assert "ignored:\n  volumes are not rendered: object 'Smoke'\n" in glanz("info scene.blend --scene Strict").stdout


def test_what_the_engine_leaves_out_of_a_strict_scene_is_an_error(folder, glanz):
    result = glanz("render scene.blend --scene Torn -o torn.exr --quiet", status=1)
    assert result.stderr.startswith("glanz: error: scene 'Torn' is strict")
    assert "are left out: object 'Torn'" in result.stderr and result.stderr.count("\n") == 1
    assert not (folder / "torn.exr").exists()
    content = json.loads(glanz("info scene.blend --scene Torn --json").stdout)
    assert [(note["kind"], note["datablock"], note["name"]) for note in content["notes"]] == [("ignored", "object", "Torn")]


@pytest.mark.parametrize(
    ("words", "cause"),
    [
        ("render scene.blend --scene Nope", "Nope"),
        ("render scene.blend --scene Blind", "no camera"),
        ("info scene.blend --scene Blind", "no camera"),
        ("render scene.blend --scene Smoky --strict", "volumes are not rendered: object 'Smoke'. Change this in the scene"),
        ("export scene.blend --scene Smoky --strict -o a.glanz", "'Smoke'"),
        ("render text.blend", "text.blend"),
        ("render cut.blend", "cut.blend"),
        ("render scene.blend --samples 0", "samples is 0"),
        ("render scene.blend -o nowhere/a.exr", "nowhere"),
    ],
)
def test_a_failure_is_named_in_one_line_and_leaves_no_file(folder, glanz, words, cause):
    before = sorted(folder.iterdir())
    result = glanz(words, status=1)
    check_failure(result, cause)
    assert sorted(folder.iterdir()) == before


def check_failure(result, cause):
    assert result.stdout == ""
    assert result.stderr.startswith("glanz: error: ")
    assert cause in result.stderr
    assert result.stderr.count("\n") == 1


@pytest.mark.parametrize(("words", "cause"), [("render scene.blend --scene Blind", "no camera"), ("info cut.blend", "cut.blend")])
def test_a_failure_is_the_exit_status_of_the_process(own_process, words, cause):
    check_failure(own_process(words, status=1), cause)


def test_ctrl_c_stops_a_render_through_blender(folder):
    command = [sys.executable, "-m", "glanz.cli", *"render scene.blend -o never.exr --samples 10000 --resolution 2000x2000".split()]
    with subprocess.Popen(command, cwd=folder, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True) as process:
        process.stderr.readline()
        process.send_signal(signal.SIGINT)
        rest = process.stderr.read()
    assert process.returncode == 130
    # A line of progress may come between.
    assert rest.splitlines()[-1] == "glanz: stopped by SIGINT"
    assert not list(folder.glob("*never*"))
