"""Scenes and settings of every kind that there is, at and beyond every limit, for Hypothesis to draw.

All plug-ins of the registries take part; one with a parameter of a new name fails here until the parameter has values to draw.
"""

import dataclasses
import math

import numpy as np
from hypothesis import strategies as st

from glanz.engine import (
    FILTERS,
    INTEGRATORS,
    PASSES,
    RAY_KINDS,
    SAMPLERS,
    TEXTURES,
    AreaLight,
    CosineSpotLight,
    EnvironmentMap,
    Lens,
    Material,
    Medium,
    Mesh,
    MeshAttribute,
    Mist,
    Object,
    OrthographicCamera,
    PanoramaCamera,
    PerspectiveCamera,
    PointLight,
    Scene,
    SceneError,
    Settings,
    Shade,
    SpotLight,
    SunLight,
    World,
)
from glanz.engine.registry import BSDFS
from glanz.engine.scene.settings import PRECISIONS
from glanz.tests import helpers as h

flags = st.booleans()
sizes = st.sampled_from((0.0, 1e-38, 1e-30, 1e-12, 1e-6, 1e-3, 0.5, 1.0, 3.0, 1e3, 1e6, 1e12, 1e20))
coordinates = st.one_of(st.floats(-2, 2), st.sampled_from((0.0, -0.0, 1e-38, 1e-30, 1e-6, -1e6, 1e12)))
beyond = st.sampled_from((math.nan, math.inf, -math.inf, 1e19, -1e38, 3e38, 1e300))
odd = st.one_of(coordinates, beyond)
powers = st.sampled_from((0.0, 1e-38, 1e-30, 1e-6, 1.0, 100.0, 1e6, 1e30, 3e38))
shares = st.sampled_from((0.0, 1e-30, 1e-6, 0.3, 0.5))
numbers = st.one_of(st.floats(-2, 2), st.sampled_from((0.0, 1.0, -1.0, 1e-38, 1e-6, 1e6, -1e12, 3e38)))


def threes(part):
    return st.tuples(part, part, part)


def rarely(usual, unusual):
    """One of ten is `unusual`: enough of them together would leave nothing to be rendered."""
    return st.integers(0, 9).flatmap(lambda n: unusual if n == 9 else usual)


points, colours, reflectances = threes(coordinates), threes(powers), threes(shares)
hidings = rarely(st.just(()), st.lists(st.sampled_from(RAY_KINDS), unique=True))
groups = st.sampled_from(("", "key"))


# Textures


def _texture(kind):
    """Every number, vector and flag of a kind of texture, which may be textures again where it lets them."""
    drawn = {}
    for part in dataclasses.fields(kind):
        default = part.default
        if isinstance(default, bool):
            drawn[part.name] = flags
        elif isinstance(default, float):
            drawn[part.name] = rarely(st.just(default), numbers)
        elif isinstance(default, tuple) and len(default) == 3:
            drawn[part.name] = rarely(st.just(default), threes(numbers))
    return st.builds(kind, **drawn)


_KINDS = [kind for kind in TEXTURES.values() if all(f.default is not dataclasses.MISSING for f in dataclasses.fields(kind))]
textures = st.sampled_from(_KINDS).flatmap(_texture)


# Materials

PARAMETERS = {
    "reflectance": rarely(reflectances, textures),
    "transmittance": rarely(reflectances, textures),
    "exponent": st.sampled_from((0.0, 1e-6, 0.5, 1.0, 30.0, 1e3, 1e6)),
    "ior": st.sampled_from((1e-3, 0.9, 1.0, 1.0000001, 1.5, 2.42, 1e3)),
    "eta": st.sampled_from((1e-3, 0.9, 1.0, 1.0000001, 1.5, 2.42, 1e3)),
    "roughness": st.sampled_from((0.0, 1e-30, 1e-6, 0.5, 1.0)),
    "again": threes(st.sampled_from((0.0, 1e-30, 0.5, 1.0))),
    "is_fresnel": flags,
    "abbe": st.sampled_from((1.0, 30.0, 1e6, math.inf)),
    "etendue": st.sampled_from((1.0, 0.5)),
}
lobes = st.one_of(*(st.builds(kind, **{f.name: PARAMETERS[f.name] for f in dataclasses.fields(kind)}) for kind in BSDFS.values()))
media = st.builds(
    Medium, absorption=threes(st.sampled_from((0.0, 1e-30, 1.0, 1e30, math.inf))), priority=st.sampled_from((0, 1, -1, 2**31))
)
materials = st.builds(
    Material,
    name=st.just("material"),
    lobes=st.lists(lobes, max_size=2),
    emission=st.one_of(st.just((0.0, 0.0, 0.0)), rarely(colours, textures)),
    ambient=reflectances,
    alpha=st.one_of(st.just(1.0), shares, textures),
    medium=st.one_of(st.none(), media),
    relief=rarely(st.just(()), st.tuples(textures)),
    index=rarely(st.just(0.0), odd),
    aovs=st.one_of(st.just(()), st.tuples(st.tuples(st.just("key"), st.one_of(numbers, colours, textures)))),
    holdout=rarely(st.just((0.0, 0.0, 0.0)), threes(shares)),
)


# Meshes and objects


@st.composite
def matrices(draw):
    """Rotations, scales, mirrors and flat ones; at times with a number that is none."""
    linear = h.rotation(draw(st.integers(0, 5))) @ np.diag([draw(sizes) * draw(st.sampled_from((1, -1))) for _ in range(3)])
    matrix = h.affine(linear, [draw(coordinates) for _ in range(3)])
    if draw(rarely(st.just(False), flags)):
        matrix[draw(st.integers(0, 2)), draw(st.integers(0, 3))] = draw(beyond)
    return matrix


@st.composite
def motions(draw):
    """None mostly, as what moves differs little from what does not where it breaks."""
    keys = draw(rarely(st.just(0), st.integers(1, 4)))
    return np.array([draw(matrices()) for _ in range(keys)]).reshape(-1, 4, 4)


@st.composite
def extras(draw, vertices, triangles):
    """Texture coordinates, attributes, material indices and shapes over time for a mesh, each at times."""
    count, found = vertices.shape[1], {}
    corners = triangles.clip(0, max(count - 1, 0))
    if draw(flags):
        found |= {"uv_layers": ("UV",), "uvs": [[[draw(odd) for _ in range(count)] for _ in range(2)]], "uv_indices": corners}
    if draw(flags):
        found["material_indices"] = [draw(st.sampled_from((0, 1, 2**31 - 1))) for _ in range(triangles.shape[1])]
    if draw(rarely(st.just(False), flags)):
        found["attributes"] = (MeshAttribute(name="key", values=[[draw(odd) for _ in range(count)]]),)
    if draw(rarely(st.just(False), flags)):
        with np.errstate(all="ignore"):
            found["shapes"] = np.array([vertices, vertices * draw(st.sampled_from((0.0, -1.0, 1.5, 1e30)))])
    return found


@st.composite
def meshes(draw):
    kind = draw(st.sampled_from(("quad", "box", "flat sphere", "smooth sphere", *KINDS, "one point", "empty")))
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
    if kind == "twice the same triangles":
        triangles = np.concatenate((triangles, triangles[:, ::-1], triangles[::-1]), axis=1)
    if kind == "triangles in a line":
        vertices = np.outer(vertices[:, 0], np.arange(6.0))
    if kind.endswith("e38"):
        with np.errstate(all="ignore"):
            vertices = vertices * float(kind.split()[-1])
    if kind == "triangles out of range":
        triangles[draw(st.integers(0, 2)), draw(st.integers(0, 3))] = draw(st.sampled_from((-1, 6, -(2**31), 2**31 - 1, 2**40)))
    others = draw(extras(vertices, triangles))
    if draw(flags):
        return Mesh(name=kind, vertices=vertices, triangles=triangles, **others)
    normals = np.array([[draw(number) for _ in range(6)] for _ in range(3)])
    return Mesh(name=kind, vertices=vertices, triangles=triangles, normals=normals, normal_indices=triangles, **others)


KINDS = (
    "triangles",
    "odd triangles",
    "twice the same triangles",
    "triangles in a line",
    "triangles by 1e38",
    "triangles by 1e-38",
    "triangles out of range",
)
objects = st.builds(
    Object,
    name=st.just("object"),
    mesh=meshes(),
    world_from_object=matrices(),
    materials=st.lists(materials, max_size=2),
    motion=motions(),
    group=groups,
    hidden_from=hidings,
    values=st.one_of(st.just(()), st.tuples(st.tuples(st.just("location"), st.tuples(odd, odd, odd, odd)))),
)


# Lights, the world, cameras

towards = rarely(
    st.integers(0, 5).map(lambda seed: tuple(h.directions(seed, 1)[:, 0].tolist())), st.sampled_from(((0.0, 0.0, 0.0), (math.nan, 0, 1)))
)
common = {
    "is_visible": flags,
    "group": groups,
    "hidden_from": hidings,
    "shade": rarely(st.none(), st.builds(Shade, texture=textures, world_from_light=matrices())),
}
bulbs = {"intensity": colours, "radius": sizes, "soft_falloff": flags, **common}
angles = st.sampled_from((1e-6, 0.01, 1.0, math.pi))
lights = st.one_of(
    st.builds(PointLight, position=points, **bulbs),
    st.builds(SpotLight, world_from_light=matrices(), angle=angles, blend=st.sampled_from((0.0, 0.15, 1.0)), **bulbs),
    st.builds(CosineSpotLight, world_from_light=matrices(), exponent=PARAMETERS["exponent"], **bulbs),
    st.builds(SunLight, towards=towards, irradiance=colours, angle=st.one_of(st.just(0.0), angles), **common),
    st.builds(
        AreaLight,
        world_from_light=matrices(),
        size_x=sizes,
        size_y=sizes,
        is_ellipse=flags,
        radiance=colours,
        spread=angles,
        **common,
    ),
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
mists = st.builds(Mist, start=numbers, depth=sizes, falloff=st.sampled_from(("linear", "quadratic", "inverse_quadratic")))
skies = {"mist": mists, "group": groups, "hidden_from": hidings, "occlusion_distance": st.one_of(sizes, st.just(math.inf))}
worlds = st.one_of(
    st.builds(World, radiance=st.one_of(st.just((0.0, 0.0, 0.0)), colours), environment=st.one_of(st.none(), environments), **skies),
    st.builds(World, radiance=textures, **skies),
)
lenses = st.builds(
    Lens,
    radius=st.sampled_from((0.0, 1e-30, 0.1, 1e6)),
    focus_distance=st.sampled_from((1e-30, 1e-6, 3.0, 1e30, math.inf)),
    blades=st.sampled_from((0, 3, 7)),
    rotation=st.floats(-4, 4),
    ratio=st.sampled_from((1e-6, 0.5, 1.0, 1e6)),
)
views = {
    "lens": st.one_of(st.just(Lens()), lenses),
    "motion": motions(),
    "clip_start": st.sampled_from((0.0, 1e-30, 0.1, 3.0)),
    "clip_end": st.sampled_from((math.inf, 1e30, 4.0)),
}


@st.composite
def cameras(draw):
    turned, zoom = h.rotation(draw(st.integers(0, 5))), draw(st.sampled_from((1e-9, 0.3, 1.0, 100.0)))
    place = np.array(draw(points)) + draw(st.sampled_from((0.0, 1e-6, 1.0, 4.0, 1e6))) * turned[:, 2]
    matrix = h.affine(turned, place)
    kind = draw(st.sampled_from((PerspectiveCamera, PerspectiveCamera, OrthographicCamera, PanoramaCamera)))
    if kind is PanoramaCamera:
        return draw(st.builds(kind, world_from_camera=st.just(matrix), longitude=st.just((-math.pi * zoom, math.pi * zoom)), **views))
    return draw(st.builds(kind, world_from_camera=st.just(matrix), window=st.just((-zoom, zoom, -zoom, zoom)), **views))


scenes = st.builds(
    Scene,
    camera=rarely(cameras(), st.builds(PerspectiveCamera, world_from_camera=matrices())),
    objects=st.lists(objects, max_size=4),
    lights=st.lists(lights, max_size=3),
    world=worlds,
)


# Settings

PASS_NAMES = (*PASSES, "AOV Color key", "AOV Value key", "CryptoObject00", "CryptoMaterial00", "CryptoAsset00", "Combined_key")
sides = st.sampled_from((1, 2, 7, 8))


@st.composite
def ways(draw):
    """Settings whose every path is short enough to be waited for, whatever the scene: no tree of rays is both wide and deep."""
    width, height, samples = draw(sides), draw(sides), draw(st.sampled_from((1, 2, 5)))
    integrator = draw(st.sampled_from(tuple(INTEGRATORS)))
    is_tree = INTEGRATORS[integrator].splits_specular or integrator == "distributed"
    changes = {}
    if draw(rarely(st.just(False), flags)):
        x0, y0 = draw(st.integers(0, width - 1)), draw(st.integers(0, height - 1))
        changes["border"] = (x0, y0, draw(st.integers(x0 + 1, width)), draw(st.integers(y0 + 1, height)))
    kind = draw(st.sampled_from(("plain", "plain", "part", "target", "adaptive", "limit")))
    if kind == "part" and samples > 1:
        changes["sample_range"] = (1, samples)
    if kind == "target":
        changes |= {"samples": 64, "error_target": draw(st.sampled_from((1e-6, 0.1, 1e6)))}
        changes["error_measure"] = draw(st.sampled_from(("relative", "lightness")))
        changes |= {"adaptive_sampling": draw(flags), "replicates": draw(st.sampled_from((0, 2, 64)))}
    if kind == "adaptive":
        changes |= {"adaptive_threshold": draw(st.sampled_from((1e-6, 0.1, 1.0))), "adaptive_levels": draw(st.integers(1, 2))}
    if kind == "limit":
        changes["time_limit"] = draw(st.sampled_from((1e-6, 0.01)))
    return Settings(
        **{
            "width": width,
            "height": height,
            "samples": samples,
            "integrator": integrator,
            "max_depth": draw(st.sampled_from((0, 1, 3) if is_tree else (0, 1, 3, 1000))),
            "max_transparent": draw(st.sampled_from((0, 1, 64))),
            "branches": draw(st.sampled_from((1, 4))),
            "min_contribution": draw(st.sampled_from((0.0, 1e-6, 0.5, 1.0))),
            "light_falloff": draw(flags),
            "sampler": draw(st.sampled_from(tuple(SAMPLERS))),
            "pixel_filter": draw(st.sampled_from(tuple(FILTERS))),
            "filter_width": draw(st.sampled_from((1e-6, 1.5, 10.0))),
            "filter_textures": draw(flags),
            "film_transparent": draw(flags),
            "passes": ("Combined", "Normal", *draw(st.lists(st.sampled_from(PASS_NAMES[2:]), max_size=6, unique=True))),
            "seed": draw(st.sampled_from((-1, 0, 1, 2**31 - 1, -(2**63), 2**80))),
            "tile_size": draw(st.sampled_from((0, 1, 3, 64))),
            "threads": draw(st.sampled_from((1, 1, 1, 3))),
            "motion_steps": draw(st.sampled_from((1, 3))),
            "precision": draw(st.sampled_from(tuple(PRECISIONS))),
            "clamp_direct": draw(rarely(st.just(0.0), st.sampled_from((1e-30, 1.0, 1e30)))),
            "clamp_indirect": draw(rarely(st.just(0.0), st.sampled_from((1e-30, 1.0, 1e30)))),
            **changes,
        }
    )


@st.composite
def cases(draw):
    """(scene, settings), or the SceneError by which making one of their parts was refused."""
    try:
        return draw(scenes), draw(ways())
    except SceneError as error:
        return error
