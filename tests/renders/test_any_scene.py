"""Whatever is thrown at it, a render ends with a finite picture or a clear refusal (faults J14-J19, catalogue E11).

Scenes are drawn by Hypothesis: degenerate and empty meshes, sizes from 1e-12 to 1e12, all lights.
"""

import math
from types import SimpleNamespace

import numpy as np
import pytest
from hypothesis import given, strategies as st

from glanz.engine import (
    FILTERS,
    SAMPLERS,
    AreaLight,
    EnvironmentMap,
    GlanzError,
    Lambert,
    Material,
    Mesh,
    Object,
    PerspectiveCamera,
    Phong,
    PointLight,
    Scene,
    Settings,
    SpotLight,
    SunLight,
    Transparent,
    World,
    render_image,
)
from glanz.tests import helpers as h
from glanz.tests.chance import law

sizes = st.sampled_from((0.0, 1e-30, 1e-12, 1e-6, 1e-3, 0.5, 1.0, 3.0, 1e3, 1e6, 1e12))
coordinates = st.one_of(st.floats(-2, 2), st.sampled_from((0.0, -0.0, 1e-30, 1e-6, -1e6, 1e12)))
odd = st.one_of(coordinates, st.sampled_from((math.nan, math.inf, -math.inf, 1e300)))
points = st.tuples(coordinates, coordinates, coordinates)
powers = st.sampled_from((0.0, 1e-30, 1e-6, 1.0, 100.0, 1e6, 1e30))
colours = st.tuples(powers, powers, powers)
shares = st.sampled_from((0.0, 1e-6, 0.3, 0.5))
reflectances = st.tuples(shares, shares, shares)
flags = st.booleans()


@st.composite
def matrices(draw):
    """Rotations, scales, mirrors and flat ones; at times with a number that is none."""
    linear = h.rotation(draw(st.integers(0, 5))) @ np.diag([draw(sizes) * draw(st.sampled_from((1, -1))) for _ in range(3)])
    return h.affine(linear, [draw(coordinates) for _ in range(3)])


@st.composite
def meshes(draw):
    kind = draw(st.sampled_from(("quad", "box", "flat sphere", "smooth sphere", "triangles", "odd triangles", "one point", "empty")))
    if kind == "quad":
        return h.quad()
    if kind == "box":
        return h.box()
    if kind.endswith("sphere"):
        return h.icosphere(1, smooth=kind.startswith("smooth"))
    if kind == "empty":
        return Mesh(name=kind, vertices=np.zeros((3, draw(st.integers(0, 3)))), triangles=np.zeros((3, 0)))
    if kind == "one point":
        return Mesh(name=kind, vertices=np.zeros((3, 1)), triangles=np.zeros((3, 4)))
    number = odd if kind.startswith("odd") else coordinates
    vertices = np.array([[draw(number) for _ in range(6)] for _ in range(3)])
    triangles = np.array([[draw(st.integers(0, 5)) for _ in range(4)] for _ in range(3)])
    if draw(flags):
        return Mesh(name=kind, vertices=vertices, triangles=triangles)
    normals = np.array([[draw(coordinates) for _ in range(6)] for _ in range(3)])
    with np.errstate(over="ignore"):
        return Mesh(name=kind, vertices=vertices.astype(np.float32), triangles=triangles, normals=normals, normal_indices=triangles)


lobes = st.one_of(
    st.builds(Lambert, reflectances),
    st.builds(Transparent, reflectances),
    st.builds(Phong, reflectances, st.sampled_from((0.0, 0.5, 1.0, 30.0, 1e3, 1e6))),
)
materials = st.builds(
    Material,
    name=st.just("material"),
    lobes=st.lists(lobes, max_size=2),
    emission=st.one_of(st.just((0.0, 0.0, 0.0)), colours),
    alpha=st.one_of(st.just(1.0), shares),
)
objects = st.builds(Object, name=st.just("object"), mesh=meshes(), world_from_object=matrices(), materials=st.lists(materials, max_size=2))
towards = st.integers(0, 5).map(lambda seed: tuple(h.directions(seed, 1)[:, 0].tolist()))
lights = st.one_of(
    st.builds(PointLight, position=points, intensity=colours, radius=sizes, soft_falloff=flags, is_visible=flags),
    st.builds(
        SpotLight,
        world_from_light=matrices(),
        intensity=colours,
        angle=st.sampled_from((1e-6, 0.01, 1.0, math.pi)),
        blend=st.sampled_from((0.0, 0.15, 1.0)),
        radius=sizes,
        soft_falloff=flags,
        is_visible=flags,
    ),
    st.builds(SunLight, towards=towards, irradiance=colours, angle=st.sampled_from((0.0, 1e-6, 0.01, 1.0, math.pi)), is_visible=flags),
    st.builds(
        AreaLight,
        world_from_light=matrices(),
        size_x=sizes,
        size_y=sizes,
        is_ellipse=flags,
        radiance=colours,
        spread=st.sampled_from((1e-6, 0.01, 1.0, math.pi)),
        is_visible=flags,
    ),
)
cameras = st.builds(
    lambda seed, place, distance, zoom: PerspectiveCamera(
        world_from_camera=h.affine(h.rotation(seed), np.array(place) + distance * h.rotation(seed)[:, 2]), window=(-zoom, zoom, -zoom, zoom)
    ),
    st.integers(0, 5),
    points,
    st.sampled_from((0.0, 1e-6, 1.0, 4.0, 1e6)),
    st.sampled_from((1e-9, 0.3, 1.0, 100.0)),
)
environments = st.builds(
    lambda shape, seed, power, **others: EnvironmentMap(
        pixels=np.random.default_rng(seed).random((3, *shape)) ** power, world_from_map=h.rotation(seed), **others
    ),
    st.sampled_from(((1, 1), (1, 3), (4, 8))),
    st.integers(0, 5),
    st.sampled_from((1, 1000)),
    strength=colours,
    interpolation=st.sampled_from(("linear", "closest")),
)
scenes = st.builds(
    Scene,
    camera=cameras,
    objects=st.lists(objects, max_size=4),
    lights=st.lists(lights, max_size=3),
    world=st.builds(World, radiance=st.one_of(st.just((0.0, 0.0, 0.0)), colours), environment=st.one_of(st.none(), environments)),
)
ways = st.builds(
    Settings,
    width=st.just(8),
    height=st.just(8),
    samples=st.just(2),
    max_depth=st.sampled_from((0, 1, 3)),
    sampler=st.sampled_from(tuple(SAMPLERS)),
    pixel_filter=st.sampled_from(tuple(FILTERS)),
    passes=st.just(("Combined", "Depth", "Normal")),
    seed=st.integers(-1, 5),
    threads=st.just(1),
)


def check_any(scene, way):
    """A finite picture with every pass, or one line that says why not. Bad samples may be told, never seen."""
    try:
        image = render_image(scene, way)
    except GlanzError as error:
        assert str(error)
        assert "\n" not in str(error)
        return
    for name, values in image.passes.items():
        assert values.shape[:2] == (8, 8)
        assert np.isfinite(values).all(), name
    assert (image.passes["Combined"] >= 0).all()
    lengths = np.linalg.norm(image.passes["Normal"], axis=2)
    assert (lengths <= 1 + 1e-5).all()


@given(scenes, ways)
@law(quick=600, thorough=6000)
def test_any_scene_renders_to_finite_numbers_or_is_refused(scene, way):
    check_any(scene, way)


def test_any_scene_catches_a_film_that_keeps_what_is_not_finite(monkeypatch):
    """The mutant trusts every sample; a sun of 1e30 W / m^2 in a millionth of a degree is more than float32 holds."""
    scene = h.scene([h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)))], [SunLight(irradiance=(1e38,) * 3, angle=1e-6, is_visible=True)])
    scene = h.replaced(scene, camera=PerspectiveCamera.look_at((0, 0, 1), (0, 0, 3), up=(0, 1, 0), fov=1e-7))
    way = Settings(width=8, height=8, samples=2, threads=1, passes=("Combined", "Depth", "Normal"))
    check_any(scene, way)
    monkeypatch.setattr("glanz.engine.wavefront.film.np", SimpleNamespace(**{**vars(np), "isfinite": np.ones_like}))
    with pytest.raises(AssertionError):
        check_any(scene, way)
