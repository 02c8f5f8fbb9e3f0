"""A scene runs what it asks for, and nothing else: which files of the engine a render enters, and how often it calls Embree."""

import threading
from pathlib import Path

import numpy as np
import pytest

import glanz
from glanz.engine import (
    Bitmap,
    Coordinates,
    Dielectric,
    EnvironmentMap,
    ImageTexture,
    Lambert,
    LambertTransmission,
    LayerWeight,
    Lens,
    LightFalloff,
    Material,
    Medium,
    Mirror,
    PointLight,
    Shade,
    Transparent,
    World,
    rendering,
)
from glanz.engine.world.accel import Accel
from glanz.tests import helpers as h

ENGINE = Path(glanz.__file__).parent / "engine"
SETTINGS = h.settings(width=8, height=8, samples=2, max_depth=2)
PLAIN = {
    "arrays.py",
    "dimensions.py",
    "bsdfs/lambert.py",
    "cameras/perspective.py",
    "filters/box.py",
    "integrators/path.py",
    "lights/point.py",
    "maths/bulbs.py",
    "maths/circle.py",
    "maths/frames.py",
    "maths/hashing.py",
    "maths/strata.py",
    "maths/vectors.py",
    "maths/warps.py",
    "passes/combined.py",
    "rendering.py",
    "saved.py",
    "work.py",
    "samplers/random.py",
    "samplers/stratified.py",
    "scene/settings.py",
    "wavefront/camera_rays.py",
    "wavefront/continuation.py",
    "wavefront/direct.py",
    "wavefront/film.py",
    "wavefront/loop.py",
    "wavefront/mis.py",
    "wavefront/numbers.py",
    "wavefront/records.py",
    "wavefront/signed_filter.py",
    "wavefront/tiles.py",
    "wavefront/visibility.py",
    "world/accel.py",
    "world/interaction.py",
    "world/light_choice.py",
    "world/lights.py",
    "world/materials.py",
    "world/texturing.py",
}
"""What a dull floor and box under a bulb, seen through a pinhole, need; of `world.texturing` only the word that nothing is textured."""


def plain(**changes):
    """A dull floor, and a box that `changes` may give another material or motion."""
    floor = h.thing(h.quad((0, 0, 0), (8, 0, 0), (0, 8, 0), name="floor"), h.lambert(0.6, "floor"))
    box = h.replaced(h.thing(h.box((-0.5, -0.5, 0.1), (0.5, 0.5, 1.1)), h.lambert(0.5)), **changes)
    return h.scene([floor, box], [PointLight(position=(1, -2, 3), intensity=(30.0,) * 3)])


def entered(scene, settings=SETTINGS):
    """The files of the engine, relative to its folder, in which a function runs in the threads that render."""
    plan = h.plan_of(scene, settings)
    files = set()

    def look(frame, event, argument):
        if event == "call":
            files.add(frame.f_code.co_filename)

    threading.setprofile(look)
    try:
        for _ in rendering.render_plan(plan):
            pass
    finally:
        threading.setprofile(None)
    return {Path(name).relative_to(ENGINE).as_posix() for name in files if Path(name).is_relative_to(ENGINE)}


def wearing(*lobes, **others):
    return plain(materials=(Material(name="m", lobes=lobes, **others),))


def pushed():
    keys = np.stack([np.eye(4)] * 2)
    keys[1, 0, 3] = 0.3
    return keys


def lit_by_a_picture():
    picture = EnvironmentMap(pixels=np.ones((3, 4, 8), np.float32))
    return h.replaced(plain(), world=World(environment=picture))


def shaded():
    (bulb,) = plain().lights
    return h.replaced(plain(), lights=(h.replaced(bulb, shade=Shade(texture=LightFalloff(falloff="linear"))),))


def textured():
    uvs = np.array([[[0, 1, 1, 0], [0, 0, 1, 1]]], np.float32)
    mesh = h.quad((0, 0, 0.2), (2, 0, 0), (0, 2, 0), name="card")
    mesh = h.replaced(mesh, uv_layers=("UVMap",), uvs=uvs, uv_indices=mesh.triangles)
    bitmap = Bitmap(name="b", pixels=np.linspace(0.1, 0.9, 48, dtype=np.float32).reshape(3, 4, 4))
    lobe = Lambert(ImageTexture(bitmap, Coordinates(source="uv")))
    return h.replaced(plain(), objects=(*plain().objects, h.thing(mesh, Material(name="t", lobes=(lobe,)))))


FEATURES = {
    "mirror": (lambda: wearing(Mirror()), {"bsdfs/mirror.py"}),
    "glass": (lambda: wearing(Dielectric()), {"bsdfs/dielectric.py", "maths/fresnel.py"}),
    "absorption": (lambda: wearing(Dielectric(), medium=Medium(absorption=(1.0, 2.0, 3.0))), {"wavefront/media.py"}),
    "dispersion": (lambda: wearing(Dielectric(abbe=30.0)), {"wavefront/dispersion.py"}),
    "transparency": (lambda: wearing(Transparent((0.5,) * 3)), {"wavefront/passing.py"}),
    "translucency": (lambda: wearing(LambertTransmission((0.5,) * 3)), {"bsdfs/lambert_transmission.py"}),
    "motion": (lambda: plain(motion=pushed()), {"wavefront/motion.py", "world/movers.py"}),
    "lens": (lambda: h.replaced(plain(), camera=h.replaced(plain().camera, lens=Lens(radius=0.1, focus_distance=4.0))), set()),
    "environment": (lit_by_a_picture, {"world/environment.py"}),
    "light through a texture": (shaded, {"world/shades.py", "maths/light_frames.py"}),
    "texture": (textured, {"textures/image.py", "wavefront/texturing.py"}),
    "texture of the cosine": (lambda: wearing(Lambert(LayerWeight(0.5))), {"world/by_cosine.py"}),
}


def test_a_plain_scene_enters_the_files_of_plain_scenes_and_no_other():
    assert entered(plain()) <= PLAIN


@pytest.mark.parametrize("name", FEATURES)
def test_a_feature_enters_files_of_its_own(name):
    make, files = FEATURES[name]
    found = entered(make())
    assert files <= found
    assert files.isdisjoint(PLAIN)


def test_textures_that_ask_for_the_cosine_alone_are_not_looked_up():
    assert entered(wearing(Lambert(LayerWeight(0.5)))) <= PLAIN | {"world/by_cosine.py"}


def test_the_list_catches_a_stage_that_runs_unasked(monkeypatch):
    of = glanz.engine.plan.Plan.of
    from glanz.engine.wavefront.clip import start_in_range

    def careless(scene, settings, requirements):
        plan = of(scene, settings, requirements)
        plan.camera_k.clip_start = np.zeros(1, np.float32)
        return h.replaced(plan, on_camera_rays=(start_in_range,))

    monkeypatch.setattr(h, "plan_of", lambda s, t: careless(s, t, glanz.engine.Requirements.of(s, t)))
    assert not entered(plain()) <= PLAIN


@pytest.mark.parametrize("depth", [0, 1, 4])
def test_a_bounce_costs_one_query_for_the_nearest_and_one_for_shadows(monkeypatch, depth):
    """Of one batch of paths through a plain scene."""
    closest, occluded = (h.spy(monkeypatch, Accel, name) for name in ("closest", "occluded"))
    scene = plain()
    plan = h.plan_of(scene, h.replaced(SETTINGS, max_depth=depth))
    closest.clear()
    h.pixels_of_plan(plan)
    assert (len(closest), len(occluded)) == (depth + 1, depth + 1)
