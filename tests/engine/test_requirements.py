"""Only what a scene asks for is modelled: the table, that leaving out changes nothing, and that it pays."""

import json

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    Dielectric,
    EnvironmentMap,
    Lambert,
    LambertTransmission,
    Lens,
    Material,
    Medium,
    OrthographicCamera,
    PanoramaCamera,
    PerspectiveCamera,
    Phong,
    PhongTransmission,
    PointLight,
    Requirements,
    SunLight,
    Transparent,
    World,
    needs,
)
from glanz.engine.dimensions import Dimension
from glanz.engine.plan import Plan
from glanz.engine.world.accel import Accel
from glanz.tests import helpers as h, scenes, textured
from glanz.tests.moving import moving, shifted, turned

SETTINGS = h.settings(width=16, height=16, samples=4, max_depth=3)
ALWAYS = {"integrator path", "sampler stratified", "filter box", "pass Combined", "camera perspective"}
MATTE = h.thing(h.box(name="chair"), h.lambert(0.5, "wood"))
SHINY = h.thing(h.box(), Material(name="brass", lobes=(Phong((0.5, 0.5, 0.5), 9.0),)))
LAMP = h.thing(h.quad((0, 0, 3), name="lamp"), h.lambert(0, "glow", 1.0))
SMOOTH = h.thing(h.icosphere(1, smooth=True, name="ball"), h.lambert(0.5, "wood"))
FLOOR = h.thing(h.quad((0, 0, -1), (9, 0, 0), (0, 9, 0), name="floor"), h.lambert(0.5, "wood"))
BULB = PointLight(name="bulb", position=(1.0, -2.0, 3.0))
EMPTY = h.thing(h.Mesh(name="empty", vertices=np.zeros((3, 0)), triangles=np.zeros((3, 0))), LAMP.materials[0])
BLACK_LOBE = h.thing(h.box(), Material(name="m", lobes=(Lambert((0.0, 0.0, 0.0)), Phong((0.5, 0, 0), 2.0))))

GLASS = Material(name="glass", lobes=(Dielectric(1.5),))
WINE = Material(name="wine", lobes=(Dielectric(1.3),), medium=Medium(absorption=(0.1, 2.0, 3.0)))
FLINT = Material(name="flint", lobes=(Dielectric(1.7, abbe=25.0),))
LEAF = Material(name="leaf", lobes=(Lambert((0.3,) * 3), LambertTransmission((0.2,) * 3), PhongTransmission((0.4,) * 3, 9.0)))
STRONG = Material(name="strong", lobes=(Dielectric(1.7),), medium=Medium(priority=3))
LEFT, RIGHT = (h.box((x, -0.5, 0), (x + 0.9, 0.5, 1), name=name) for x, name in ((-1, "left"), (0, "right")))
INNER = h.box((-0.9, -0.4, 0.1), (-0.2, 0.3, 0.8), name="inner")
SKY = World(name="Sky", environment=EnvironmentMap(pixels=np.ones((3, 2, 4))))
EYE = PerspectiveCamera.look_at((3, -4, 2), (0, 0, 0), name="Eye")
VEIL = Material(name="tulle", lobes=(Transparent((0.5, 0.4, 0.3)), Lambert((0.3, 0.3, 0.3))))
CURTAIN = h.thing(h.quad((1, -1, 1), (0, 2, 0), (0, 0, 2), name="curtain"), VEIL)
OPEN = Lens(radius=0.1, focus_distance=5.0)

TABLE = {
    "lens": (h.scene(camera=h.replaced(EYE, lens=OPEN)), {"lens": ["Eye"]}),
    "closed lens": (h.scene(camera=h.replaced(EYE, lens=Lens(blades=5, focus_distance=2.0))), {}),
    "near clip": (h.scene(camera=h.replaced(EYE, clip_start=0.1)), {"clip range": ["Eye"]}),
    "far clip": (h.scene(camera=h.replaced(EYE, clip_end=100.0)), {"clip range": ["Eye"]}),
    "camera motion": (h.scene(camera=h.replaced(EYE, motion=shifted((0, 0, 0), (1, 0, 0)))), {"camera motion": ["Eye"]}),
    "camera at rest": (h.scene(camera=h.replaced(EYE, motion=np.stack([EYE.world_from_camera] * 2))), {}),
    "moving": (
        h.scene([moving(MATTE, shifted((0, 0, 0), (1, 0, 0)))]),
        {"geometry": ["chair"], "object motion": ["chair"], "bsdf lambert": ["wood"]},
    ),
    "deforming": (
        h.scene([h.replaced(MATTE, mesh=h.replaced(MATTE.mesh, shapes=np.stack([MATTE.mesh.vertices, 2 * MATTE.mesh.vertices])))]),
        {"geometry": ["chair"], "object motion": ["chair"], "bsdf lambert": ["wood"]},
    ),
    "nothing": (h.scene(), {}),
    "matte": (h.scene([MATTE]), {"geometry": ["chair"], "bsdf lambert": ["wood"]}),
    "shiny": (h.scene([SHINY]), {"geometry": ["box"], "bsdf phong": ["brass"]}),
    "smooth": (h.scene([SMOOTH]), {"geometry": ["ball"], "smooth normals": ["ball"], "bsdf lambert": ["wood"]}),
    "bulb": (h.scene([MATTE], [BULB]), {"geometry": ["chair"], "bsdf lambert": ["wood"], "light point": ["bulb"]}),
    "bulb with a size": (
        h.scene([MATTE], [h.replaced(BULB, radius=0.5)]),
        {"geometry": ["chair"], "bsdf lambert": ["wood"], "light point": ["bulb"], "light hits": ["bulb"]},
    ),
    "sun without a size": (h.scene(lights=[SunLight(name="Sol")]), {"light sun": ["Sol"]}),
    "two lights": (
        h.scene(lights=[BULB, AreaLight(name="panel")]),
        {"light point": ["bulb"], "light area": ["panel"], "light hits": ["panel"], "light choice": ["bulb", "panel"]},
    ),
    "lamp": (h.scene([LAMP]), {"geometry": ["lamp"], "emissive meshes": ["lamp"], "light choice": ["lamp"]}),
    "world": (h.scene([MATTE], world=0.5), {"geometry": ["chair"], "bsdf lambert": ["wood"], "background": ["World"]}),
    "sky": (h.replaced(h.scene([MATTE]), world=SKY), {"geometry": ["chair"], "bsdf lambert": ["wood"], "environment": ["Sky"]}),
    "sky and bulb": (
        h.replaced(h.scene(lights=[BULB]), world=h.replaced(SKY, radiance=(1, 1, 1))),
        {"light point": ["bulb"], "background": ["Sky"], "environment": ["Sky"], "light choice": ["bulb", "Sky"]},
    ),
    "black sky": (h.replaced(h.scene(), world=World(environment=EnvironmentMap(pixels=np.zeros((3, 2, 4))))), {}),
    "dark light": (h.scene(lights=[h.replaced(BULB, intensity=(0.0,) * 3)]), {}),
    "empty mesh": (h.scene([EMPTY]), {}),
    "black lobe": (h.scene([BLACK_LOBE]), {"geometry": ["box"], "bsdf phong": ["m"]}),
    "glass": (h.scene([h.thing(LEFT, GLASS)]), {"geometry": ["left"], "bsdf dielectric": ["glass"]}),
    "glass beside glass": (
        h.scene([h.thing(LEFT, GLASS), h.thing(RIGHT, STRONG)]),
        {"geometry": ["left", "right"], "bsdf dielectric": ["glass", "strong"]},
    ),
    "glass in glass": (
        h.scene([h.thing(LEFT, GLASS), h.thing(RIGHT, GLASS), h.thing(INNER, STRONG)]),
        {"geometry": ["left", "right", "inner"], "bsdf dielectric": ["glass", "strong"], "nested media": ["left", "inner"]},
    ),
    "wood in glass": (
        h.scene([h.thing(LEFT, GLASS), h.thing(INNER, h.lambert(0.5, "wood"))]),
        {"geometry": ["left", "inner"], "bsdf dielectric": ["glass"], "bsdf lambert": ["wood"]},
    ),
    "wine": (h.scene([h.thing(LEFT, WINE)]), {"geometry": ["left"], "bsdf dielectric": ["wine"], "absorption": ["wine"]}),
    "wine behind an opaque surface": (
        h.scene([h.thing(LEFT, h.replaced(WINE, lobes=(Lambert(),)))]),
        {"geometry": ["left"], "bsdf lambert": ["wine"]},
    ),
    "a clear medium": (
        h.scene([h.thing(LEFT, h.replaced(GLASS, medium=Medium()))]),
        {"geometry": ["left"], "bsdf dielectric": ["glass"]},
    ),
    "alpha": (
        h.scene([h.thing(h.quad(name="card"), Material(name="leaf", lobes=(Lambert(),), alpha=0.5))]),
        {"geometry": ["card"], "transparency": ["leaf"], "tinted shadows": ["leaf"], "bsdf lambert": ["leaf"]},
    ),
    "veil": (
        h.scene([CURTAIN]),
        {
            "geometry": ["curtain"],
            "bsdf transparent": ["tulle"],
            "transparency": ["tulle"],
            "tinted shadows": ["tulle"],
            "bsdf lambert": ["tulle"],
        },
    ),
    "prism": (h.scene([h.thing(LEFT, FLINT)]), {"geometry": ["left"], "bsdf dielectric": ["flint"], "dispersion": ["flint"]}),
    "bare object": (h.scene([h.Object(name="bare", mesh=h.quad())]), {"geometry": ["bare"]}),
}


@pytest.mark.parametrize("name", TABLE)
def test_a_scene_requires_what_it_holds_and_says_who_asked(name):
    scene, expected = TABLE[name]
    found = Requirements.of(scene, SETTINGS).as_dict()
    assert {need: names for need, names in found.items() if need not in ALWAYS} == expected
    assert set(found) >= ALWAYS


def test_settings_ask_too():
    found = Requirements.of(h.scene(), h.replaced(SETTINGS, sampler="random", pixel_filter="blackman_harris", passes=("Depth",))).as_dict()
    assert found["sampler random"] == found["filter blackman_harris"] == found["pass Depth"] == ["settings"]
    assert "pass Combined" not in found
    found = Requirements.of(h.scene(), h.replaced(SETTINGS, adaptive_threshold=0.1)).as_dict()
    assert found["adaptive supersampling"] == ["settings"]


def test_names_appear_once_in_the_order_of_the_scene():
    many = [h.thing(h.quad(name=f"o{i}"), h.lambert(0.5, "wood")) for i in range(6)]
    required = Requirements.of(h.scene(many), SETTINGS)
    assert required.needs["bsdf lambert"] == ("wood",)
    assert required.needs["geometry"] == tuple(f"o{i}" for i in range(6))
    assert "o0, o1, o2, o3 and 2 more" in str(required)


def test_the_table_is_for_people_and_machines():
    required = Requirements.of(scenes.everything(), SETTINGS)
    assert json.loads(json.dumps(required.as_dict())) == required.as_dict()
    lines = str(required).splitlines()
    assert len(lines) == len(required.needs)
    assert all("  " in line for line in lines)
    assert required == Requirements.of(scenes.everything(), SETTINGS)


def test_every_need_has_a_meaning():
    assert set(needs.MEANING) == {v for k, v in vars(needs).items() if k.isupper() and isinstance(v, str)}


VIEW = EYE.world_from_camera
SCENES = {
    "orthographic": h.scene([MATTE, FLOOR], [BULB], OrthographicCamera(world_from_camera=VIEW)),
    "panorama": h.scene([MATTE, FLOOR], [BULB], PanoramaCamera(world_from_camera=VIEW)),
    "matte and bulb": h.scene([MATTE, FLOOR], [BULB]),
    "shiny and sun": h.scene([SHINY, FLOOR], [SunLight(towards=(0.6, 0.0, 0.8))]),
    "lamp": h.scene([MATTE, FLOOR, LAMP]),
    "world": h.scene([MATTE, FLOOR], world=0.5),
    "panel": h.scene([MATTE, FLOOR], [AreaLight(world_from_light=h.affine(translation=(0, 0, 3)))]),
    "two lights": h.scene([MATTE, FLOOR], [BULB, SunLight()]),
    "smooth": h.scene([SMOOTH, FLOOR], [BULB]),
    "glass": h.scene([h.thing(LEFT, GLASS), FLOOR], [BULB], world=0.5),
    "two glasses": h.scene([h.thing(LEFT, GLASS), h.thing(RIGHT, STRONG), FLOOR], [BULB], world=0.5),
    "wine": h.scene([h.thing(LEFT, WINE), FLOOR], [AreaLight(world_from_light=h.affine(translation=(0, 0, 3)))], world=0.5),
    "prism": h.scene([h.thing(LEFT, FLINT), FLOOR], [BULB], world=0.5),
    "prism around glass": h.scene([h.thing(LEFT, FLINT), h.thing(INNER, STRONG), FLOOR], [BULB], world=0.5),
    "glass in glass": h.scene([h.thing(LEFT, GLASS), h.thing(INNER, STRONG), FLOOR], [BULB], world=0.5),
    "leaf": h.scene([h.thing(LEFT, LEAF), FLOOR], [BULB, AreaLight(world_from_light=h.affine(translation=(0, 0, 3)))], world=0.5),
    "seen, not lit": h.scene([MATTE, FLOOR]),
    "veil": h.scene([MATTE, FLOOR, CURTAIN], [BULB]),
    "everything": scenes.everything(),
    "moving": h.scene([moving(MATTE, turned((0.0, 0.5))), FLOOR], [BULB]),
    "moving camera": h.scene([MATTE, FLOOR], [BULB], h.replaced(EYE, motion=shifted((0, 0, 0), (0.3, 0, 0)) @ VIEW)),
    "textured": textured.everything(),
}


@pytest.mark.parametrize("name", SCENES)
def test_leaving_out_changes_no_bit(name):
    """Pruned image = unpruned image: all stages and lobes for a scene that does not ask for them."""
    scene = SCENES[name]
    pruned = Plan.of(scene, SETTINGS, Requirements.of(scene, SETTINGS))
    unpruned = Plan.of(scene, SETTINGS, Requirements.everything(scene, SETTINGS))
    image = h.pixels_of_plan(pruned)
    assert h.same_bits(image, h.pixels_of_plan(unpruned))
    assert image.max() > 0 or name == "seen, not lit"


def test_bits_catch_a_stage_that_is_missing():
    scene = SCENES["world"]
    required = Requirements.of(scene, SETTINGS)
    without = Requirements({need: names for need, names in required.needs.items() if need != "background"})
    assert not h.same_bits(h.pixels_of_plan(Plan.of(scene, SETTINGS, without)), h.pixels_of_plan(Plan.of(scene, SETTINGS, required)))


def test_everything_asks_for_everything():
    required = Requirements.everything(h.scene(), h.replaced(SETTINGS, film_transparent=True))
    for need in needs.MEANING:
        assert need in required
    for key in ("bsdf lambert", "bsdf phong", "light area", "light point", "light spot", "light sun"):
        assert key in required


@pytest.mark.parametrize("camera", [EYE, OrthographicCamera(world_from_camera=VIEW), PanoramaCamera(world_from_camera=VIEW)])
def test_a_pinhole_takes_no_number_and_an_open_lens_takes_two(monkeypatch, camera):
    """And without a clip range camera rays have no limit."""

    def asked(**changes):
        with monkeypatch.context() as patch:
            numbers = h.spy(patch, Plan.of(h.scene(), SETTINGS, Requirements.of(h.scene(), SETTINGS)).numbers.__class__, "two")
            closest = h.spy(patch, Accel, "closest")
            h.pixels(h.scene([MATTE], [BULB], h.replaced(camera, **changes)), SETTINGS)
        limited = [call.args[3] is not None for call in closest if call.args[1].shape[1] > 1]
        return sum(call.args[2] == Dimension.LENS for call in numbers), limited

    assert asked()[0] == 0
    assert not any(asked()[1])
    assert asked(lens=OPEN)[0] == 1
    limited = asked(clip_start=0.01)[1]
    assert limited[0]
    assert not any(limited[1:])


def calls_of(monkeypatch, scene, required):
    """What a render with `required` costs in calls: {name: number}, and the rays that it traces."""
    plan = Plan.of(scene, SETTINGS, required)
    counts = {}

    def count(stage):
        def counted(*args):
            counts[stage.__name__] = counts.get(stage.__name__, 0) + 1
            return stage(*args)

        return counted

    plan = h.replaced(
        plan,
        on_rays=tuple(map(count, plan.on_rays)),
        on_surface=tuple(map(count, plan.on_surface)),
        shading_normals=count(plan.shading_normals),
        adjust_reflection=tuple(map(count, plan.adjust_reflection)),
        on_leaving=tuple(map(count, plan.on_leaving)),
        on_camera_rays=tuple(map(count, plan.on_camera_rays)),
        travel=count(plan.travel),
        unblocked=count(plan.unblocked),
    )
    with monkeypatch.context() as patch:
        numbers = h.spy(patch, type(plan.numbers), "one")
        evaluations = [
            h.spy(patch, bsdf, "scatter" if bsdf.is_specular else "eval") for bsdf in {lobe.bsdf for lobe in plan.world.materials.lobes}
        ]
        closest = h.spy(patch, Accel, "closest")
        h.pixels_of_plan(plan)
    counts |= {"numbers": len(numbers), "evaluations": sum(map(len, evaluations)), "closest": len(closest)}
    return counts, sum(call.args[1].shape[1] for call in closest)


OPAQUE = {"travel_through", "unblocked_through", "add_light_hits_beyond"}


@pytest.mark.parametrize(
    ("name", "absent"),
    [
        ("matte and bulb", {"add_background", "add_light_hits", "add_emission", "smooth_normals"}),
        ("shiny and sun", {"add_background", "add_light_hits", "add_emission", "smooth_normals"}),
        ("lamp", {"add_background", "add_light_hits", "smooth_normals"}),
        ("world", {"add_light_hits", "add_emission", "add_direct_light", "smooth_normals"}),
        ("panel", {"add_background", "add_emission", "smooth_normals"}),
        ("smooth", {"add_background", "add_light_hits", "add_emission", "flat_normals"}),
        ("prism", {"relative_indices", "change_media", "absorb", "count_bodies"}),
        ("glass", {"find_indices", "relative_indices", "change_media", "absorb", "count_bodies", "add_light_hits_in_media"}),
        ("two glasses", {"relative_indices", "change_media", "absorb", "count_bodies", "add_light_hits_in_media"}),
        ("wine", {"find_indices", "relative_indices", "add_light_hits"}),
        ("glass in glass", {"absorb", "add_light_hits", "add_light_hits_in_media"}),
        ("seen, not lit", {"add_background", "add_light_hits", "add_emission", "add_direct_light"}),
    ],
)
def test_leaving_out_pays(monkeypatch, name, absent):
    """H9: absent stages are never called, and the rest is called less often than with everything. Calls, not seconds."""
    scene = SCENES[name]
    pruned, rays = calls_of(monkeypatch, scene, Requirements.of(scene, SETTINGS))
    full, full_rays = calls_of(monkeypatch, scene, Requirements.everything(scene, SETTINGS))
    assert not (absent | OPAQUE) & set(pruned)
    assert sum(pruned.values()) < sum(full.values())
    assert pruned["evaluations"] < full["evaluations"]
    # Between lobes of two kinds a choice is made in any case.
    kinds = sum(need.startswith("bsdf") for need in Requirements.of(scene, SETTINGS).needs)
    assert pruned["numbers"] < full["numbers"] + (kinds > 1)
    assert rays <= full_rays


def test_the_last_bounce_is_not_traced_where_it_could_find_nothing(monkeypatch):
    """With a bulb without a size and no world, d bounces take d + 1 batches of rays; with a lamp one more."""
    for depth in (0, 1, 4):
        for name, more in (("matte and bulb", 0), ("lamp", 1), ("world", 1)):
            with monkeypatch.context() as patch:
                closest = h.spy(patch, Accel, "closest")
                h.pixels(SCENES[name], h.replaced(SETTINGS, max_depth=depth))
            assert len([c for c in closest if c.args[1].shape[1] > 1]) <= depth + 1 + more, (name, depth)


def test_a_scene_that_reflects_nothing_is_traced_once(monkeypatch):
    closest = h.spy(monkeypatch, Accel, "closest")
    seen = h.thing(h.quad((1, 0, 1.5), name="seen"), h.lambert(0, "glow", 1.0))
    image = h.pixels(h.scene([seen, h.thing(h.box(), Material(name="black"))], [BULB]), SETTINGS)
    assert len([c for c in closest if c.args[1].shape[1] > 1]) == 1
    assert image.max() > 0


def test_all_that_can_be_asked_for_has_words_of_its_own():
    required = Requirements.everything(h.scene(), h.replaced(SETTINGS, passes=("Depth",)))
    words = required.in_words()
    of_settings = [need for need, names in required.needs.items() if names == ("settings",)]
    assert len(words) == len(required.needs) - len(of_settings)
    assert all(text[0].isupper() and text.partition(": ")[2] for text in words)
