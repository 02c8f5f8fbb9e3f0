"""What the engine's tests share: meshes with known shape, scenes with known answers, and honest statistics.

Every statistical test has the level ALPHA, with fixed seeds. A test states the smallest error that it would notice,
and is shown to notice one: by a mutant, a deliberately broken part put in by monkeypatch.
"""

import dataclasses
import math
from types import SimpleNamespace

import numpy as np
from scipy import stats

from glanz.engine import (
    Lambert,
    Material,
    Mesh,
    Object,
    PerspectiveCamera,
    Requirements,
    Scene,
    Settings,
    World,
    render_image,
)
from glanz.engine.arrays import columns
from glanz.engine.plan import Plan
from glanz.engine.rendering import render_plan
from glanz.engine.world.frame import Frame
from glanz.tests import chance

ALPHA = 1e-6
Z = stats.norm.isf(ALPHA / 2)
"""Two-sided standard deviations at ALPHA: 4.892."""
UNIT_FRAME = Frame(np.zeros(3), 1.0)
"""Render space that is world space."""


# Meshes

BOX_TRIANGLES = np.array(
    [[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6], [0, 6, 4], [1, 5, 7], [1, 7, 3]]
).T


def box(low=(0, 0, 0), high=(1, 1, 1), name="box"):
    """A closed box, faces outwards."""
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    low, high = np.array(low, float)[:, None], np.array(high, float)[:, None]
    return Mesh(name=name, vertices=low + np.array(corners, float).T * (high - low), triangles=BOX_TRIANGLES)


def quad(centre=(0, 0, 0), x=(1, 0, 0), y=(0, 1, 0), name="quad"):
    """A parallelogram with the full edges x and y; its front faces x cross y."""
    centre, x, y = (np.array(v, float) for v in (centre, x, y))
    vertices = np.stack([centre + (sx * x + sy * y) / 2 for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))], axis=1)
    return Mesh(name=name, vertices=vertices, triangles=np.array([[0, 1, 2], [0, 2, 3]]).T)


def icosphere(subdivisions=1, radius=1.0, centre=(0, 0, 0), smooth=False, name="icosphere"):
    """A closed sphere of 20 * 4^subdivisions triangles, faces outwards."""
    g = (1 + math.sqrt(5)) / 2
    points = [
        (-1, g, 0),
        (1, g, 0),
        (-1, -g, 0),
        (1, -g, 0),
        (0, -1, g),
        (0, 1, g),
        (0, -1, -g),
        (0, 1, -g),
        (g, 0, -1),
        (g, 0, 1),
        (-g, 0, -1),
        (-g, 0, 1),
    ]
    points = [np.array(p) / np.linalg.norm(p) for p in points]
    faces = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8)]
    faces += [(3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    for _ in range(subdivisions):
        middles, finer = {}, []

        def middle(a, b, middles=middles):
            key = (min(a, b), max(a, b))
            if key not in middles:
                m = points[a] + points[b]
                middles[key] = len(points)
                points.append(m / np.linalg.norm(m))
            return middles[key]

        for a, b, c in faces:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            finer += [(a, ab, ca), (b, bc, ab), (c, ca, bc), (ab, bc, ca)]
        faces = finer
    unit, triangles = np.array(points).T, np.array(faces).T
    normals = {"normals": unit, "normal_indices": triangles} if smooth else {}
    return Mesh(name=name, vertices=unit * radius + np.array(centre, float)[:, None], triangles=triangles, **normals)


def lambert(reflectance=0.5, name="diffuse", emission=0.0):
    """A material of one Lambert lobe; numbers stand for greys."""
    return Material(name=name, lobes=(Lambert(grey(reflectance)),) if np.any(reflectance) else (), emission=grey(emission))


def grey(value):
    """(r, g, b) from a number; colours stay."""
    return tuple(np.broadcast_to(np.asarray(value, float), 3).tolist())


def thing(mesh, material=None, matrix=None):
    """An `Object` named after its mesh."""
    return Object(name=mesh.name, mesh=mesh, materials=(material or lambert(),), world_from_object=np.eye(4) if matrix is None else matrix)


# Transforms


def rotation(seed):
    """A random rotation (3, 3)."""
    q, _ = np.linalg.qr(np.random.default_rng(seed).standard_normal((3, 3)))
    return q * np.sign(np.linalg.det(q))


def affine(linear=None, translation=(0, 0, 0)):
    """(4, 4) from a (3, 3) and a translation."""
    matrix = np.eye(4)
    matrix[:3, :3] = np.eye(3) if linear is None else linear
    matrix[:3, 3] = translation
    return matrix


def frame_towards(axis):
    """A rotation (3, 3) whose third column is the unit vector `axis`; for tests of what points along +z or -z."""
    axis = np.asarray(axis, float) / np.linalg.norm(axis)
    other = np.eye(3)[np.argmin(np.abs(axis))]
    x = np.cross(other, axis)
    x /= np.linalg.norm(x)
    return np.stack((x, np.cross(axis, x), axis), axis=1)


# Scenes and renders

FAST = {"width": 8, "height": 8, "samples": 4, "sampler": "stratified", "pixel_filter": "box", "threads": 1}


def settings(**changes):
    """Small settings: 8 x 8, 4 samples, box filter, one thread; stratified, by which tolerances are set, though others have less noise.

    In a `fresh` test of a thorough run there are more samples, with a seed of its own.
    """
    values = {"seed": 0, **FAST, **changes}
    return Settings(**values | {"seed": chance.seeded(values["seed"]), "samples": chance.times(values["samples"])})


def scene(objects=(), lights=(), camera=None, world=0.0, **others):
    """A `Scene` that looks from (3, -4, 2) at the origin unless told otherwise."""
    camera = camera or PerspectiveCamera.look_at((3, -4, 2), (0, 0, 0))
    return Scene(camera=camera, objects=objects, lights=lights, world=World(radiance=grey(world)), **others)


def pixels(scene_, settings_):
    """Radiance (3, H, W) float32 of a render that warns of nothing."""
    image = render_image(scene_, settings_)
    assert image.warnings == ()
    return np.moveaxis(image.passes["Combined"][..., :3], 2, 0)


def plan_of(scene_, settings_):
    """The `Plan` that `render` would make."""
    return Plan.of(scene_, settings_, Requirements.of(scene_, settings_))


def pixels_of_plan(plan):
    """Radiance (3, H, W) of a `Plan`, which a test may have changed by `dataclasses.replace`."""
    result = np.full((4, plan.settings.height, plan.settings.width), np.nan, np.float32)
    for progress in render_plan(plan):
        for tile in progress.tiles:
            result[:, tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = np.moveaxis(tile.passes["Combined"], 2, 0)
    return result[:3]


def receiver(lights=(), objects=(), point=(0, 0, 0), normal=(0, 0, 1), material=None, size=0.01, distance=1.0, tilt=0.0):
    """A scene that looks at a small diffuse patch (reflectance 1) at `point` from along its `normal`, tilted by `tilt` [rad].

    The pixels all see (very nearly) the one point, so their radiance times pi is its irradiance.
    """
    frame = frame_towards(normal)
    direction = frame @ (math.sin(tilt), 0, math.cos(tilt))
    eye = np.asarray(point, float) + distance * direction
    camera = PerspectiveCamera.look_at(eye, point, up=frame[:, 1], fov=1e-4 * size / distance)
    patch = thing(quad(point, size * frame[:, 0], size * frame[:, 1], name="patch"), material or lambert(1.0))
    return scene([patch, *objects], lights, camera)


# Numbers


def uniform(seed, n, dtype=np.float64):
    """u2 (2, n) in [0, 1)."""
    return np.random.default_rng(chance.seeded(seed)).random((2, n), dtype)


def stratified(seed, side, dtype=np.float64):
    """u2 (2, side * side), jittered in square cells: far less noise than `uniform` where no statistics is wanted."""
    cells = np.indices((side, side)).reshape(2, -1)
    return ((cells + np.random.default_rng(chance.seeded(seed)).random(cells.shape)) / side).astype(dtype)


def directions(seed, n, dtype=np.float64):
    """Uniform unit vectors (3, n)."""
    d = np.random.default_rng(chance.seeded(seed)).standard_normal((3, n))
    return (d / np.linalg.norm(d, axis=0)).astype(dtype)


def table(row, dtype=np.float64):
    """One row of parameters as `Columns`, in float64 unless told otherwise."""
    return columns([row], dtype)


def unit(*v, dtype=np.float64):
    """A unit vector (3, 1)."""
    v = np.array(v, np.float64).reshape(3, 1)
    return (v / np.linalg.norm(v)).astype(dtype)


def at_angle(theta, phi=0.0, dtype=np.float64):
    """Unit vector (3, 1) at the angle theta from +z."""
    return np.array([[math.sin(theta) * math.cos(phi)], [math.sin(theta) * math.sin(phi)], [math.cos(theta)]]).astype(dtype)


def dots(a, b):
    """Scalar products (N,) in float64."""
    return np.einsum("in,in->n", *np.broadcast_arrays(a.astype(np.float64), b.astype(np.float64)))


# Statistics


def mean_is(samples, truth, floor=0.0, absolute=0.0):
    """Whether independent `samples` (N,) have the mean `truth`, at level ALPHA; `floor` (relative) is rounding to forgive.

    Student's t. Written so that NaN fails.
    """
    samples = np.asarray(samples, np.float64).ravel()
    error = stats.sem(samples) * stats.t.isf(ALPHA / 2, samples.size - 1)
    return bool(abs(samples.mean() - truth) <= error + floor * abs(truth) + absolute)


def means_agree(a, b, floor=0.0):
    """Whether independent samples a and b have one mean: Welch's t at level ALPHA. That of nothing and nothing proves nothing: False."""
    a, b = np.asarray(a, np.float64).ravel(), np.asarray(b, np.float64).ravel()
    va, vb = a.var(ddof=1) / a.size, b.var(ddof=1) / b.size
    if va + vb == 0:
        return bool(a.any() and abs(a.mean() - b.mean()) <= floor * abs(a.mean()))
    freedom = (va + vb) ** 2 / (va**2 / (a.size - 1) + vb**2 / (b.size - 1))
    return bool(abs(a.mean() - b.mean()) <= stats.t.isf(ALPHA / 2, freedom) * math.sqrt(va + vb) + floor * abs(a.mean()))


def chi2_p(observed, expected, least=10.0):
    """p-value of counts against expectations; bins expecting less than `least` are pooled into one."""
    observed, expected = np.ravel(observed).astype(float), np.ravel(expected).astype(float)
    assert np.isfinite(expected).all()
    large = expected >= least
    o, e = observed[large], expected[large]
    if not large.all():
        o, e = np.append(o, observed[~large].sum()), np.append(e, expected[~large].sum())
        if e[-1] < least:  # what is left over is too little to be a bin of its own
            if o[-1] > 0 and stats.poisson.sf(o[-1] - 1, max(e[-1], 1e-300)) < ALPHA:
                return 0.0
            o, e = o[:-1], e[:-1]
    return float(stats.chi2.sf(((o - e) ** 2 / e).sum(), max(e.size - 1, 1)))


def same_bits(a, b):
    """Whether two arrays agree in dtype, shape and every bit, -0.0 and NaN included."""
    a, b = np.ascontiguousarray(a), np.ascontiguousarray(b)
    return a.dtype == b.dtype and a.shape == b.shape and a.tobytes() == b.tobytes()


def spy(monkeypatch, owner, name, calls=None):
    """Wrap a function or method so that calls are counted: returns a list that grows by (args, result)."""
    calls = [] if calls is None else calls
    original = getattr(owner, name)

    def wrapped(*args, **kwargs):
        result = original(*args, **kwargs)
        calls.append(SimpleNamespace(args=args, kwargs=kwargs, result=result))
        return result

    monkeypatch.setattr(owner, name, wrapped)
    return calls


def replaced(value, **changes):
    """`dataclasses.replace`, for brevity."""
    return dataclasses.replace(value, **changes)
