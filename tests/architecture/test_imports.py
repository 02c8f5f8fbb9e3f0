"""Imports go down only, and what is heavy or foreign is known in one place."""

import ast
import sys
from pathlib import Path

import pytest

from glanz import engine

ROOT = Path(__file__).resolve().parents[2]
ENGINE = ROOT / "engine"
PLUGINS = ("bsdfs", "lights", "cameras", "samplers", "filters", "passes", "integrators", "textures")
LAYERS = (
    ("errors", "constants", "dimensions", "arrays", "registry", "memory", "switching"),
    ("maths",),
    ("interfaces",),
    ("needs",),
    ("scene",),
    ("requirements",),
    ("bsdfs", "lights", "cameras", "samplers", "filters", "textures"),
    ("world",),
    ("wavefront",),
    ("integrators", "passes", "measured"),
    ("allotment",),
    ("ending",),
    ("saved",),
    ("plan", "work", "room"),
    ("rendering",),
    ("merging",),
    ("io",),
    ("libraries",),
    ("__init__",),
)
"""What may be imported stands above, or in the same folder."""
RANK = {name: rank for rank, layer in enumerate(LAYERS) for name in layer}
HOMES = {"embreex": "engine/world/accel.py", "OpenEXR": "engine/io/exr.py", "PIL": "engine/io/png.py"}
FOREIGN = {
    "engine": {"numpy", *HOMES},
    "addon": {"bpy", "numpy", "bl_ui", "bl_operators", "mathutils", "gpu", "gpu_extras", "bpy_extras", "bpy_types"},
}


def files(*folders):
    return sorted(path for folder in folders for path in (ROOT / folder).rglob("*.py"))


def name(path):
    return path.relative_to(ROOT).as_posix()


def imports(tree, path):
    """Each import as (module path relative to the package `glanz`, imported names), or the absolute name as a string."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            found += [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom):
            if not node.level:
                found.append(node.module)
                continue
            package = list(path.relative_to(ROOT).parts[:-1])
            base = package[: len(package) - (node.level - 1)]
            found.append(([*base, *(node.module.split(".") if node.module else [])], [alias.name for alias in node.names]))
    return found


def inside_engine(parts, names):
    """The engine's parts that an import means: `from ..maths import warps` is maths."""
    if parts[:1] != ["engine"]:
        return []
    if len(parts) > 1:
        return [parts[1:]]
    return [[imported] for imported in names]


def complaints(source, path):
    """What is wrong with the imports of an engine file, as text."""
    own = path.relative_to(ENGINE).parts
    rank = RANK[own[0].removesuffix(".py")]
    wrong = []
    for found in imports(ast.parse(source), path):
        if isinstance(found, str):
            top = found.split(".")[0]
            if top == "glanz":
                wrong.append(f"{found}: not relative")
            elif top not in sys.stdlib_module_names and top not in FOREIGN["engine"]:
                wrong.append(f"{found}: not a dependency of the engine")
            elif top in HOMES and HOMES[top] != name(path):
                wrong.append(f"{found}: only {HOMES[top]} may know it")
            continue
        parts, names = found
        if parts[:1] != ["engine"]:
            wrong.append(f"{'.'.join(parts)}: outside of the engine")
        for target in inside_engine(parts, names):
            same_folder = len(own) > 1 and own[0] == target[0]
            if own[0] == "__init__.py":
                continue
            if target[0] not in RANK:
                wrong.append(f"{'.'.join(target)}: in no layer")
            elif same_folder and own[0] in PLUGINS:
                siblings = [*target[1:], *(n for n in names if len(target) == 1 and n != "registry")]
                if siblings:
                    wrong.append(f"{'.'.join(siblings)}: a sibling")
            elif not same_folder and RANK[target[0]] >= rank and not RANK[target[0]] == rank == 0:
                wrong.append(f"{'.'.join(target)}: above {own[0]}")
    return wrong


@pytest.mark.parametrize("path", files("engine"), ids=name)
def test_imports_of_the_engine_go_down(path):
    assert complaints(path.read_text(encoding="utf-8"), path) == []


@pytest.mark.parametrize(
    ("place", "source", "message"),
    [
        ("maths/warps.py", "from ..scene.values import Mesh", "above maths"),
        ("maths/warps.py", "import bpy", "not a dependency"),
        ("maths/warps.py", "import scipy.stats", "not a dependency"),
        ("bsdfs/phong.py", "from .lambert import Lambert", "sibling"),
        ("bsdfs/phong.py", "from . import lambert", "sibling"),
        ("bsdfs/phong.py", "from ..world.accel import Accel", "above bsdfs"),
        ("bsdfs/phong.py", "from ..lights.area import AreaLight", "above bsdfs"),
        ("world/compile.py", "from embreex import rtcore", "only engine/world/accel.py"),
        ("world/compile.py", "import OpenEXR", "only engine/io/exr.py"),
        ("world/compile.py", "from ..plan import Plan", "above world"),
        ("requirements.py", "from .plan import Plan", "above requirements"),
        ("plan.py", "from glanz.engine.world import compile", "not relative"),
        ("plan.py", "from ..addon import export", "outside of the engine"),
    ],
)
def test_going_down_catches_an_import_that_does_not(place, source, message):
    (complaint,) = complaints(source, ENGINE / place)
    assert message in complaint


def test_every_part_of_the_engine_has_a_layer():
    parts = {path.name.removesuffix(".py") for path in ENGINE.iterdir() if not path.name.startswith("__pycache__")}
    assert parts <= set(RANK)


@pytest.mark.parametrize("path", files("addon"), ids=name)
def test_the_add_on_knows_the_engine_by_its_public_names(path):
    for found in imports(ast.parse(path.read_text(encoding="utf-8")), path):
        if isinstance(found, str):
            top = found.split(".")[0]
            assert top in FOREIGN["addon"] or top in sys.stdlib_module_names, found
            continue
        parts, names = found
        if parts[:1] == ["engine"]:
            assert parts == ["engine"], f"{'.'.join(parts)} is inside of the engine"
            assert set(names) <= set(engine.__all__), names
        elif not parts:  # the root package
            assert set(names) <= {"engine", "addon"}


@pytest.mark.parametrize("path", files("engine", "addon", "cli"), ids=name)
def test_imports_within_the_package_are_relative(path):
    """The same files also run as bl_ext.<repository>.glanz."""
    for found in imports(ast.parse(path.read_text(encoding="utf-8")), path):
        assert not isinstance(found, str) or found.split(".")[0] not in ("glanz", "engine", "addon", "cli"), found


def test_the_root_imports_nothing_when_it_is_imported():
    tree = ast.parse((ROOT / "__init__.py").read_text(encoding="utf-8"))
    assert not [node for node in tree.body if isinstance(node, ast.Import | ast.ImportFrom)]


def test_the_public_names_exist_and_are_told():
    assert len(set(engine.__all__)) == len(engine.__all__)
    for public in engine.__all__:
        assert hasattr(engine, public), public
