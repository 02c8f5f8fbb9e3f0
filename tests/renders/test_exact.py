"""Double precision: nothing is rounded on the way, and what is known in closed form comes out to 1e-12 (catalogue F1, F2)."""

import math

import numpy as np
import pytest

from glanz.engine import (
    INTEGRATORS,
    CheckerTexture,
    Coordinates,
    Dielectric,
    Lambert,
    Material,
    Medium,
    Mirror,
    NoiseTexture,
    OrenNayar,
    PerspectiveCamera,
    Phong,
    render_image,
    rendering,
)
from glanz.engine.wavefront.film import Film
from glanz.tests import helpers as h, scenes
from glanz.tests.renders.test_costs import pushed
from glanz.tests.renders.test_global_illumination import MESHES, WHITE_OBJECTS, furnace, series, without_shadow_rays

EXACT = h.settings(precision="exact")
NARROW = ("width", "spread", "extent")
"""What rays may carry along in single precision: cones, by which textures are averaged."""


def light_of(monkeypatch, plan):
    """Radiance (3, pixels) float64 of a plan of one tile, before it is written in float32."""
    calls = h.spy(monkeypatch, Film, "pixels")
    h.pixels_of_plan(plan)
    return calls[-1].result["Combined"][:3]


@pytest.mark.parametrize("depth", [0, 1, 2, 10])
@pytest.mark.parametrize("r", [0.0, 0.5, 0.8, 0.999])
def test_every_path_in_a_furnace_sums_the_series(monkeypatch, r, depth):
    """F1 without shadow rays and roulette: to 1e-12 in each pixel, whose samples are all the same."""
    plan = without_shadow_rays(monkeypatch, furnace(h.box(), r), h.replaced(EXACT, max_depth=depth))
    np.testing.assert_allclose(light_of(monkeypatch, plan), series(1.0, r, depth), rtol=1e-12)


@pytest.mark.parametrize("scale", [1e-6, 1.0, 1e6])
@pytest.mark.parametrize("name", MESHES)
def test_every_closed_mesh_is_a_furnace(monkeypatch, name, scale):
    scene = furnace(MESHES[name], 0.5)
    objects = [h.replaced(o, world_from_object=h.affine(scale * np.eye(3))) for o in scene.objects]
    matrix = scene.camera.world_from_camera
    camera = h.replaced(scene.camera, world_from_camera=h.affine(matrix[:3, :3], scale * matrix[:3, 3]))
    plan = without_shadow_rays(monkeypatch, h.replaced(scene, objects=objects, camera=camera), h.replaced(EXACT, max_depth=3))
    np.testing.assert_allclose(light_of(monkeypatch, plan), series(1.0, 0.5, 3), rtol=1e-12)


@pytest.mark.parametrize("name", ["sphere", "box"])
def test_a_white_convex_object_vanishes_in_white_light(monkeypatch, name):
    """F2 to 1e-12."""
    plan = h.plan_of(h.scene([WHITE_OBJECTS[name]], world=1.0), h.replaced(EXACT, width=16, height=16, max_depth=4))
    np.testing.assert_allclose(light_of(monkeypatch, plan), 1, rtol=1e-12)


def test_the_furnace_catches_light_that_is_rounded(monkeypatch):
    """The mutant has a density in single precision."""
    pdf = Lambert.pdf
    monkeypatch.setattr(Lambert, "pdf", staticmethod(lambda *args: pdf(*args).astype(np.float32)))
    with pytest.raises(AssertionError):
        test_a_white_convex_object_vanishes_in_white_light(monkeypatch, "sphere")


def everything_else():
    """A floor in a noisy coat, glass that absorbs and disperses, a mirror, and what moves, under lamps and around a camera with a lens."""
    base = scenes.everything()
    noise = NoiseTexture(Coordinates(source="generated"))
    checker = CheckerTexture((0.8,) * 3, (0.2,) * 3, Coordinates(source="generated"))
    worn = {
        "floor": Material(name="floor", lobes=(Lambert(noise), Phong((0.2,) * 3, 30.0))),
        "smooth": Material(name="glass", lobes=(Dielectric(1.5, abbe=30.0),), medium=Medium(absorption=(0.1, 0.2, 0.3))),
        "flat": Material(name="mirror", lobes=(Mirror(),)),
        "box": Material(name="rough", lobes=(OrenNayar(checker, 0.5),)),
    }
    objects = [h.replaced(o, materials=(worn[o.name],)) if o.name in worn else o for o in base.objects]
    return h.replaced(base, objects=[h.replaced(o, motion=pushed()) if o.name == "box" else o for o in objects])


@pytest.mark.parametrize("scene", [scenes.everything, everything_else], ids=["everything", "everything else"])
@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_rays_and_light_are_never_rounded(monkeypatch, integrator, scene):
    """All that is added to the film, and the rays that bring it, are in double precision: but for colours that are seen as they are."""
    calls = h.spy(monkeypatch, Film, "add")
    settings = h.replaced(EXACT, width=24, height=16, max_depth=3, integrator=integrator, branches=2)
    render_image(scene(), settings)
    assert len(calls) > 3
    for call in calls:
        _, _, rays, _, L, *_ = call.args
        assert rays.depth == 0 or L.dtype == np.float64
        carried = {name: column for name, column in vars(rays.carried).items() if name not in NARROW}
        for name, column in {"o": rays.o, "d": rays.d, "beta": rays.beta, "pdf": rays.pdf, **carried}.items():
            assert column.dtype != np.float32, name


def test_single_precision_is_what_it_was(monkeypatch):
    """That the test above can fail, and that fast is fast: no array of its rays is wider than float32."""
    calls = h.spy(monkeypatch, Film, "add")
    render_image(scenes.everything(), h.settings(width=24, height=16, max_depth=3))
    assert {column.dtype for call in calls for column in (call.args[2].o, call.args[2].d, call.args[2].beta, call.args[4])} == {
        np.dtype(np.float32)
    }


def room(scale=1.0, offset=(0.0, 0.0, 0.0)):
    """A Cornell box: coloured walls, a turned box, a smooth ball, and a lamp below the ceiling."""
    white, red, green = h.lambert(0.75, "white"), h.lambert((0.6, 0.06, 0.05), "red"), h.lambert((0.1, 0.5, 0.1), "green")
    walls = (
        ((0, 0, 0), (2, 0, 0), (0, 2, 0), white),
        ((0, 0, 2), (2, 0, 0), (0, 2, 0), white),
        ((0, 1, 1), (2, 0, 0), (0, 0, 2), white),
        ((-1, 0, 1), (0, 2, 0), (0, 0, 2), red),
        ((1, 0, 1), (0, 2, 0), (0, 0, 2), green),
        ((0, 0, 1.99), (0.5, 0, 0), (0, 0.4, 0), h.lambert(0, "light", 12.0)),
    )
    cos, sin = math.cos(0.3), math.sin(0.3)
    matrix, offset = h.affine(scale * np.eye(3), offset), np.array(offset)
    turned = h.affine(scale * np.array(((cos, -sin, 0), (sin, cos, 0), (0, 0, 1))), scale * np.array((-0.35, 0.3, 0)) + offset)
    objects = [h.thing(h.quad(centre, x, y, name=f"{i}"), material, matrix) for i, (centre, x, y, material) in enumerate(walls)]
    objects += [
        h.thing(h.box((-0.3, -0.3, 0), (0.3, 0.3, 1.2)), white, turned),
        h.thing(h.icosphere(2, 0.35, (0.4, -0.3, 0.35), smooth=True), white, matrix),
    ]
    eye, target = (scale * np.array(p) + offset for p in ((0, -3.7, 1.0), (0, 0, 1.0)))
    return h.scene(objects, camera=PerspectiveCamera.look_at(eye, target, fov=math.radians(39)))


def blocks(precision, **place):
    """Mean radiance (3, 4, 4) of 16 x 16 pixels each."""
    image = h.pixels(room(**place), h.settings(width=64, height=64, samples=16, max_depth=4, precision=precision))
    return image.reshape(3, 4, 16, 4, 16).mean(axis=(2, 4), dtype=np.float64)


@pytest.fixture(scope="module")
def here():
    return {precision: blocks(precision) for precision in ("fast", "exact")}


@pytest.mark.parametrize("place", [{"offset": (1e6, -2e6, 1e6)}, {"scale": 1e-6}, {"scale": 1e6}], ids=str)
@pytest.mark.parametrize(("precision", "tolerance"), [("exact", 1e-6), ("fast", 1e-4)])
def test_a_room_anywhere_and_of_any_size_looks_the_same(here, place, precision, tolerance):
    """Means of 4,096 samples to 1e-6, where corners are rounded otherwise; in single precision some paths pass an edge, to 1e-4."""
    np.testing.assert_allclose(blocks(precision, **place), here[precision], rtol=tolerance)


SMALL = h.replaced(EXACT, width=24, height=16, max_depth=3, threads=2)


@pytest.fixture(scope="module")
def reference():
    return h.pixels(scenes.everything(), SMALL)


@pytest.mark.parametrize("lanes", [7, 10**6])
def test_batches_and_tiles_change_no_bit(reference, monkeypatch, lanes):
    """H3."""
    monkeypatch.setattr(rendering, "LANES", lanes)
    assert h.same_bits(h.pixels(scenes.everything(), h.replaced(SMALL, tile_size=5)), reference)


def test_both_precisions_have_the_same_noise(reference):
    """The same samples: nearly all pixels agree to 1e-4, where two seeds differ by a tenth and more."""
    fast = h.pixels(scenes.everything(), h.replaced(SMALL, precision="fast"))
    assert (np.abs(fast - reference) <= 1e-4 * reference).mean() > 0.9
    other = h.pixels(scenes.everything(), h.replaced(SMALL, precision="fast", seed=1))
    assert (np.abs(other - reference) <= 1e-4 * reference).mean() < 0.5
