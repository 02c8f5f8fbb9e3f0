"""Scene files give back every bit, share what was shared, and answer damage with a FileError."""

import dataclasses
import io
import json
import zipfile

import numpy as np
import pytest
from hypothesis import given, strategies as st

from glanz.engine import (
    AreaLight,
    Bitmap,
    BumpMap,
    CheckerTexture,
    Coordinates,
    EnvironmentMap,
    FileError,
    Geometry,
    IesTexture,
    ImageTexture,
    Lambert,
    Lens,
    LinearTexture,
    Material,
    Medium,
    Mesh,
    MeshAttribute,
    Mist,
    NormalMap,
    Object,
    PerspectiveCamera,
    Phong,
    PointLight,
    Scene,
    Settings,
    Shade,
    SpotLight,
    SunLight,
    World,
    read_scene,
    write_scene,
)
from glanz.engine.registry import BSDFS, CAMERAS, LIGHTS
from glanz.tests.chance import law


def a_scene():
    rng = np.random.default_rng(2)
    corners = Mesh(
        name="mesh",
        vertices=rng.standard_normal((3, 40)),
        triangles=rng.integers(0, 40, (3, 30)),
        normals=rng.standard_normal((3, 9)),
        normal_indices=rng.integers(0, 9, (3, 30)),
        material_indices=rng.integers(0, 2, 30),
    )
    small = Mesh(name="small", vertices=np.float32([[0, 1, 0], [0, 0, 1], [0, 0, -0.0]]), triangles=[[0], [1], [2]])
    shaped = Mesh(
        name="shaped",
        vertices=np.zeros((3, 9)),
        triangles=rng.integers(0, 9, (3, 4)),
        normals=np.zeros((3, 5)),
        shapes=rng.standard_normal((4, 3, 9)),
        beside=rng.standard_normal((2, 3, 9)),
        shape_normals=rng.standard_normal((4, 3, 5)),
    )
    red = Material(name="röt", lobes=(Lambert((0.7, 0.1, 1 / 3)), Phong((0.1, 0.1, 0.1), exponent=np.float32(12.3))))
    red = dataclasses.replace(red, medium=Medium(absorption=(1 / 3, 0, float("inf")), priority=-2))
    aovs = (("way", Geometry("incoming")), ("heat", 1 / 3), ("tint", (1, 2.5, 3)))
    lamp = Material(name="lamp", emission=(1e-300, 5, 7), index=3, aovs=aovs)
    matrix = rng.standard_normal((4, 4))
    return Scene(
        camera=PerspectiveCamera(
            name="cam",
            world_from_camera=matrix,
            window=(-0.1, 0.5, -0.3, 0.3),
            clip_start=1 / 3,
            lens=Lens(radius=0.1, focus_distance=np.float32(0.3), blades=7),
            motion=rng.standard_normal((3, 4, 4)),
        ),
        objects=[
            Object(name="a", mesh=corners, materials=(red, lamp), world_from_object=matrix),
            Object(name="b", mesh=corners, materials=(lamp,), asset="a", group="key", beside=rng.standard_normal((2, 4, 4))),
            Object(name="c", mesh=small, motion=rng.standard_normal((2, 4, 4))),
            Object(name="e", mesh=shaped),
            Object(name="d", mesh=small, world_from_object=np.full((4, 4), np.nan)),
        ],
        lights=(
            PointLight(position=(1, 2.5, np.float32(0.1)), radius=np.float64(0.1), is_visible=True),
            SpotLight(world_from_light=matrix, blend=float("nan")),
            SunLight(irradiance=np.array([1, 2, 3], np.float32)),
            AreaLight(size_x=1e-30, is_ellipse=True),
            SpotLight(shade=Shade(texture=IesTexture(Geometry("incoming")), world_from_light=matrix, values=(("random", (0.5,) * 4),))),
        ),
        camera_beside=rng.standard_normal((2, 4, 4)),
        world=World(
            group="sky",
            occlusion_distance=0.5,
            radiance=(0.1, 0.2, 0.3),
            mist=Mist(start=1 / 3, depth=7, falloff="linear"),
            environment=EnvironmentMap(
                name="sky", pixels=rng.random((3, 4, 8)), world_from_map=matrix[:3, :3], strength=(1, 2, 1 / 3), interpolation="closest"
            ),
        ),
    )


SETTINGS = Settings(
    width=320, height=200, border=(1, 2, 30, 40), seed=2**70, passes=("Combined", "Depth"), filter_width=0.1, adaptive_threshold=0.3
)


def same(a, b):
    """Equal in type and bits, all the way down."""
    if isinstance(a, (np.ndarray, np.generic)):
        return type(a) is type(b) and a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()
    if dataclasses.is_dataclass(a):
        return type(a) is type(b) and all(same(getattr(a, f.name), getattr(b, f.name)) for f in dataclasses.fields(a))
    if isinstance(a, tuple):
        return isinstance(b, tuple) and len(a) == len(b) and all(map(same, a, b))
    return type(a) is type(b) and repr(a) == repr(b)


@pytest.fixture(scope="module")
def saved(tmp_path_factory):
    path = tmp_path_factory.mktemp("scene") / "a.glanz"
    write_scene(path, a_scene(), SETTINGS)
    return path


def test_a_scene_comes_back_bit_for_bit(saved):
    scene, settings = read_scene(saved)
    assert same(a_scene(), scene)
    assert same(SETTINGS, settings)


def test_the_comparison_above_sees_one_bit(saved):
    scene, _ = read_scene(saved)
    vertices = scene.objects[0].mesh.vertices.copy()
    vertices[2, 7] = np.nextafter(vertices[2, 7], 9)
    mesh = dataclasses.replace(scene.objects[0].mesh, vertices=vertices)
    changed = dataclasses.replace(scene, objects=(dataclasses.replace(scene.objects[0], mesh=mesh), *scene.objects[1:]))
    assert not same(a_scene(), changed)


def test_what_is_shared_stays_shared(saved):
    a, b, c, _, d = read_scene(saved)[0].objects
    assert a.mesh is b.mesh and c.mesh is d.mesh and a.mesh is not c.mesh
    assert a.materials[1] is b.materials[0]
    with zipfile.ZipFile(saved) as file:
        # vertices, triangles, normals, normal_indices, material_indices of the one large mesh, a matrix that is not finite, a sky;
        # two motions; shapes, their normals, and the vertices that follow from them; three of frames beside
        assert len(file.namelist()) == 7 + 2 + 3 + 1 + 3


def test_every_plug_in_with_its_defaults_comes_back(tmp_path):
    lights = tuple(cls() for cls in LIGHTS.values())
    material = Material(name="all", lobes=tuple(cls() for cls in BSDFS.values()))
    mesh = Mesh(name="m", vertices=np.zeros((3, 0), np.float32), triangles=np.zeros((3, 0)))
    for camera in (None, *(cls() for cls in CAMERAS.values())):
        scene = Scene(camera=camera, lights=lights, objects=(Object(name="o", mesh=mesh, materials=(material,)),))
        write_scene(tmp_path / "a", scene, Settings())
        assert same(scene, read_scene(tmp_path / "a")[0])


def textured_scene():
    rng = np.random.default_rng(3)
    bitmap = Bitmap(name="wood", pixels=rng.integers(0, 256, (3, 5, 7)).astype(np.uint8), is_srgb=False)
    image = ImageTexture(bitmap, Coordinates(layer="second", matrix=rng.standard_normal((4, 4))), "mirror", False)
    cover = Bitmap(name="cover", pixels=rng.random((4, 3, 2), np.float32))
    tiles = ((1001, bitmap), (1012, cover))
    tiled = ImageTexture(bitmap, output="uncut", projection="box", blend=0.2, normal=image, is_cubic=True, tiles=tiles)
    mixed = LinearTexture((image, CheckerTexture()), ((0.1, 0.2, 0.3), (0.3, 0.2, 0.1)), (0.1, 0.1, 0.1), True)
    material = Material(name="m", lobes=(Lambert(mixed), Phong((0.1, 0.1, 0.1), image)), emission=image)
    material = dataclasses.replace(material, relief=(NormalMap(image), BumpMap(mixed, 0.3)))
    mesh = Mesh(
        name="m", vertices=rng.standard_normal((3, 4)), triangles=rng.integers(0, 4, (3, 5)), generated=rng.random((3, 4)),
        uv_layers=("first", "second"), uvs=rng.random((2, 2, 9)), uv_indices=rng.integers(0, 9, (3, 5)),
        attributes=(
            MeshAttribute(name="point", values=rng.random((1, 4))),
            MeshAttribute(name="", values=rng.random((4, 9)), indices=rng.integers(0, 9, (3, 5))),
        ),
    )  # fmt: skip
    values = (("colour", (0.1, 1 / 3, 0.5, 1.0)), ("random", (0.25,) * 4))
    materials = (material, Material(name="n", emission=tiled))
    return Scene(camera=None, objects=(Object(name="o", mesh=mesh, materials=materials, values=values),))


def test_textures_come_back_and_pictures_stay_shared(tmp_path):
    write_scene(tmp_path / "a", textured_scene(), Settings())
    back = read_scene(tmp_path / "a")[0]
    assert same(textured_scene(), back)
    first, second = back.objects[0].materials
    assert first.emission.bitmap is second.emission.bitmap is first.lobes[0].reflectance.textures[0].bitmap


def test_what_is_hidden_and_held_out_comes_back(tmp_path):
    scene = textured_scene()
    first, *others = scene.objects
    materials = tuple(dataclasses.replace(material, holdout=material.emission) for material in first.materials)
    scene = dataclasses.replace(
        scene,
        objects=(dataclasses.replace(first, materials=materials, hidden_from=("glossy", "camera")), *others),
        lights=(PointLight(hidden_from=("diffuse",)),),
        world=dataclasses.replace(scene.world, hidden_from=("transmission",)),
    )
    write_scene(tmp_path / "a", scene, Settings(film_transparent=True))
    back, settings = read_scene(tmp_path / "a")
    assert same(scene, back)
    assert (back.objects[0].hidden_from, back.lights[0].hidden_from) == (("camera", "glossy"), ("diffuse",))
    assert settings.film_transparent


def test_reliefs_of_files_written_when_they_were_no_textures_are_read(tmp_path):
    write_scene(tmp_path / "a", textured_scene(), Settings())

    def as_it_was(document):
        for record in [r for r in document["shared"] if r["type"] in ("texture/normal map", "texture/bump map")]:
            kept = {"texture/normal map": ("texture", "strength", "layer"), "texture/bump map": ("texture", "distance", "strength")}
            fields = {name: record[name] for name in kept[record["type"]]}
            name = {"texture/normal map": "NormalMap", "texture/bump map": "BumpMap"}[record["type"]]
            record.clear()
            record.update(type=name, **fields)

    back = read_scene(edited(tmp_path / "a", tmp_path / "b", as_it_was))[0]
    assert same(textured_scene(), back)


def test_a_texture_stands_only_where_it_may(tmp_path):
    write_scene(tmp_path / "a", textured_scene(), Settings())

    def misplaced(document):
        material = next(r for r in document["shared"] if r["type"] == "Material")
        material["ambient"] = material["emission"]

    with pytest.raises(FileError, match="ambient"):
        read_scene(edited(tmp_path / "a", tmp_path / "b", misplaced))


def test_equal_scenes_give_equal_files(saved, tmp_path):
    write_scene(tmp_path / "b", a_scene(), SETTINGS)
    assert (tmp_path / "b").read_bytes() == saved.read_bytes()


def test_an_unknown_value_is_refused_by_name_and_leaves_nothing(tmp_path):
    class Torch:
        pass

    with pytest.raises(FileError, match=r"a\.glanz.*Torch"):
        write_scene(tmp_path / "a.glanz", Scene(camera=None, lights=(Torch(),)), SETTINGS)
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize("name", ["nowhere/a.glanz", "."])
def test_an_unwritable_path_is_named(tmp_path, name):
    with pytest.raises(FileError, match="cannot write"):
        write_scene(tmp_path / name, a_scene(), SETTINGS)


def rewritten(saved, path, change, compression=zipfile.ZIP_STORED):
    """`saved` again at `path`, with what `change(name, data)` makes of each entry: a valid zip, whatever is inside."""
    with zipfile.ZipFile(saved) as old, zipfile.ZipFile(path, "w", compression) as new:
        for name in old.namelist():
            new.writestr(name, change(name, old.read(name)))
    return path


def edited(saved, path, edit):
    def change(name, data):
        if name != "scene.json":
            return data
        document = json.loads(data)
        edit(document)
        return json.dumps(document)

    return rewritten(saved, path, change)


EDITS = {
    "version": lambda d: d.update(version=2),
    "not a Glanz scene": lambda d: d.update(format="x"),
    "unknown type 'os.system'": lambda d: d["scene"]["lights"][0].update(type="os.system"),
    "no field 'code'": lambda d: d["scene"]["lights"][0].update(code=1),
    "lights": lambda d: d["scene"]["lights"].append(d["scene"]["world"]),
    "position": lambda d: d["scene"]["lights"][0].update(position=["a", "b", "c"]),
    "radius": lambda d: d["scene"]["lights"][0].update(radius=10**300),
    "window": lambda d: d["scene"]["camera"].update(window=[0, 1]),
    "motion": lambda d: d["scene"]["objects"][2].update(motion={"array": [1, 2], "dtype": "float64", "shape": [2]}),
    "shapes": lambda d: d["shared"][-1].update(shapes={"array": [1, 2], "dtype": "float64", "shape": [2]}),
    "setting motion_steps": lambda d: d["settings"].update(motion_steps=0),
    "lens": lambda d: d["scene"]["camera"].update(lens=d["scene"]["world"]),
    "blades": lambda d: d["scene"]["camera"]["lens"].update(blades=2.5),
    "clip_end": lambda d: d["scene"]["camera"].update(clip_end="far"),
    "unknown content": lambda d: d["scene"]["objects"][0].update(mesh={"shared": 99}),
    "is missing": lambda d: d["scene"].update(name={"npy": "arrays/99.npy"}),
    "world": lambda d: d["scene"].update(world=None),
    "setting samples": lambda d: d["settings"].update(samples=0),
    "Scene": lambda d: d.update(scene=[]),
    "KeyError": lambda d: d.pop("settings"),
}


@pytest.mark.parametrize("cause", EDITS)
def test_a_wrong_document_is_a_file_error_that_names_the_cause(saved, tmp_path, cause):
    path = edited(saved, tmp_path / "b", EDITS[cause])
    with pytest.raises(FileError, match=cause) as error:
        read_scene(path)
    assert str(path) in str(error.value) and "\n" not in str(error.value)


def npy(header, data=b"\0" * 8):
    text = header.encode().ljust(117) + b"\n"
    return b"\x93NUMPY\x01\x00" + len(text).to_bytes(2, "little") + text + data


def pickled():
    file = io.BytesIO()
    np.save(file, np.array([print], object), allow_pickle=True)
    return file.getvalue()


@pytest.mark.parametrize(
    "data",
    [
        b"",
        b"\x93NUMPY\x01\x00",
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (3, 1000000000000), }"),
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (-1,), }"),
        npy("{'descr': '|O', 'fortran_order': False, 'shape': (1,), }"),
        npy("{'descr': '<f8', 'fortran_order': False, 'shape': (2,), }"),
        npy("__import__('os').system('true')"),
        pickled(),
    ],
)
def test_a_wrong_array_is_a_file_error(saved, tmp_path, data):
    path = rewritten(saved, tmp_path / "b", lambda name, old: data if name == "arrays/0.npy" else old)
    with pytest.raises(FileError, match=r"arrays/0\.npy"):
        read_scene(path)


def test_a_compressed_entry_is_refused(saved, tmp_path):
    path = rewritten(saved, tmp_path / "b", lambda name, data: data, zipfile.ZIP_DEFLATED)
    with pytest.raises(FileError, match="compressed"):
        read_scene(path)


@pytest.mark.parametrize(("path", "cause"), [("nowhere", "No such file"), (".", "not a regular file"), ("/dev/zero", "not a regular file")])
def test_what_is_no_file_is_a_file_error(tmp_path, path, cause):
    with pytest.raises(FileError, match=cause):
        read_scene(tmp_path / path)


@given(cut=st.integers(0, 100_000))
@law(quick=60, thorough=1000)
def test_a_truncated_file_is_a_file_error(saved, tmp_path, cut):
    data = saved.read_bytes()
    (tmp_path / "b").write_bytes(data[: cut % len(data)])
    with pytest.raises(FileError):
        read_scene(tmp_path / "b")


@given(st.lists(st.tuples(st.integers(0, 2**20), st.integers(0, 255)), min_size=1, max_size=8))
@law(quick=200, thorough=10_000)
def test_damaged_bytes_give_a_scene_or_a_file_error(saved, tmp_path, changes):
    data = bytearray(saved.read_bytes())
    for position, value in changes:
        data[position % len(data)] = value
    (tmp_path / "b").write_bytes(data)
    read_or_file_error(tmp_path / "b")


@given(st.lists(st.tuples(st.integers(0, 2**20), st.integers(0, 255)), min_size=1, max_size=4), st.booleans())
@law(quick=300, thorough=10_000)
def test_damage_behind_right_checksums_gives_a_scene_or_a_file_error(saved, tmp_path, changes, in_array):
    def change(name, data):
        if name != ("arrays/0.npy" if in_array else "scene.json"):
            return data
        data = bytearray(data)
        # Of arrays the header, which is parsed; any other bytes are numbers.
        length = 128 if in_array else len(data)
        for position, value in changes:
            data[position % length] = value
        return bytes(data)

    read_or_file_error(rewritten(saved, tmp_path / "b", change))


def read_or_file_error(path):
    try:
        scene, settings = read_scene(path)
    except FileError as error:
        assert str(path) in str(error)
    else:
        assert isinstance(scene, Scene) and isinstance(settings, Settings)
