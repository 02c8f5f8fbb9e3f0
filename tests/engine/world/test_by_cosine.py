"""Tables by the cosine, against the textures that they stand for."""

from types import SimpleNamespace

import numpy as np
import pytest

from glanz.engine import (
    ColourRamp,
    Coordinates,
    Fresnel,
    Geometry,
    GgxAlbedo,
    GlassTint,
    Gloss,
    GradientTexture,
    Lambert,
    LayerWeight,
    LightPath,
    LinearTexture,
    LobeExponent,
    Material,
    Mirror,
    NormalMap,
    RelativeIndex,
    RoughRefraction,
    Transparent,
)
from glanz.engine.maths.vectors import dot
from glanz.engine.registry import BSDFS
from glanz.engine.scene.points import Points
from glanz.engine.world import by_cosine, compile
from glanz.engine.world.filling import filled_in
from glanz.engine.world.materials import Materials
from glanz.tests import helpers as h, textured as t

N = 4096
WHITE = (1.0, 1.0, 1.0)
INDEX = RelativeIndex(1.5)
COAT, METAL, SHARE = GgxAlbedo(0.3, 1.5, kind="dielectric"), GgxAlbedo(0.1, f0=(0.9, 0.5, 0.1)), GgxAlbedo(0.4, INDEX, kind="boundary")
TINT = GlassTint((0.4, 0.9, 1.0), 0.4, INDEX)
RIM = LayerWeight(0.5)
LOBES = {
    "coat": (Gloss(COAT, 60.0), Lambert(LinearTexture((COAT,), ((-0.8, -0.2, -0.5),), (0.8, 0.2, 0.5)))),
    "metal": (Gloss(METAL, 1e4),),
    "mirror": (Mirror(METAL), Lambert(LinearTexture((METAL,), (-0.2,), 0.2))),
    "glass": (
        Gloss(LinearTexture((SHARE,), (TINT,)), LobeExponent(0.4)),
        RoughRefraction(LinearTexture((SHARE, TINT), (LinearTexture((TINT,), (-1.0,)), 1.0)), LobeExponent(0.4, INDEX), INDEX),
    ),
    "sides": (Lambert(Geometry("backfacing")), Gloss(LinearTexture((Geometry("backfacing"),), (-0.5,), 0.5), 8.0)),
}
LIMITED = {
    "too bright": (Lambert(LinearTexture((RIM,), (1.5,))), Lambert((0.3,) * 3)),
    "beside a veil": (Lambert(LinearTexture((RIM,), (0.7,))), Transparent((0.4,) * 3)),
}
EDGE = ColourRamp(RIM, np.float32([[0.1, 0.9]]), is_smooth=False)
OTHERS = {
    "a place": LinearTexture((RIM,), (GradientTexture("linear", Coordinates()),)),
    "a direction": Geometry("incoming"),
    "another normal": LayerWeight(0.5, normal=(0.0, 0.0, 1.0)),
    "the past": LightPath("depth"),
    "an edge": EDGE,
    "total reflection": Fresnel(1.45),
}


class Seen(Points):
    """N places of random normals, seen from either side at cosines that are random, too, as many near the horizon as elsewhere."""

    count = N

    def __init__(self, row, seed=1):
        super().__init__()
        rng = np.random.default_rng(seed)
        cos, angle = rng.random(N) ** rng.choice((1, 6), N), 2 * np.pi * rng.random(N)
        sin = np.sqrt(1 - cos * cos)
        turn = h.rotation(seed)
        wo = (turn @ np.stack((sin * np.cos(angle), sin * np.sin(angle), cos))).astype(np.float32)
        ns = np.repeat(turn[:, 2:].astype(np.float32), N, axis=1)
        self.d = -wo
        self.surface = SimpleNamespace(n=ns, ns=ns, wo=wo, is_front=rng.random(N) < 0.5, material=np.full(N, row))


def compiled(lobes, **others):
    """One material beside a grey one."""
    return Materials.of([Material(name="grey", lobes=(Lambert((0.5,) * 3),)), Material(name="m", lobes=lobes, **others)], BSDFS.values())


def parts(reflection):
    """What the lobes are at each of N points (C, N), and their probabilities (L, N)."""
    lobes = (*reflection.rough, *reflection.specular)
    rows = [np.broadcast_to(column, (3, N)) for lobe in lobes for column in vars(lobe.k).values()]
    return np.concatenate(rows), reflection.shares


def most_off(materials):
    """How far a table is off: parameters, in parts of what is at least 0.1; and the probabilities."""
    table, left = by_cosine.tabulated(materials)
    assert table and not left.textured
    at = Seen(1)
    expected = filled_in(materials, materials.at(at.surface), N, [(1, np.arange(N), at)])
    (found, found_shares), (wanted, wanted_shares) = parts(table.at(at.surface)), parts(expected)
    return (np.abs(found - wanted) / np.maximum(np.abs(wanted), 0.1)).max(), np.abs(found_shares - wanted_shares).max()


@pytest.mark.parametrize("lobes", LOBES.values(), ids=LOBES)
def test_tables_are_the_textures_that_they_stand_for(lobes):
    """To 3e-5 of what they are, and the probabilities of lobes to 1e-3."""
    parameters, shares = most_off(compiled(lobes))
    assert parameters <= 3e-5
    assert shares <= 1e-3


@pytest.mark.parametrize("lobes", LIMITED.values(), ids=LIMITED)
def test_tables_have_the_bend_where_the_limit_of_light_sets_in(lobes):
    """To twice what is allowed half-way between the entries."""
    assert max(most_off(compiled(lobes))) <= 2 * by_cosine._TOLERANCE


def test_an_edge_that_a_table_would_blur_is_found_by_the_comparison(monkeypatch):
    monkeypatch.setattr(by_cosine, "_is_met", lambda values: True)
    assert most_off(compiled((Lambert(EDGE),)))[0] > 0.1


def test_a_table_of_the_cosine_itself_is_found_by_the_comparison(monkeypatch):
    """The mutant whose entries are at even steps of the cosine is off where layers change most, at the horizon."""
    monkeypatch.setattr(by_cosine, "dot", lambda a, b: np.square(dot(a, b)))
    assert most_off(compiled(LOBES["coat"]))[0] > 1e-2


@pytest.mark.parametrize("texture", OTHERS.values(), ids=OTHERS)
def test_what_asks_for_more_than_the_cosine_keeps_its_textures(texture):
    materials = compiled((Lambert(texture),))
    assert by_cosine.tabulated(materials) == (None, materials)


def test_what_is_bent_keeps_its_textures():
    materials = compiled(LOBES["coat"], relief=(Geometry("normal"),))
    assert by_cosine.tabulated(materials) == (None, materials)


def test_a_material_without_textures_keeps_every_bit_beside_one_with_a_table():
    materials, at = compiled(LOBES["coat"]), Seen(0)
    table, _ = by_cosine.tabulated(materials)
    for found, wanted in zip(parts(table.at(at.surface)), parts(materials.at(at.surface))):
        assert h.same_bits(found, np.ascontiguousarray(wanted))


def test_directions_that_are_no_numbers_leave_no_table():
    table, _ = by_cosine.tabulated(compiled(LOBES["coat"]))
    at = Seen(1)
    at.surface.wo[:, :3] = np.float32([np.nan, np.inf, 1e30])
    with np.errstate(invalid="ignore"):
        found, _ = parts(table.at(at.surface))
    assert np.isfinite(found[:, 3:]).all()


def test_a_picture_by_tables_is_that_by_textures(monkeypatch):
    """Beside a bent material and one with places, which keep theirs. The same numbers choose the same lobes but for a few."""
    shell = Material(name="shell", lobes=LOBES["coat"])
    ridged = h.replaced(shell, name="ridged", relief=(NormalMap((0.7, 0.4, 0.9), space="world"),))
    balls = [h.thing(h.icosphere(3, 0.4, (x, 0, 0.5), smooth=True), m) for x, m in ((-0.5, shell), (0.5, ridged))]
    floor = t.facing(h.quad(), Material(name="floor", lobes=(Lambert(t.CHECKERED),)), world=1.0)
    scene = h.replaced(floor, objects=(*floor.objects, *balls))
    settings = h.settings(width=24, height=16, samples=4, max_depth=3)
    found = h.pixels(scene, settings)
    assert h.plan_of(scene, settings).world.by_cosine
    monkeypatch.setattr(compile, "tabulated", lambda materials, sharing: (None, materials))
    assert h.plan_of(scene, settings).world.by_cosine is None
    wanted = h.pixels(scene, settings)
    assert np.mean(np.abs(found - wanted) <= 1e-4 * wanted.max()) >= 0.98
    assert found.mean() == pytest.approx(wanted.mean(), rel=1e-3)
