"""What Blender tells a rendered 3D view, and what comes of it; the drawing itself is tried in a Blender with a window (tests/desktop)."""

from types import SimpleNamespace

import bpy
import pytest

from glanz.addon import reports, viewport_draw
from glanz.addon.viewport import ENDLESS
from glanz.addon.viewport_draw import Viewport
from glanz.engine import PerspectiveCamera
from glanz.tests import helpers as h
from glanz.tests.addon import blender


class Engine:
    """Stands for Blender's render engine."""

    def __init__(self):
        self.told, self.redraws, self.pixel = ("", ""), 0, 2

    def update_stats(self, *text):
        self.told = text

    def get_preview_pixel_size(self, scene):
        return self.pixel

    def tag_redraw(self):
        self.redraws += 1


class Views:
    """A 3D view of 64 x 48 px in a Blender without windows."""

    def __init__(self, monkeypatch):
        self.exports = h.spy(monkeypatch, viewport_draw, "export_contents")
        monkeypatch.setattr(Viewport, "_show", lambda *args: None)
        monkeypatch.setattr(bpy.app.timers, "register", lambda *args, **kwargs: None)
        self.engine = Engine()
        self.viewport = Viewport(self.engine)
        spaces = (area.spaces.active for screen in bpy.data.screens for area in screen.areas if area.type == "VIEW_3D")
        self.space = next(spaces)
        region = SimpleNamespace(width=64, height=48)
        self.context = SimpleNamespace(space_data=self.space, region=region, region_data=self.space.region_3d)
        self.depsgraph = bpy.context.evaluated_depsgraph_get()

    def update(self, scene=None, depsgraph=None):
        self.viewport.update(self.context, depsgraph or self.depsgraph)

    def draw(self):
        self.viewport.draw(self.context, bpy.context.evaluated_depsgraph_get())

    def exported_after(self, change):
        """Whether a change was answered by an export."""
        before = len(self.exports)
        with blender.heard_by(self.update):
            change()
        return len(self.exports) > before

    @property
    def session(self):
        return self.viewport._session


@pytest.fixture
def views(monkeypatch):
    blender.add_camera()
    plane = blender.add_plane()
    plane.data.materials.append(blender.new_material("White", "ShaderNodeBsdfDiffuse"))
    blender.add_plane("Other", location=(3, 0, 0))
    bpy.context.scene.glanz.viewport_samples = 2
    bpy.data.worlds.new("Night")
    bpy.context.view_layer.update()
    views = Views(monkeypatch)
    views.update()
    yield views
    views.viewport.close()


def plane():
    return bpy.data.objects["Plane"]


def layer_collection():
    """That of a collection with the plane in it."""
    collection = bpy.data.collections.new("C")
    bpy.context.scene.collection.children.link(collection)
    collection.objects.link(plane())
    bpy.context.view_layer.update()
    return bpy.context.view_layer.layer_collection.children["C"]


@pytest.mark.parametrize("flag", ["holdout", "indirect_only"])
def test_collections_that_the_camera_sees_otherwise_are_exported(views, flag):
    own = layer_collection()
    views.exported_after(lambda: None)
    assert views.exported_after(lambda: setattr(own, flag, True))
    assert views.exported_after(lambda: setattr(plane(), "visible_camera", False))


@pytest.mark.parametrize(
    ("is_export", "change"),
    [
        (True, lambda: setattr(plane(), "location", (0, 0, 1))),
        (True, lambda: setattr(bpy.data.materials["White"].node_tree.nodes["Diffuse BSDF"].inputs[1], "default_value", 0.5)),
        (True, lambda: plane().hide_set(True)),
        (True, lambda: blender.add_plane("New")),
        (True, lambda: bpy.data.objects.remove(plane())),
        (True, lambda: setattr(bpy.context.scene, "world", bpy.data.worlds["Night"])),
        (False, lambda: plane().select_set(True)),
        (False, lambda: setattr(bpy.data.objects["Camera"], "location", (0, 0, 9))),
        (False, lambda: setattr(bpy.data.cameras["Camera"], "lens", 20)),
    ],
    ids=["move", "material", "hide", "add", "remove", "world", "select", "move camera", "lens"],
)
def test_what_changes_the_scene_is_exported_and_nothing_else(views, is_export, change):
    assert views.exported_after(change) == is_export


def test_the_session_looks_as_the_view_does_with_the_samples_and_pixels_of_the_scene(views):
    """And not at the border of F12, nor with its adaptive samples."""
    scene = bpy.context.scene
    scene.render.use_border, scene.render.border_max_x, scene.glanz.adaptive_threshold = True, 0.5, 0.25
    views.draw()
    settings = views.session._settings
    assert (settings.border, settings.adaptive_threshold) == ((), 0)
    assert (settings.width, settings.height, settings.samples, settings.passes) == (32, 24, 2, ("Combined",))
    assert isinstance(views.session._view.camera(), PerspectiveCamera)
    bpy.context.scene.glanz.viewport_samples, views.engine.pixel = 0, 1
    views.draw()
    settings = views.session._settings
    assert (settings.width, settings.height, settings.samples) == (64, 48, ENDLESS)


def test_redraws_are_asked_for_until_it_rests(views):
    views.draw()
    assert views.viewport._is_ticking
    while views.viewport._tick():
        continue
    assert not views.session.is_busy
    assert views.engine.redraws
    views.draw()
    assert not views.viewport._is_ticking
    assert views.engine.told[0] == "2 samples"


def test_what_is_not_rendered_as_in_blender_is_told(views):
    views.exported_after(lambda: setattr(bpy.context.scene.render, "use_freestyle", True) or plane().update_tag())
    views.draw()
    assert "freestyle" in views.engine.told[1]


def test_what_the_view_asks_for_and_does_not_get_is_told(views):
    views.draw()
    assert views.engine.told[1] == ""
    shading = views.space.shading
    shading.use_scene_world_render = False
    try:
        views.draw()
        assert views.engine.told[1] == "Scene World is off, but it is rendered"
        bpy.context.scene.render.use_motion_blur = True
        views.draw()
        assert views.engine.told[1] == "motion blur is rendered by F12 alone and 1 more"
        bpy.context.scene.render.use_motion_blur = False
        shading.use_scene_lights_render = False
        views.draw()
        assert views.engine.told[1] == "Scene Lights is off, but they are rendered and 1 more"
        views.space.region_3d.use_clip_planes = True
        views.draw()
        assert views.engine.told[1] == "the clipping region is ignored and 2 more"
    finally:
        views.space.region_3d.use_clip_planes = False
        shading.use_scene_world_render = shading.use_scene_lights_render = True


def test_a_fault_of_the_export_is_told_and_forgotten(views, monkeypatch, capsys):
    def broken(*args):
        raise ValueError("the moon is full")

    with monkeypatch.context() as patch:
        patch.setattr(viewport_draw, "export_contents", broken)
        views.update()
    views.draw()
    assert views.engine.told[0] == "Glanz failed: ValueError: the moon is full"
    assert "Traceback" in capsys.readouterr().err
    assert not views.session.is_busy
    views.update()
    views.draw()
    assert views.session.is_busy


def test_a_camera_that_cannot_be_used_is_told_and_forgotten(views):
    camera = bpy.data.cameras["Camera"]
    views.space.region_3d.view_perspective = "CAMERA"
    try:
        views.space.camera = bpy.data.objects["Camera"]
        camera.clip_start, camera.clip_end = 5, 2
        bpy.context.view_layer.update()
        views.draw()
        while views.session.is_busy:
            views.viewport._tick()
        views.draw()
        assert "clip range is 5.0 to 2.0" in views.engine.told[0]
    finally:
        views.space.region_3d.view_perspective = "PERSP"
    views.draw()
    assert views.session.is_busy


def test_an_engine_that_is_freed_ends_its_threads(views):
    bpy.context.scene.glanz.viewport_samples = 0
    views.draw()
    views.engine = views.viewport._engine()
    assert not views.viewport.is_closed
    views.engine = None
    assert views.viewport.is_closed


def test_closed_views_ask_for_nothing(views):
    views.draw()
    viewport_draw.close_all()
    assert views.viewport.is_closed
    assert views.viewport._tick() is None


def test_whatever_is_raised_becomes_text(capsys):
    engine = Engine()
    with reports.errors_told(engine):
        raise ValueError("the moon is full")
    assert engine.told == ("", "Glanz failed: ValueError: the moon is full")
    assert "Traceback" in capsys.readouterr().err
