"""No light leaks where the shading normal disagrees with the geometry (catalogue C11)."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    BlinnPhong,
    Dielectric,
    Lambert,
    LambertTransmission,
    Material,
    Mirror,
    PerspectiveCamera,
    Phong,
    PhongLecture,
    PhongTransmission,
    PointLight,
)
from glanz.engine.constants import EPS32
from glanz.engine.maths.frames import to_world
from glanz.engine.maths.vectors import dot
from glanz.engine.registry import BSDFS
from glanz.engine.world.interaction import leave_on_either_side
from glanz.engine.world.materials import Materials, Reflection, TwoSided
from glanz.tests import chance, helpers as h

N = 100_000
STEEPEST = math.radians(85)
LOBES = {
    "lambert": (Lambert((0.8,) * 3),),
    "phong": (Phong((0.8,) * 3, 3.0),),
    "phong_lecture": (PhongLecture((0.7,) * 3, 3.0),),
    "blinn_phong": (BlinnPhong((0.8,) * 3, 3.0),),
    "mixed": (Lambert((0.4,) * 3), Phong((0.5,) * 3, 50.0)),
    "mirror": (Mirror((0.8,) * 3),),
    "polished": (Lambert((0.4,) * 3), Mirror((0.5,) * 3)),
    "paper": (LambertTransmission((0.8,) * 3),),
    "satin": (Lambert((0.2,) * 3), PhongTransmission((0.3,) * 3, 3.0), LambertTransmission((0.3,) * 3)),
}
OPAQUE = {name: lobes for name, lobes in LOBES.items() if not any(lobe.transmits for lobe in lobes)}


def reflection(lobes):
    bsdfs = tuple(b for b in BSDFS.values() if any(type(lobe) is b for lobe in lobes))
    return Materials.of([Material(name="m", lobes=lobes)], bsdfs).at(np.zeros(1, np.intp))


def surfaces(seed, grazing=None):
    """N points with shading normals up to 85 degrees off; viewers anywhere above the geometric surface, or that near to it."""
    rng = np.random.default_rng(seed)
    n = h.directions(seed, N)
    tilt, sin = rng.uniform(0, STEEPEST, N), rng.uniform(-np.pi, np.pi, N)
    ns = to_world(n, np.stack((np.sin(tilt) * np.cos(sin), np.sin(tilt) * np.sin(sin), np.cos(tilt))))
    z = rng.random(N) if grazing is None else np.full(N, grazing)
    across = np.sqrt(1 - z * z)
    azimuth = rng.uniform(-np.pi, np.pi, N)
    wo = to_world(n, np.stack((across * np.cos(azimuth), across * np.sin(azimuth), z)))
    n, ns, wo = (a.astype(np.float32) for a in (n, ns, wo))
    # As `interact` has it, after rounding.
    n *= np.copysign(np.float32(1), dot(n, wo))
    return SimpleNamespace(n=n, ns=ns, wo=wo, is_front=np.ones(N, bool))


def check_nothing_comes_from_below(lobes, grazing):
    """Neither scattered rays nor shadow rays have light below the geometric surface; what passes a sheet has none above."""
    surface, lobes = surfaces(1, grazing), reflection(lobes)
    u = np.random.default_rng(2).random((3, N), np.float32)
    with np.errstate(all="ignore"):
        wi, weight, _ = lobes.scatter(surface, u[0], u[1:])
        arriving = h.directions(3, N, np.float32)
        f, _ = lobes.eval(surface.ns, surface.wo, arriving) if lobes.rough else (np.zeros((3, 1), np.float32), 0)
        received = f * lobes.cosine(surface, arriving)
    assert np.isfinite(wi).all()
    # What is not a number ends a path as 0 does, and there is nothing that is.
    assert not np.isnan(received).any()
    assert (received >= 0).all()
    for w, light in ((wi, weight), (arriving, received)):
        is_lit = (light > 0).any(axis=0)
        assert is_lit.any() or w is arriving
        geometric, shading = dot(surface.n, w), dot(surface.ns, w)
        if isinstance(lobes, TwoSided):
            assert (geometric * shading > 0)[is_lit].all()
        else:
            # A mirror has nowhere else to send light that is as grazing as directions are round.
            assert (geometric > (-4 * EPS32 if lobes.specular else 0))[is_lit].all()
            assert (shading > 0)[is_lit].all() or lobes.specular


@pytest.mark.parametrize("grazing", [None, 1e-3, 1e-5, 1e-7])
@pytest.mark.parametrize("name", LOBES)
def test_nothing_comes_from_below(name, grazing):
    """C11 over 1e5 shading normals up to 85 degrees off, seen from anywhere and from near grazing."""
    check_nothing_comes_from_below(LOBES[name], grazing)


@pytest.mark.parametrize("name", ["lambert", "mixed"])
def test_below_catches_the_shading_normal_alone(monkeypatch, name):
    monkeypatch.setattr(Reflection, "cosine", lambda self, surface, wi: np.maximum(dot(surface.ns, wi), 0))
    with pytest.raises(AssertionError):
        check_nothing_comes_from_below(LOBES[name], None)


def test_below_catches_a_sheet_that_goes_by_the_shading_normal_alone(monkeypatch):
    monkeypatch.setattr(TwoSided, "cosine", lambda self, surface, wi: np.abs(dot(surface.ns, wi)))
    with pytest.raises(AssertionError):
        check_nothing_comes_from_below(LOBES["paper"], None)


def crooked(mesh, seed=1):
    """`mesh` with a random normal at each corner of each triangle, up to 85 degrees from that of the triangle."""
    rng = np.random.default_rng(chance.seeded(seed))
    a, b, c = mesh.vertices[:, mesh.triangles].transpose(1, 0, 2)
    face = np.cross((b - a).T, (c - a).T).T
    face = np.repeat(face / np.linalg.norm(face, axis=0), 3, axis=1)
    tilt, azimuth = rng.uniform(0, STEEPEST, face.shape[1]), rng.uniform(-np.pi, np.pi, face.shape[1])
    normals = to_world(face, np.stack((np.sin(tilt) * np.cos(azimuth), np.sin(tilt) * np.sin(azimuth), np.cos(tilt))))
    return h.replaced(mesh, normals=normals, normal_indices=np.arange(face.shape[1]).reshape(-1, 3).T)


LIGHTS_AROUND = [PointLight(position=p, intensity=(9.0,) * 3) for p in ((3, 2, 4), (-3, 1, 2), (0.4, -2, -3))]
INSIDE = PerspectiveCamera.look_at((0.3, 0.4, 0.5), (0.9, 0.8, 0.2), fov=1.5)
OUTSIDE = PerspectiveCamera.look_at((3, -4, 2), (0.5, 0.5, 0.5))
DARKENED = h.settings(width=16, height=16, samples=16, max_depth=3)


@pytest.mark.parametrize("integrator", ["path", "path_blind", "path_naive", "distributed", "whitted", "whitted_phong"])
@pytest.mark.parametrize("name", OPAQUE)
@chance.fresh
def test_a_closed_box_stays_dark(name, integrator):
    """Lights and a bright world outside of an opaque box with senseless normals, the camera inside: exactly nothing is seen."""
    panel = AreaLight(world_from_light=h.affine(translation=(0.5, 0.5, 3)))
    scene = h.scene([h.thing(crooked(h.box()), Material(name=name, lobes=OPAQUE[name]))], [*LIGHTS_AROUND, panel], INSIDE, world=1.0)
    settings = h.replaced(DARKENED, integrator=integrator, samples=1 if integrator == "distributed" else 16)
    with np.errstate(all="ignore"):
        image = h.pixels_of_plan(h.plan_of(scene, settings))
    assert not image.any()


@pytest.mark.parametrize("name", OPAQUE)
@chance.fresh
def test_no_light_gets_out_of_a_closed_box(name):
    """The camera outside, all light inside: only the floor, which nothing lights, and the box are there to be seen."""
    light = PointLight(position=(0.4, 0.6, 0.7), intensity=(9.0,) * 3)
    floor = h.thing(h.quad((0, 0, -0.1), (9, 0, 0), (0, 9, 0), name="floor"))
    scene = h.scene([h.thing(crooked(h.box()), Material(name=name, lobes=OPAQUE[name])), floor], [light], OUTSIDE)
    assert not h.pixels(scene, DARKENED).any()


def test_glass_with_senseless_normals_makes_no_light():
    """In white light all that glass sends on is white, wherever its normals send it; detects 2 %."""
    glass = h.thing(crooked(h.box()), Material(name="glass", lobes=(Dielectric(1.5),)))
    image = h.pixels(h.scene([glass], camera=OUTSIDE, world=1.0), h.replaced(DARKENED, samples=64, max_depth=200))
    assert h.mean_is(image[0], 1.0, floor=1e-3)


def test_the_box_catches_rays_that_pass_where_the_shading_normal_allows(monkeypatch):
    """The mutant goes by the shading normal alone, and lets rays start on the side that they go to."""
    scene = h.scene([h.thing(crooked(h.box()), h.lambert(0.8))], LIGHTS_AROUND, INSIDE, world=1.0)
    plan = h.plan_of(scene, DARKENED)
    assert not h.pixels_of_plan(plan).any()
    monkeypatch.setattr(Reflection, "cosine", lambda self, surface, wi: np.maximum(dot(surface.ns, wi), 0))
    assert h.pixels_of_plan(h.replaced(plan, leave=leave_on_either_side)).mean() > 0.05
