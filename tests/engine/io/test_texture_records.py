"""Graphs of textures in scene files: shared parts stay shared, however deep; what is damaged is refused, and the place named."""

import json
import zipfile

import numpy as np
import pytest
from hypothesis import given, strategies as st

from glanz.engine import (
    Bitmap,
    FileError,
    GlanzError,
    ImageTexture,
    Lambert,
    LinearTexture,
    Material,
    Math,
    Mesh,
    NoiseTexture,
    Object,
    Scene,
    Settings,
    read_scene,
    render_image,
    write_scene,
)
from glanz.engine.registry import TEXTURES
from glanz.engine.scene.graphs import with_inner
from glanz.tests import helpers as h
from glanz.tests.chance import law
from glanz.tests.contracts.test_textures import ALL
from glanz.tests.engine.io.test_scene_file import same
from glanz.tests.textured import with_uvs

SETTINGS = Settings(width=2, height=2, samples=1, max_depth=1, threads=1)


def scene_of(texture):
    return h.scene([h.thing(with_uvs(h.quad()), Material(name="Wood", lobes=(Lambert(texture),)))], world=1.0)


def test_every_texture_with_its_defaults_comes_back(tmp_path):
    materials = tuple(Material(name=key, emission=cls()) for key, cls in TEXTURES.items())
    mesh = Mesh(name="m", vertices=np.zeros((3, 0), np.float32), triangles=np.zeros((3, 0)))
    scene = Scene(camera=None, objects=(Object(name="o", mesh=mesh, materials=materials),))
    write_scene(tmp_path / "a", scene, Settings())
    assert same(scene, read_scene(tmp_path / "a")[0])


def written(path, texture, edit=lambda records: None):
    """A scene file whose records of shared values `edit` has changed; `path`."""
    write_scene(path, scene_of(texture), SETTINGS)
    with zipfile.ZipFile(path) as file:
        entries = {name: file.read(name) for name in file.namelist()}
    document = json.loads(entries["scene.json"])
    edit(document["shared"])
    entries["scene.json"] = json.dumps(document).encode()
    with zipfile.ZipFile(path, "w") as file:
        for name, data in entries.items():
            file.writestr(name, data)
    return path


def read_texture(path):
    (thing,), _ = read_scene(path)[0].objects, None
    return thing.materials[0].lobes[0].reflectance


@pytest.mark.parametrize("depth", [60, 3000])
def test_graphs_stay_as_they_are_shared_and_deep(tmp_path, depth):
    """Each node feeds both inputs of the next: written out they would be 2^60, and one in the other deeper than Python's stack."""
    texture = NoiseTexture()
    for _ in range(depth):
        texture = Math(texture, texture, operation="maximum")
    path = written(tmp_path / "a", texture)
    found = read_texture(path)
    assert found.a is found.b
    assert len(with_inner(found)) == depth + 1
    assert path.stat().st_size < 1000 * (depth + 10)


def test_a_picture_in_several_textures_is_stored_and_read_once(tmp_path):
    bitmap = Bitmap(name="picture", pixels=np.random.default_rng(1).integers(0, 256, (3, 64, 64)).astype(np.uint8))
    found = read_texture(written(tmp_path / "a", Math(*(ImageTexture(bitmap, extension=e) for e in ("repeat", "clip", "mirror")))))
    assert found.a.bitmap is found.b.bitmap is found.c.bitmap
    assert (tmp_path / "a").stat().st_size < 1.5 * bitmap.pixels.nbytes + 5000


def test_textures_are_shown_without_what_they_are_made_of():
    texture = NoiseTexture()
    for _ in range(3000):
        texture = LinearTexture((texture, texture), (0.5, 0.5))
    assert repr(texture) == "<Linear Combination>"


def nested(records):
    inner = 0.5
    for _ in range(600):
        inner = {"type": "texture/math", "a": inner}
    records[-2]["a"] = inner


EDITS = {
    "another kind": lambda records: records[-2].update(a="red"),
    "another kind ": lambda records: records[-2].update(a=[0.5, 0.5]),
    "another kind  ": lambda records: records[-2].update(a={"type": "Settings"}),
    "another kind   ": lambda records: records[-2].update(operation=["add"]),
    "another kind    ": lambda records: records[-2].update(a=10**300),
    "unknown content": lambda records: records[-2].update(a={"shared": len(records) - 2}),
    "unknown content ": lambda records: records[-2].update(a={"shared": len(records) - 1}),
    "unknown content  ": lambda records: records[-2].update(a={"float": "NaN"}),
    "no field 'code'": lambda records: records[-2].update(code="import os"),
    "unknown type 'texture/glue'": lambda records: records[-2].update(type="texture/glue"),
    "unknown type 'builtins.eval'": lambda records: records[-2].update(type="builtins.eval"),
    "pixels": lambda records: next(r for r in records if r["type"] == "Bitmap").pop("pixels"),
    "array": lambda records: records[-2].update(a={"array": [0.5] * 10**6, "dtype": "float64", "shape": [10**6]}),
    "array ": lambda records: records[-2].update(a={"array": [0.5], "dtype": "float64", "shape": [10**15]}),
    "too deep": nested,
}


@pytest.mark.parametrize("cause", EDITS)
def test_a_damaged_texture_is_refused_and_its_place_named(tmp_path, cause):
    """`Math` is the last value but the material, whose number the message gives."""
    path = written(tmp_path / "a", Math(ImageTexture(), 0.5), EDITS[cause])
    with pytest.raises(FileError, match=cause.strip()) as error:
        read_scene(path)
    assert str(path) in str(error.value) and "\n" not in str(error.value) and len(str(error.value)) < 2500
    assert cause == "too deep" or "shared value" in str(error.value)


JUNK = st.sampled_from(
    (
        *(None, True, -1, 0, 7, 2**40, 1e30, -1e-30, {"float": "nan"}, {"float": "inf"}, "", "add", [], [1], [0.5] * 3, [[1, 2], "x"]),
        *({}, {"shared": 0}, {"shared": 1}, {"shared": 10**9}, {"npy": "scene.json"}, {"type": "Coordinates"}, {"type": "texture/noise"}),
        *({"type": "texture/image"}, {"array": [1, 2, 3], "dtype": "float32", "shape": [3, 1]}, {"array": [], "dtype": "U9", "shape": [0]}),
    )
)


@given(st.data())
@law(quick=60, thorough=10_000)
def test_any_damage_to_textures_gives_a_picture_or_a_refusal(tmp_path, data):
    """What can be read and is no texture that can be evaluated is refused when it is rendered."""

    def edit(records):
        for _ in range(data.draw(st.integers(1, 2))):
            record = data.draw(st.sampled_from([r for r in records if r["type"] not in ("Mesh", "Material")]))
            record[data.draw(st.sampled_from(sorted(record)))] = data.draw(JUNK)

    path = written(tmp_path / "a", data.draw(st.sampled_from(ALL)), edit)
    try:
        scene, settings = read_scene(path)
        image = render_image(scene, settings)
    except GlanzError as error:
        assert "\n" not in str(error)
    else:
        assert np.isfinite(image.passes["Combined"]).all()
