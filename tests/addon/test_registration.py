"""Switching Glanz on and off leaves Blender as it was, also without the engine's libraries."""

import bpy
import pytest

import glanz
from glanz.addon import builtin_panels, properties
from glanz.addon.settings import _OWN


@pytest.fixture(autouse=True)
def registered_again():
    yield
    glanz.register()


def _traces():
    """Everything of Glanz that Blender can see."""
    joined = (p.__name__ for p in builtin_panels._subclasses(bpy.types.Panel) if "GLANZ" in getattr(p, "COMPAT_ENGINES", ()))
    panels = {name for name in joined if not name.startswith(("GLANZ", "Glanz"))}
    own = {name for name in dir(bpy.types) if name.startswith("GLANZ")}
    owners = (bpy.types.Scene, bpy.types.ViewLayer, bpy.types.Light, bpy.types.Material)
    return panels, own, any(hasattr(owner, "glanz") for owner in owners)


def _is_engine(identifier):
    try:
        bpy.context.scene.render.engine = identifier
    except TypeError:
        return False
    return True


def test_unregistering_takes_everything_back_twice_over():
    glanz.unregister()
    assert _traces() == (set(), set(), False)
    for _ in range(2):
        glanz.register()
        panels, own, has_settings = _traces()
        assert "GLANZ_RENDER_PT_sampling" in own
        assert _is_engine("GLANZ")
        assert has_settings
        assert len(panels) > 50
        glanz.unregister()
        assert not _is_engine("GLANZ")
    assert _traces() == (set(), set(), False)


def test_registering_twice_is_registering_once():
    glanz.register()
    glanz.register()
    glanz.unregister()
    assert _traces() == (set(), set(), False)
    glanz.unregister()


def test_half_a_registration_is_taken_back(monkeypatch):
    glanz.unregister()
    monkeypatch.setattr("glanz.addon.panels.register", lambda: 1 / 0)
    with pytest.raises(ZeroDivisionError):
        glanz.register()
    assert _traces() == (set(), set(), False)


def test_choices_are_those_of_the_engines_registries():
    settings = bpy.context.scene.glanz
    for name, registry in (("integrator", "INTEGRATORS"), ("sampler", "SAMPLERS"), ("pixel_filter", "FILTERS")):
        plugins = getattr(glanz.engine, registry)
        for key in plugins:
            setattr(settings, name, key)
            assert getattr(settings, name) == key
        items = properties.enum_items(registry)
        assert [item[0] for item in items] == list(plugins)
        assert len({item[4] for item in items}) == len(plugins)
        with pytest.raises(TypeError):
            setattr(settings, name, "nonsense")


def test_defaults_are_the_engines():
    settings = bpy.context.scene.glanz
    engine = glanz.engine.Settings()
    for name in _OWN:
        assert getattr(settings, name) == getattr(engine, name), name


def test_settings_survive_saving_and_loading(tmp_path):
    settings = bpy.context.scene.glanz
    settings.sampler, settings.samples, settings.pixel_filter = "random", 7, "box"
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    assert bpy.context.scene.glanz.samples == 64
    bpy.ops.wm.open_mainfile(filepath=path)
    settings = bpy.context.scene.glanz
    assert (settings.sampler, settings.samples, settings.pixel_filter) == ("random", 7, "box")
