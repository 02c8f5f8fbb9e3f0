"""What is hidden from a kind of rays is not there for them, and for no others; what is held out the camera sees as clear and black."""

from types import SimpleNamespace

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    Coordinates,
    EnvironmentMap,
    Lambert,
    LambertTransmission,
    LinearTexture,
    Material,
    Mirror,
    Object,
    OrthographicCamera,
    Phong,
    PointLight,
    SceneError,
    SunLight,
    Transparent,
    World,
)
from glanz.engine.scene.visibility import RAY_KINDS
from glanz.engine.wavefront import holdouts, sights
from glanz.engine.world.materials import Reflection
from glanz.tests import helpers as h
from glanz.tests.renders.test_clear_film import HALF, card, seen
from glanz.tests.renders.test_costs import SETTINGS, entered, plain

GLOW = h.lambert(0.0, "glow", 4.0)
BULB = PointLight(position=(0.0, 0.0, 2.0), intensity=(4.0,) * 3)
VEIL = Material(name="veil", lobes=(Transparent(HALF),))
HELD = Material(name="held", holdout=(1.0,) * 3)


def hidden(o, *kinds):
    return h.replaced(o, hidden_from=kinds)


def radiance(objects, world=1.0, **changes):
    """The mean of the picture of `objects`; opaque."""
    return seen(objects, world, film_transparent=False, **changes)["Combined"][0]


def pushed(o):
    """`o`, which moves sideways within itself."""
    keys = np.stack([o.world_from_object] * 2)
    keys[1, 0, 3] += 0.25
    return h.replaced(o, motion=keys)


@pytest.mark.parametrize("moved", [lambda o: o, pushed], ids=["still", "moving"])
@pytest.mark.parametrize("kind", RAY_KINDS)
@pytest.mark.parametrize(
    ("asks", "floor", "shown", "gone"),
    [
        # What the floor, or the camera, shows of a glowing sheet overhead or below, and of the world without it.
        ("camera", None, 4.0, 1.0),
        ("diffuse", h.lambert(0.5), 2.0, 0.5),
        ("glossy", Material(name="m", lobes=(Mirror(HALF),)), 2.0, 0.5),
        ("transmission", Material(name="t", lobes=(LambertTransmission(HALF),)), 2.0, 0.5),
    ],
)
def test_each_kind_of_rays_does_not_see_what_is_hidden_from_it(asks, floor, shown, gone, kind, moved):
    """A sheet that is far larger than high, above the camera or below the floor: path_blind finds it by scattered rays alone."""
    z = -1e-3 if floor is None or asks == "transmission" else 6.0
    sheet = hidden(moved(h.thing(h.quad((0, 0, z), (4e4, 0, 0), (0, 4e4, 0), name="sheet"), GLOW)), kind)
    below = () if floor is None else (h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0), name="floor"), floor),)
    objects = (*below, sheet)
    found = radiance(objects, integrator="path_blind", max_depth=3, samples=4)
    np.testing.assert_allclose(found, gone if asks == kind else shown, rtol=2e-3)


@pytest.mark.parametrize("veils", [(), (VEIL,)], ids=["plain", "under a veil"])
@pytest.mark.parametrize("integrator", ["path", "whitted"])
def test_only_shadow_rays_decide_about_shadows(integrator, veils):
    """I / (pi h^2) albedo in front of the middle, by half as much under a veil."""

    def lit(*kinds):
        shade = hidden(h.thing(h.quad((0, 0, 1), (8, 0, 0), (0, 8, 0), name="shade"), h.lambert(0.5)), *kinds)
        above = [h.thing(h.quad((0, 0, 1.5), (8, 0, 0), (0, 8, 0), name="veil"), veil) for veil in veils]
        scene = h.receiver([BULB], [shade, *above], distance=0.3, tilt=0.5)
        return h.pixels(scene, h.settings(integrator=integrator, max_depth=0)).mean()

    np.testing.assert_allclose(lit("shadow"), 0.5 ** len(veils) / np.pi, rtol=1e-4)
    assert lit("camera", "diffuse", "glossy", "transmission") == lit() == 0


@pytest.mark.parametrize("integrator", ["path", "distributed", "whitted"])
def test_what_passes_straight_on_stays_of_its_kind(integrator):
    """Behind a veil as in front of it: half of the world, or of the sheet."""
    sheet, veil = card(GLOW, z=0.0), card(VEIL, z=1.0)
    for kind, L in (("camera", 0.5), ("transmission", 2.0)):
        assert radiance((hidden(sheet, kind), veil), integrator=integrator) == L


def test_rays_of_several_kinds_in_a_batch_see_what_each_sees():
    """A floor that is half dull, half a mirror, under a sheet that is hidden from glossy rays."""
    floor = Material(name="both", lobes=(Lambert(HALF), Mirror(HALF)))
    sheet = hidden(h.thing(h.quad((0, 0, 6), (4e4, 0, 0), (0, 4e4, 0), name="sheet"), GLOW), "glossy")
    objects = (h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0), name="floor"), floor), sheet)
    found = radiance(objects, integrator="path_blind", max_depth=1, samples=256)
    assert abs(found - 2.5) <= 0.05


LIGHTS = {
    "point": PointLight(position=(1.0, 0.0, 3.0), intensity=(9.0,) * 3, radius=0.5),
    "sun": SunLight(towards=(0.6, 0.0, 0.8), angle=0.5),
    "area": AreaLight(world_from_light=h.affine(np.eye(3), (0, 0, 4)), size_x=3.0, size_y=2.0),
    "mesh": h.thing(h.quad((0, 0, 4), (3, 0, 0), (0, 2, 0), name="glow"), h.lambert(0, "glow", 1.0)),
    "picture": World(environment=EnvironmentMap(pixels=np.ones((3, 4, 8), np.float32))),
    "world": World(radiance=(1.0,) * 3),
}
FLOORS = {"diffuse": Lambert((0.8,) * 3), "glossy": Phong((0.8,) * 3, 3.0)}


def lit_floor(light, *lobes, integrator="path"):
    """Light that a floor reflects, (pixels,), of one of LIGHTS; the camera looks down from below lamps."""
    floor = h.thing(h.quad((0, 0, 0), (6, 0, 0), (0, 6, 0), name="floor"), Material(name="floor", lobes=lobes))
    objects, lights, world = [floor], [], World()
    if isinstance(light, World):
        world = light
    else:
        (objects if isinstance(light, Object) else lights).append(light)
    camera = OrthographicCamera.look_at((0, 0, 2), (0, 0, 0), up=(0, 1, 0), height=1.0)
    scene = h.replaced(h.scene(objects, lights, camera), world=world)
    return h.pixels(scene, h.settings(integrator=integrator, max_depth=1, samples=16)).mean(axis=0).ravel().astype(np.float64)


@pytest.mark.parametrize("integrator", ["path", "path_blind", "distributed"])
@pytest.mark.parametrize("name", LIGHTS)
def test_lights_do_not_light_the_lobes_that_they_are_hidden_from(name, integrator):
    """Nor does anything else change."""
    for kind, lobe in FLOORS.items():
        other = ("camera", *(k for k in RAY_KINDS[1:4] if k != kind))
        full = lit_floor(LIGHTS[name], lobe, integrator=integrator)
        assert full.mean() > 0.01
        np.testing.assert_allclose(lit_floor(hidden(LIGHTS[name], *other), lobe, integrator=integrator), full, rtol=1e-5)
        assert not lit_floor(hidden(LIGHTS[name], kind), lobe, integrator=integrator).any()


@pytest.mark.parametrize("name", ["area", "mesh"])
def test_of_a_surface_of_both_kinds_one_is_lit(name):
    """What shadow rays find; the seldom rays of the other kind that run into the light weigh by the whole surface, as in Cycles."""
    light = hidden(LIGHTS[name], "glossy")
    dull, gloss = Lambert((0.5,) * 3), Phong((0.1,) * 3, 3.0)
    both, one, full = lit_floor(light, dull, gloss), lit_floor(light, dull), lit_floor(LIGHTS[name], dull, gloss)
    assert abs(both.mean() / one.mean() - 1) <= 0.3 * (full.mean() / one.mean() - 1)


def beside_a_wall(*kinds):
    """The mean of 64 pixels by 256 samples of a dull and shiny floor that mirrors a wall, of radiance 4, which is half of what it sees."""
    floor = Material(name="floor", lobes=(Lambert(HALF), Phong((0.3,) * 3, 20.0)))
    wall = hidden(h.thing(h.quad((1e-3, 0, 0), (0, 40, 0), (0, 0, 40), name="wall"), GLOW), *kinds)
    scene = h.receiver((), [wall], material=floor, distance=0.01, tilt=-0.8, size=1e-4)
    return h.pixels(scene, h.settings(integrator="path_naive", max_depth=1, samples=256)).mean(axis=0).ravel().astype(np.float64)


def test_directions_that_no_lobe_has_chosen_count_for_the_lobes_that_send_them_on():
    """k_d L / 2 for a wall that is hidden from glossy rays, as there is of the Lambert lobe alone; the rest for the other one."""
    dull, shiny, all_ = (beside_a_wall(*kinds) for kinds in (("glossy",), ("diffuse",), ()))
    assert h.mean_is(dull, 1.0, floor=1e-3)
    assert h.means_agree(dull + shiny, all_, floor=1e-3)
    assert not beside_a_wall("diffuse", "glossy").any()


def test_the_wall_catches_lobes_that_are_chosen_unseen(monkeypatch):
    monkeypatch.setattr(Reflection, "of_direction", lambda reflection, surface, wi: reflection)
    with pytest.raises(AssertionError):
        test_directions_that_no_lobe_has_chosen_count_for_the_lobes_that_send_them_on()


def test_what_is_hidden_from_all_is_as_if_it_were_not():
    box = hidden(h.thing(h.box((-3, -3, -1), (3, 3, 5)), h.lambert(0.5)), *RAY_KINDS)
    with_it = h.replaced(plain(), objects=(*plain().objects, box))
    assert h.same_bits(h.pixels(with_it, SETTINGS), h.pixels(plain(), SETTINGS))


def test_unknown_kinds_are_refused_by_name():
    with pytest.raises(SceneError, match="object 'o' is hidden from 'x-ray', allowed: camera"):
        Object(name="o", mesh=card(GLOW).mesh, hidden_from=("x-ray",))
    with pytest.raises(SceneError, match="light 'Point' is hidden from 'x-ray'"):
        lit_floor(hidden(LIGHTS["point"], "x-ray"), Lambert())


@pytest.mark.parametrize("integrator", ["path", "distributed", "whitted"])
def test_what_is_held_out_is_clear_and_black(integrator):
    """Nothing behind it is seen, half of it through a veil; passes see nothing there. The film is opaque."""
    behind = card(GLOW, z=-1.0)
    found = seen((card(HELD, 2.0), behind), film_transparent=False, passes=("Combined", "Depth", "Emission"), integrator=integrator)
    np.testing.assert_allclose(found["Combined"], (2, 2, 2, 0.5))
    np.testing.assert_allclose(found["Emission"], 2)
    np.testing.assert_allclose(found["Depth"], 0.5 * (1e10 + 6))
    veiled = seen((card(HELD), behind, card(VEIL, z=1.0)), film_transparent=False, integrator=integrator)["Combined"]
    np.testing.assert_allclose(veiled, (0, 0, 0, 0.5))


def test_what_is_held_out_in_part_shows_the_rest():
    """Half a dull surface in a white furnace; and a gradient that holds out half on average."""
    half = Material(name="half", lobes=(Lambert(HALF),), holdout=HALF)
    found = seen((card(half),), film_transparent=False, integrator="path_blind")["Combined"]
    np.testing.assert_allclose(found, 0.5, atol=1e-6)
    where = Coordinates(source="position")
    gradient = LinearTexture((where,), (HALF,), HALF)
    x_only = Material(name="x", holdout=LinearTexture((gradient,), ((1.0, 0.0, 0.0),)))
    assert abs(seen((card(x_only),), film_transparent=False, samples=64)["Combined"][3] - (1 - 0.5 / 3)) <= 0.01


def test_only_the_camera_knows_what_is_held_out():
    """A dull floor under a sheet that is held out: it is black to the floor, not clear."""
    sheet = h.thing(h.quad((0, 0, 6), (4e4, 0, 0), (0, 4e4, 0), name="sheet"), HELD)
    found = seen((card(h.lambert(0.5)), sheet), film_transparent=False)["Combined"]
    np.testing.assert_allclose(found, (0, 0, 0, 1), atol=1e-3)


@pytest.mark.parametrize("held", [-0.1, 1.1, float("nan")])
def test_nobody_holds_out_more_than_all(held):
    with pytest.raises(SceneError, match="material 'x': holdout is"):
        seen((card(Material(name="x", holdout=(held,) * 3)),))


def test_scenes_without_either_pay_nothing():
    files = {"wavefront/sights.py", "world/sights.py", "wavefront/holdouts.py", "wavefront/light_path.py"}
    assert files.isdisjoint(entered(plain()))
    box = plain(hidden_from=("glossy",), materials=(HELD,))
    assert files <= entered(box)


def test_the_closed_forms_catch_rays_of_the_wrong_kind(monkeypatch):
    monkeypatch.setattr(sights, "kind_of", lambda carried: np.zeros_like(carried.scattered))
    with pytest.raises(AssertionError):
        test_each_kind_of_rays_does_not_see_what_is_hidden_from_it("diffuse", h.lambert(0.5), 2.0, 0.5, "camera", lambda o: o)


def test_the_closed_forms_catch_holdouts_that_scattered_rays_see(monkeypatch):
    monkeypatch.setattr(holdouts, "STRAIGHT", "pdf")
    monkeypatch.setattr(holdouts, "getattr", lambda *_: True, raising=False)
    with pytest.raises(AssertionError):
        test_only_the_camera_knows_what_is_held_out()


def test_direct_light_does_not_depend_on_what_else_is_in_the_batch():
    """To the bit: lanes of lights that nothing is hidden from, beside others and alone."""
    rng = np.random.default_rng(3)
    shared = rng.random((2, 3, 64), np.float32)
    L = rng.random((3, 64), np.float32)
    plan = SimpleNamespace(world=SimpleNamespace(sights=SimpleNamespace(lit=np.array([[1, 1]] * 2 + [[1, 0]] + [[1, 1]] * 2, np.float32))))
    light = np.arange(64) % 2

    def lit(lanes):
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(sights, "shares", lambda surface, reflection, wi: shared[..., lanes] / 2)
            return sights.lit_lobes(plan, None, None, None, L[:, lanes], light[lanes])

    open_lanes = np.nonzero(light == 0)[0]
    assert h.same_bits(lit(np.arange(64))[:, open_lanes], lit(open_lanes))


def test_ambient_light_of_what_is_hidden_is_hidden():
    floor = Material(name="floor", lobes=(Lambert(HALF),), ambient=HALF)
    for kinds, is_lit in (((), True), (RAY_KINDS, False)):
        bulb = h.replaced(BULB, hidden_from=tuple(kinds))
        scene = h.scene([h.thing(h.quad((0, 0, 0), (4, 0, 0), (0, 4, 0)), floor)], [bulb])
        assert (h.pixels(scene, h.settings(integrator="whitted_phong"))[1].max() > 0) == is_lit
