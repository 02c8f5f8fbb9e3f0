"""A file's scene without rendering it; errors that name their cause; nothing changed behind the user's back."""

import bpy
import numpy as np
import pytest

import glanz
from glanz import engine
from glanz.addon.capture import Findings, capture, open_blend, save_png
from glanz.engine import SceneError
from glanz.tests.addon import blender


@pytest.fixture
def scene():
    blender.add_camera(width=32, height=16)
    blender.add_tetrahedron()
    return bpy.context.scene


def test_scene_settings_and_warnings_are_those_of_the_file(scene):
    scene.glanz.samples = 3
    scene.render.film_transparent = scene.cycles.film_transparent_glass = True
    value, settings, warnings = capture()
    assert [o.name for o in value.objects] == ["Tetrahedron"]
    assert (settings.width, settings.height, settings.samples) == (32, 16, 3)
    assert settings.film_transparent
    assert warnings == ("the film is not transparent behind glass, the world is seen through it: scene 'Scene'",)


def test_what_a_file_stores_about_materials_and_lights_counts_where_glanz_is_not_switched_on(scene, tmp_path):
    """As on the command line: the settings of lamps and materials are known for the time of the export, and forgotten again."""
    lamp = blender.link("Lamp", bpy.data.lights.new("Lamp", "SPOT"))
    lamp.data.glanz.characteristic, lamp.data.glanz.exponent = "COSINE", 3.5
    glass = blender.new_material("Glass", "ShaderNodeBsdfGlass", Roughness=0)
    glass.glanz.abbe = 42
    bpy.data.objects["Tetrahedron"].data.materials.append(glass)
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    glanz.unregister()
    try:
        open_blend(tmp_path / "a.blend")
        value, _, warnings = capture()
        assert not hasattr(bpy.types.Material, "glanz")
    finally:
        glanz.register()
    assert warnings == ()
    assert [light.exponent for light in value.lights] == [3.5]
    assert [lobe.abbe for lobe in value.objects[0].materials[0].lobes] == [42]


def test_strict_is_as_the_scene_says_or_as_the_caller_wishes(scene):
    blender.link("Smoke", bpy.data.volumes.new("Smoke"))
    findings = Findings()
    assert "Smoke" in capture(findings=findings)[2][0]
    assert [note.datablock for note in findings.notes] == [("object", "Smoke")]
    with pytest.raises(SceneError, match=r"(?s)strict.*'Smoke'"):
        capture(strict=True)
    scene.glanz.strict = True
    assert capture(strict=False)[2]
    with pytest.raises(SceneError, match=r"(?s)strict.*'Smoke'"):
        capture()


def test_overrides_and_the_camera_agree(scene):
    value, settings, _ = capture(overrides={"width": 10, "height": 20, "samples": 1})
    left, right, bottom, top = value.camera.window
    assert (right - left) / (top - bottom) == pytest.approx(0.5)
    assert (settings.width, settings.samples) == (10, 1)


def test_nothing_changes_but_the_frame(scene):
    render = scene.render
    render.engine, render.use_sequencer = "BLENDER_WORKBENCH", True
    before = [(name, len(getattr(bpy.data, name))) for name in ("objects", "meshes", "materials", "scenes", "images")]
    capture(frame=7)
    after = [(name, len(getattr(bpy.data, name))) for name in ("objects", "meshes", "materials", "scenes", "images")]
    assert dict(after) | {"images": 0} == dict(before) | {"images": 0}
    assert (render.engine, render.use_sequencer, render.use_compositing) == ("BLENDER_WORKBENCH", True, True)
    assert scene.frame_current == 7
    with pytest.raises(TypeError):
        render.engine = "GLANZ_CAPTURE"


def test_the_frame_counts(scene):
    ob = bpy.data.objects["Tetrahedron"]
    ob.location.x = 1
    ob.keyframe_insert("location", frame=1)
    ob.location.x = 5
    ob.keyframe_insert("location", frame=5)
    assert capture(frame=5)[0].objects[0].world_from_object[0, 3] == 5
    assert capture(frame=1)[0].objects[0].world_from_object[0, 3] == 1


def test_cameras_bound_to_markers_count(scene):
    other = blender.link("Other", bpy.data.cameras.new("Other"))
    for frame, camera in ((1, scene.camera), (10, other)):
        scene.timeline_markers.new(camera.name, frame=frame).camera = camera
    assert capture(frame=12)[0].camera.name == "Other"
    assert capture(frame=2)[0].camera.name == "Camera"


def test_other_scenes_and_view_layers_are_found_by_name(scene):
    other = bpy.data.scenes.new("Second")
    other.camera = scene.camera
    other.collection.objects.link(scene.camera)
    assert capture(scene_name="Second")[0].name == "Second"
    layer = scene.view_layers.new("Front")
    layer.use_pass_z = True
    _, settings, _ = capture(view_layer="Front")
    assert settings.passes == ("Combined", "Depth")
    assert capture()[2] == ("only view layer 'ViewLayer' is rendered, not: Front",)
    # Blender itself would render the other one.
    layer.use = False
    assert capture(view_layer="Front")[1].passes == ("Combined", "Depth")
    assert not layer.use


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ({"scene_name": "Nope"}, "unknown scene 'Nope'; the file has: Scene"),
        ({"view_layer": "Nope"}, "scene 'Scene' has no view layer 'Nope'"),
        ({"overrides": {"samples": 0}}, "samples is 0"),
        ({"overrides": {"nope": 0}}, "unknown settings nope"),
    ],
)
def test_wrong_arguments_are_named(arguments, words, scene):
    with pytest.raises(engine.SceneError, match=words):
        capture(**arguments)
    assert scene.render.engine == "GLANZ"


def test_a_missing_camera_is_named(scene):
    scene.camera = None
    with pytest.raises(engine.SceneError, match="scene 'Scene' has no camera"):
        capture()


def test_an_unexpected_error_is_a_glanz_error(scene, monkeypatch):
    def fail(*args):
        raise ValueError("broken")

    monkeypatch.setattr("glanz.addon.export.objects.export_mesh", fail)
    with pytest.raises(engine.GlanzError, match="object 'Tetrahedron' cannot be exported: ValueError: broken"):
        capture()


def test_files_are_opened_without_their_scripts(scene, tmp_path):
    text = bpy.data.texts.new("run.py")
    text.write("import bpy; bpy.context.scene.glanz.samples = 1234")
    text.use_module = True
    bpy.ops.wm.save_as_mainfile(filepath=str(tmp_path / "a.blend"))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    open_blend(tmp_path / "a.blend")
    assert "Tetrahedron" in bpy.data.objects
    assert bpy.context.scene.glanz.samples != 1234


def test_files_that_cannot_be_opened_are_named(tmp_path):
    (tmp_path / "text.blend").write_text("hello")
    (tmp_path / "cut.blend").write_bytes(b"BLENDER-v402" + b"junk" * 100)
    causes = {"none.blend": "No such file", "text.blend": "not a .blend file", "cut.blend": "cannot open", ".": "cannot read"}
    for name, cause in causes.items():
        with pytest.raises(engine.FileError, match=cause) as caught:
            open_blend(tmp_path / name)
        assert str(tmp_path) in str(caught.value)


def _image(value, width=4, height=2):
    pixels = np.zeros((height, width, 4), np.float32)
    pixels[..., 3] = 1
    pixels[0, :, :3] = value
    return engine.Image(width, height, {"Combined": pixels})


def _read_png(path):
    image = bpy.data.images.load(str(path))
    pixels = np.array(image.pixels[:]).reshape(image.size[1], image.size[0], 4)[::-1]
    bpy.data.images.remove(image)
    return pixels


def test_pictures_go_through_the_scenes_view_transform(scene, tmp_path):
    scene.view_settings.view_transform = "Standard"
    save_png(_image(0.5), tmp_path / "a.png")
    pixels = _read_png(tmp_path / "a.png")
    np.testing.assert_allclose(pixels[0, :, :3], 0.735, atol=0.003)  # sRGB of 0.5
    np.testing.assert_array_equal(pixels[1, :, :3], 0)
    scene.view_settings.exposure = 1
    save_png(_image(0.5), tmp_path / "a.png")
    np.testing.assert_allclose(_read_png(tmp_path / "a.png")[0, :, :3], 1, atol=0.003)
    assert sorted(p.name for p in tmp_path.iterdir()) == ["a.png"]


def test_saving_a_picture_leaves_the_file_as_it_was(scene, tmp_path):
    settings = scene.render.image_settings
    settings.file_format = "OPEN_EXR"
    settings.color_depth = "16"
    images = len(bpy.data.images)
    save_png(_image(0.5), tmp_path / "a.png")
    assert (settings.file_format, settings.color_depth) == ("OPEN_EXR", "16")
    assert len(bpy.data.images) == images
    assert (tmp_path / "a.png").read_bytes().startswith(b"\x89PNG")


def test_pictures_that_cannot_be_written_are_named(scene, tmp_path):
    with pytest.raises(engine.FileError, match="cannot write"):
        save_png(_image(1), tmp_path / "none" / "a.png")
    with pytest.raises(engine.SceneError, match="unknown scene 'Nope'"):
        save_png(_image(1), tmp_path / "a.png", "Nope")
    assert list(tmp_path.iterdir()) == []
