"""What reviews would have to look for by hand."""

import ast
import re
from pathlib import Path

import pytest

from glanz.engine import interfaces

ROOT = Path(__file__).resolve().parents[2]
SHIPPED = ("engine", "addon", "cli")
BY_PROTOCOL = {
    method
    for protocol in vars(interfaces).values()
    if isinstance(protocol, type) and protocol.__module__ == interfaces.__name__
    for method in vars(protocol)
    if not method.startswith("_")
} | {"values", "part", "gather", "middle"}
"""Methods that `interfaces` documents once for all plug-ins; those added are in the texts of `Pass` and `Light`."""


def files(*folders):
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))


def name(path):
    return path.relative_to(ROOT).as_posix()


def undocumented(source):
    """Public classes, functions and methods without a docstring; those of plug-ins are documented by `interfaces`."""
    missing = []

    def look(node, owner="", by_protocol=()):
        for child in node.body:
            if not isinstance(child, ast.ClassDef | ast.FunctionDef) or child.name.startswith("_") or child.name in by_protocol:
                continue
            if not ast.get_docstring(child):
                missing.append(owner + child.name)
            if isinstance(child, ast.ClassDef):
                decorators = [ast.unparse(decorator) for decorator in child.decorator_list]
                look(child, f"{child.name}.", BY_PROTOCOL if "registry.add" in decorators else ())

    tree = ast.parse(source)
    if not ast.get_docstring(tree):
        missing.append("the file itself")
    look(tree)
    return missing


def unfinished(source):
    return re.findall(r"\b(?:TODO|FIXME|XXX|HACK)\b", source)


def swallowed(source):
    """Handlers that do nothing: `except: pass`."""
    return [
        node.lineno
        for node in ast.walk(ast.parse(source))
        if isinstance(node, ast.ExceptHandler) and all(isinstance(statement, ast.Pass) for statement in node.body)
    ]


@pytest.mark.parametrize("path", files("engine"), ids=name)
def test_public_names_are_documented(path):
    assert undocumented(path.read_text(encoding="utf-8")) == []


@pytest.mark.parametrize("path", [*files(*SHIPPED), ROOT / "__init__.py"], ids=name)
def test_nothing_is_left_to_do_and_no_error_is_swallowed(path):
    source = path.read_text(encoding="utf-8")
    assert unfinished(source) == []
    assert swallowed(source) == []


@pytest.mark.parametrize("path", files(*SHIPPED, "tests"), ids=name)
def test_files_stay_readable(path):
    assert len(path.read_text(encoding="utf-8").splitlines()) < 400


@pytest.mark.parametrize(
    ("law", "source"),
    [
        (undocumented, '"""File."""\ndef f():\n    return 1'),
        (undocumented, '"""File."""\nclass A:\n    """A."""\n    def row(self):\n        return 1'),
        (undocumented, "x = 1"),
        (unfinished, "# TODO: all of it"),
        (swallowed, "try:\n    f()\nexcept OSError:\n    pass"),
    ],
)
def test_style_catches_what_it_should(law, source):
    assert law(source)


def test_style_lets_plug_ins_lean_on_their_interface():
    assert not undocumented('"""File."""\n@registry.add\nclass A:\n    """A."""\n    def row(self):\n        return 1')
