"""Plug-ins are found by looking into their folder, and named when they are missing."""

import sys
from pathlib import Path

import pytest

from glanz import engine
from glanz.engine import registry
from glanz.engine.registry import Registry

ALL = [value for value in vars(registry).values() if isinstance(value, Registry)]


@pytest.mark.parametrize("plugins", ALL, ids=lambda r: r.kind)
def test_every_plug_in_is_registered_under_its_key_with_a_label_and_a_line_of_text(plugins):
    assert plugins
    for key, plugin in plugins.items():
        assert plugin.key == key
        assert plugin.label
        assert plugin.__doc__.strip().splitlines()[0].strip()
    assert len({plugin.label for plugin in plugins.values()}) == len(plugins)


@pytest.mark.parametrize("plugins", ALL, ids=lambda r: r.kind)
def test_an_unknown_plug_in_is_named_with_the_known_ones(plugins):
    with pytest.raises(KeyError, match=f"unknown {plugins.kind} 'nonsense'; known: {', '.join(plugins)}"):
        plugins["nonsense"]
    assert plugins.get("nonsense") is None


def test_a_new_file_in_a_folder_is_a_new_plug_in(tmp_path, monkeypatch):
    folder = tmp_path / "shapes_of_a_test"
    folder.mkdir()
    (folder / "__init__.py").write_text(
        "from glanz.engine.registry import Registry\nregistry = Registry('shape')\nregistry.discover(__name__, __path__)\n"
    )
    (folder / "b.py").write_text("from . import registry\n@registry.add\nclass B:\n    key = 'b'\n")
    (folder / "a.py").write_text("from . import registry\n@registry.add\nclass A:\n    key = 'a'\n")
    monkeypatch.syspath_prepend(tmp_path)
    import shapes_of_a_test

    assert list(shapes_of_a_test.registry) == ["a", "b"]
    for module in [name for name in sys.modules if name.startswith("shapes_of_a_test")]:
        monkeypatch.delitem(sys.modules, module)


def test_every_file_of_a_plug_in_folder_is_imported():
    for folder in ("bsdfs", "lights", "cameras", "samplers", "filters", "passes", "integrators"):
        for path in (Path(engine.__file__).parent / folder).glob("*.py"):
            module = "glanz.engine." + folder + ("" if path.stem == "__init__" else f".{path.stem}")
            assert module in sys.modules, module
