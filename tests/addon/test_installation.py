"""An installation that went wrong: Blender starts, says what is missing and how to cure it, and renders nothing by half."""

import sys
from types import ModuleType, SimpleNamespace

import bpy
import pytest

import glanz
from glanz import addon
from glanz.addon import backend, neighbour, preferences, properties
from glanz.tests.addon import blender
from glanz.tests.addon.test_panels import Layout


@pytest.fixture(autouse=True)
def as_it_was():
    yield
    glanz.unregister()
    backend._load.cache_clear()
    backend._faults.cache_clear()
    glanz.register()


def told():
    """What the preferences show."""
    panel = SimpleNamespace(layout=Layout())
    context = SimpleNamespace(region=SimpleNamespace(width=500), preferences=bpy.context.preferences)
    preferences.GlanzPreferences.draw(panel, context)
    assert all(len(line) <= 500 / 7 for line in panel.layout.drawn)
    return " ".join(panel.layout.drawn)


def break_library(monkeypatch, name, error):
    """From now on `import name` raises `error`."""
    for loaded in [key for key in sys.modules if key.partition(".")[0] == name]:
        monkeypatch.delitem(sys.modules, loaded)

    class Finder:
        @staticmethod
        def find_spec(fullname, path=None, target=None):
            if fullname == name:
                raise error

    monkeypatch.setattr(sys, "meta_path", [Finder, *sys.meta_path])
    backend._load.cache_clear()
    backend._faults.cache_clear()


def test_a_whole_installation_is_ready():
    assert backend.problem() == backend.remark() == neighbour.complaint() == ""
    assert told().startswith("Ready")


@pytest.mark.parametrize(
    "error",
    [
        ModuleNotFoundError("No module named 'embreex'"),
        ImportError("libembree4.so.4: cannot open shared object file: No such file or directory"),
        OSError("[WinError 193] %1 is not a valid Win32 application"),
        ValueError("numpy.dtype size changed, may indicate binary incompatibility"),
    ],
    ids=lambda error: type(error).__name__,
)
def test_an_embree_that_cannot_be_loaded_is_told_everywhere_and_breaks_nothing(monkeypatch, tmp_path, error, capfd):
    glanz.unregister()
    break_library(monkeypatch, "embreex", error)
    glanz.register()
    bpy.context.scene.render.engine = "GLANZ"
    for text in (backend.problem(), told()):
        assert "Glanz cannot render" in text and "embreex" in text and str(error) in text and backend.CURE in text
    assert bpy.types.GLANZ_RENDER_PT_problem.poll(SimpleNamespace(engine="GLANZ"))
    blender.add_camera()
    blender.add_plane()
    with pytest.raises(RuntimeError, match="Glanz cannot render") as failure:
        blender.render(tmp_path / "a.exr")
    assert backend.CURE in str(failure.value)
    assert not (tmp_path / "a.exr").exists()
    assert "Traceback" not in capfd.readouterr().err


def test_without_openexr_blender_still_renders_and_it_is_told(monkeypatch, tmp_path):
    blender.add_camera()
    with monkeypatch.context() as patch:
        break_library(patch, "OpenEXR", ImportError("libOpenEXR.so: wrong architecture"))
        assert backend.problem() == ""
        assert "wrong architecture" in backend.remark() and "wrong architecture" in told()
        path = blender.render(tmp_path / "a.exr")
    assert blender.read_exr(path)


def test_an_engine_that_cannot_be_loaded_is_a_message_not_a_crash(monkeypatch, tmp_path):
    glanz.unregister()
    monkeypatch.setattr(backend, "_load", backend.cache(lambda: (None, "ModuleNotFoundError: No module named 'numpy'")))
    monkeypatch.setattr(properties, "enum_items", lambda name: [])
    glanz.register()
    bpy.context.scene.render.engine = "GLANZ"
    assert "numpy" in told()
    blender.add_camera()
    with pytest.raises(RuntimeError, match="numpy"):
        blender.render(tmp_path / "a.exr")
    assert not (tmp_path / "a.exr").exists()


@pytest.fixture
def other(monkeypatch):
    """The same add-on under another name, as from another repository of extensions."""
    package = ModuleType("bl_ext")
    package.__path__ = glanz.__path__
    monkeypatch.setitem(sys.modules, "bl_ext", package)
    before = set(sys.modules)
    import bl_ext.addon as another

    yield another
    another.unregister()
    for name in set(sys.modules) - before:
        if name.startswith("bl_ext"):
            del sys.modules[name]


def test_the_second_of_two_versions_stands_back_and_takes_over_when_asked(other, tmp_path, caplog):
    blender.add_camera()
    other.register()
    assert "Another Glanz is in use, glanz" in caplog.text
    assert bpy.types.GLANZ_RENDER_PT_sampling.__module__ == "glanz.addon.panels"
    blender.render(tmp_path / "first.exr")
    addon.unregister()
    assert not hasattr(bpy.types.Scene, "glanz")
    other.unregister()
    other.register()
    assert bpy.types.GLANZ_RENDER_PT_sampling.__module__ == "bl_ext.addon.panels"
    bpy.context.scene.render.engine = "GLANZ"
    bpy.context.scene.glanz.samples = 1
    blender.render(tmp_path / "second.exr")
    addon.register()
    assert "glanz, stands back" in neighbour.complaint()
    other.unregister()
    assert neighbour.complaint() == ""
