"""What must not change a picture: scale, place, order, threads, tiles, batches (catalogue A2, A3, A11, E12, G10, H3-H5)."""

import itertools

import numpy as np
import pytest

from glanz.engine import INTEGRATORS, Mesh, PointLight, Scene, rendering
from glanz.engine.maths.hashing import mix
from glanz.engine.scene.settings import PRECISIONS
from glanz.engine.wavefront import numbers, visibility
from glanz.engine.wavefront.film import Film
from glanz.engine.wavefront.loop import few_wait
from glanz.engine.world.frame import Frame
from glanz.tests import chance, helpers as h, scenes

SMALL = h.settings(width=24, height=16, samples=4, max_depth=3, threads=2)
FULL = h.replaced(SMALL, passes=("Combined", "Depth", "Normal"))


@pytest.fixture(scope="module")
def references():
    """{precision: the picture of everything}."""
    return {precision: h.pixels(scenes.everything(), h.replaced(SMALL, precision=precision)) for precision in PRECISIONS}


@pytest.fixture(scope="module")
def reference(references):
    return references["fast"]


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("k", [-40, -20, 20, 40])
def test_a_power_of_two_as_scale_changes_no_bit(references, k, precision):
    """A2: geometry, camera and lights scaled by 2^k, intensities by 4^k."""
    scaled = h.pixels(scenes.everything(scale=2.0**k), h.replaced(SMALL, precision=precision))
    assert h.same_bits(scaled, references[precision])


@pytest.mark.parametrize("scale", [1e-6, 1e6])
def test_any_other_scale_changes_the_picture_by_rounding_only(reference, scale):
    """The mean of all, and nearly all pixels, to 1e-4: paths are the same, but for those that pass an edge."""
    image = h.pixels(scenes.everything(scale=scale), SMALL)
    assert image.mean() == pytest.approx(reference.mean(), rel=1e-3)
    assert (np.abs(image - reference) <= 1e-3 * reference).mean() > 0.95


@pytest.mark.parametrize("offset", [(2.0**20, 0, 0), (-(2.0**20), 2.0**18, 2.0**21)], ids=str)
@pytest.mark.parametrize("precision", PRECISIONS)
def test_an_exact_shift_changes_no_bit(references, offset, precision):
    """A3: all coordinates are multiples of 2^-10, moved by 2^20."""
    shifted = h.pixels(scenes.everything(offset=offset), h.replaced(SMALL, precision=precision))
    assert h.same_bits(shifted, references[precision])


def test_shifting_catches_a_world_that_is_not_centred_on_the_camera(reference, monkeypatch):
    """The mutant rounds world coordinates to float32 before they are centred."""
    points = Frame.points
    monkeypatch.setattr(Frame, "points", lambda self, p: points(self, np.asarray(p).astype(np.float32)))
    assert not h.same_bits(h.pixels(scenes.everything(offset=(2.0**20, 0, 0)), SMALL), reference)


def test_scaling_catches_an_offset_that_does_not_scale(reference, monkeypatch):
    """The mutant starts rays at a fixed distance from surfaces, in metres."""
    interact = visibility.interact

    def fixed(triangles, shading_normals, d, hits):
        surface = interact(triangles, shading_normals, d, hits)
        return h.replaced(surface, o=surface.p + np.float32(1e-4) * scale * surface.n)

    scale = np.float32(1)
    monkeypatch.setattr(visibility, "interact", fixed)
    at_one = h.pixels(scenes.everything(), SMALL)
    scale = np.float32(2.0**-20)
    assert not h.same_bits(h.pixels(scenes.everything(scale=2.0**20), SMALL), at_one)


def lamp_scene(edit=lambda mesh: mesh):
    """A lattice sphere on a floor under a point light; `edit` changes every mesh."""
    base = scenes.everything()
    objects = [h.replaced(o, mesh=edit(o.mesh)) for o in base.objects if o.name != "glow"]
    return Scene(camera=base.camera, objects=objects, lights=(PointLight(position=(2.0, -1.0, 3.0), intensity=(20.0,) * 3),))


def diffuse_scene(edit=lambda mesh: mesh):
    """`lamp_scene` without its sharp reflections, which blow rounding up and bring rare bright paths."""
    scene = lamp_scene(edit)
    return h.replaced(scene, objects=[h.replaced(o, materials=(h.lambert(0.6),)) for o in scene.objects])


def edited(mesh, triangles, corner=None):
    return Mesh(
        name=mesh.name,
        vertices=mesh.vertices,
        triangles=triangles,
        normals=mesh.normals,
        normal_indices=(mesh.normal_indices[corner] if corner is not None else mesh.normal_indices) if mesh.is_smooth else np.zeros((3, 0)),
    )


@chance.fresh
def test_degenerate_triangles_change_no_bit():
    """A11: a hundred thousand without an area in each mesh beside the real ones; a million in thorough runs."""

    def with_degenerates(mesh):
        odd = np.random.default_rng(1).integers(0, mesh.vertices.shape[1], (1, chance.times(100_000)))
        if mesh.is_smooth:
            odd = odd[:, :0]
        return edited(mesh, np.concatenate((mesh.triangles, np.repeat(odd, 3, 0)), axis=1))

    assert h.same_bits(h.pixels(lamp_scene(with_degenerates), SMALL), h.pixels(lamp_scene(), SMALL))


def test_the_order_of_triangles_changes_no_bit():
    """A11: there is no light among them, so nothing is chosen by their number."""

    def shuffled(mesh):
        order = np.random.default_rng(2).permutation(mesh.triangles.shape[1])
        normals = {"normals": mesh.normals, "normal_indices": mesh.normal_indices[:, order]} if mesh.is_smooth else {}
        return Mesh(name=mesh.name, vertices=mesh.vertices, triangles=mesh.triangles[:, order], **normals)

    assert h.same_bits(h.pixels(lamp_scene(shuffled), SMALL), h.pixels(lamp_scene(), SMALL))


def test_the_order_of_objects_changes_no_bit():
    scene = lamp_scene()
    assert h.same_bits(h.pixels(h.replaced(scene, objects=scene.objects[::-1]), SMALL), h.pixels(scene, SMALL))


def test_windings_change_no_more_than_rounding():
    """A11: surfaces have no back. Corners in another order are summed in another order, so bits may differ."""

    def turned(mesh):
        return edited(mesh, mesh.triangles[[0, 2, 1]], [0, 2, 1])

    a, b = h.pixels(diffuse_scene(turned), SMALL), h.pixels(diffuse_scene(), SMALL)
    assert (np.abs(a - b) <= 1e-6 * b.max()).mean() > 0.995


def test_an_instance_is_what_its_copy_is():
    """Objects that share a mesh, and objects with meshes of their own in world space, give one picture."""
    mesh = h.icosphere(1, 0.5, smooth=True)
    places = [h.affine(translation=(x, y, 0.5)) for x in (-1.5, 0, 1.5) for y in (-1.0, 1.0)]
    light = PointLight(position=(2.0, -1.0, 3.0), intensity=(20.0,) * 3)
    shared = h.scene([h.thing(mesh, matrix=m) for m in places], [light])
    copies = [
        Mesh(
            name=f"{i}",
            vertices=mesh.vertices + m[:3, 3:],
            triangles=mesh.triangles,
            normals=mesh.normals,
            normal_indices=mesh.normal_indices,
        )
        for i, m in enumerate(places)
    ]
    assert h.same_bits(h.pixels(h.scene([h.thing(c) for c in copies], [light]), SMALL), h.pixels(shared, SMALL))


def all_passes(settings, scene=None):
    passes = rendering.render_image(scene or scenes.everything(), settings).passes
    return np.concatenate([passes[name] for name in sorted(passes)], axis=2)


@pytest.fixture(scope="module")
def all_reference():
    return all_passes(FULL)


@pytest.mark.parametrize("threads", [1, 2, 5])
@pytest.mark.parametrize("tile_size", [16, 64, 0, 5, 1])
def test_threads_and_tiles_change_no_bit(all_reference, threads, tile_size):
    """H3, all passes."""
    assert h.same_bits(all_passes(h.replaced(FULL, threads=threads, tile_size=tile_size)), all_reference)


@pytest.mark.parametrize("lanes", [1, 7, 384, 10**6])
def test_batches_change_no_bit(all_reference, monkeypatch, lanes):
    """H3: paths traced one by one, in odd numbers, a picture or all at once; both samplers."""
    settings = h.replaced(FULL, width=6, height=4) if lanes == 1 else FULL
    expected = all_reference if lanes > 1 else all_passes(settings)
    monkeypatch.setattr(rendering, "LANES", lanes)
    assert h.same_bits(all_passes(settings), expected)


def test_calls_to_embree_of_any_size_change_no_bit(all_reference, monkeypatch):
    monkeypatch.setattr("glanz.engine.world.accel.RAYS_PER_CALL", 37)
    assert h.same_bits(all_passes(FULL), all_reference)


def test_bits_catch_numbers_that_depend_on_the_tile(all_reference, monkeypatch):
    camera_rays = rendering.camera_rays

    def by_place_in_tile(plan, pixels, first, count):
        rays = camera_rays(plan, pixels, first, count)
        return h.replaced(rays, key=rays.key ^ np.uint32(pixels.px.size))

    monkeypatch.setattr(rendering, "camera_rays", by_place_in_tile)
    a, b = all_passes(h.replaced(FULL, tile_size=5)), all_passes(h.replaced(FULL, tile_size=16))
    assert not h.same_bits(a, b)


@pytest.mark.parametrize("border", [(0, 0, 24, 16), (3, 5, 17, 9), (23, 15, 24, 16), (0, 0, 1, 1)], ids=str)
def test_a_border_renders_the_same_pixels(all_reference, border):
    """G10: the crop of the full frame, bit for bit."""
    x0, y0, x1, y1 = border
    assert h.same_bits(all_passes(h.replaced(FULL, border=border)), all_reference[y0:y1, x0:x1])


@chance.fresh
def test_one_pixel_is_the_mean_of_many():
    """G10: a frame of 16 x 16 pixels with the box filter against one of 1 x 1; detects 1 %."""
    scene = diffuse_scene()
    fine = h.pixels(scene, h.settings(width=16, height=16, samples=64, max_depth=1))
    coarse = [h.pixels(scene, h.settings(width=1, height=1, samples=4096, max_depth=1, seed=s))[1, 0, 0] for s in range(12)]
    assert h.mean_is(coarse, fine[1].mean(dtype=np.float64), floor=1e-3)
    assert not h.mean_is(coarse, 1.02 * fine[1].mean(dtype=np.float64), floor=1e-3)


@pytest.mark.parametrize("size", [(1, 1), (1, 7), (16384, 1), (1, 16384)], ids=str)
def test_frames_of_any_shape_render(size):
    """G11."""
    image = h.pixels(scenes.everything(), h.settings(width=size[0], height=size[1], samples=1, max_depth=1))
    assert image.shape == (3, size[1], size[0])
    assert np.isfinite(image).all()


def parts_and_whole(monkeypatch, settings, cuts):
    """{pass: (C, pixels) float64} of the parts between `cuts`, by their samples in the whole, and of the whole itself; one tile."""
    pixels = h.spy(monkeypatch, Film, "pixels")
    mean = {}
    for first, end in itertools.pairwise(cuts):
        rendering.render_image(scenes.everything(), h.replaced(settings, sample_range=(first, end)))
        for key, values in pixels[-1].result.items():
            mean[key] = mean.get(key, 0) + values * ((end - first) / settings.samples)
    rendering.render_image(scenes.everything(), settings)
    return mean, pixels[-1].result


@pytest.mark.parametrize("cuts", [(0, 16, 32, 48, 64), (0, 1, 7, 64)], ids=str)
@pytest.mark.parametrize("changes", [{}, {"pixel_filter": "mitchell", "filter_width": 4.0}, {"sampler": "sobol"}], ids=str)
def test_the_mean_of_parts_is_the_whole(changes, cuts, monkeypatch):
    """H4, to 1e-12: 64 samples in four renders of 16; or what was left after cancelling, of any length."""
    settings = h.settings(width=6, height=4, samples=64, max_depth=2, tile_size=0, passes=("Combined", "Normal"), **changes)
    mean, whole = parts_and_whole(monkeypatch, settings, cuts)
    for key, values in whole.items():
        np.testing.assert_allclose(mean[key], values, rtol=1e-12, atol=1e-12)


def test_the_mean_of_parts_catches_parts_that_begin_at_the_same_sample(monkeypatch):
    camera_rays = rendering.camera_rays
    monkeypatch.setattr(rendering, "camera_rays", lambda plan, pixels, first, count: camera_rays(plan, pixels, first % 16, count))
    settings = h.settings(width=6, height=4, samples=64, max_depth=2, tile_size=0)
    monkeypatch.setattr(rendering, "LANES", 16 * 24)
    mean, _ = parts_and_whole(monkeypatch, settings, (0, 16, 32, 48, 64))
    monkeypatch.setattr(rendering, "camera_rays", camera_rays)
    _, whole = parts_and_whole(monkeypatch, settings, (0, 64))
    assert np.abs(mean["Combined"] - whole["Combined"]).max() > 1e-3


@pytest.mark.parametrize("integrator", INTEGRATORS)
def test_batches_change_no_bit_of_any_integrator(integrator, monkeypatch):
    """H3: those that branch split what others do not; paths one by one, in odd numbers and all at once."""
    settings = h.settings(width=6, height=4, samples=2, max_depth=2, integrator=integrator, branches=3)
    image = all_passes(settings)
    for lanes in (1, 7, 10**6):
        monkeypatch.setattr(rendering, "LANES", lanes)
        assert h.same_bits(all_passes(settings), image), lanes


def batches_of_depths(monkeypatch, together):
    """How many batches of each depth are followed for seven samples of 24 pixels, each a batch, and the picture."""
    monkeypatch.setattr(rendering, "LANES", 24)
    monkeypatch.setattr(rendering, "TOGETHER", together)
    monkeypatch.setattr(rendering, "SHOW_SECONDS", 600.0)
    plan = h.plan_of(scenes.everything(), h.settings(width=6, height=4, samples=7, max_depth=2, tile_size=0))
    counts = {}

    def counted(plan, rays, film, travel=plan.travel):
        counts[rays.depth] = counts.get(rays.depth, 0) + 1
        return travel(plan, rays, film)

    return counts, h.pixels_of_plan(h.replaced(plan, travel=counted))


def test_few_rays_of_a_depth_are_followed_together_and_change_no_bit(monkeypatch):
    """One, then two, then four batches from the camera go on as one, in any order of bounces."""
    alone, expected = batches_of_depths(monkeypatch, 1)
    joined, image = batches_of_depths(monkeypatch, 4)
    assert alone == dict.fromkeys(range(4), 7)
    assert joined == {0: 7, 1: 3, 2: 3, 3: 3}
    assert h.same_bits(image, expected)


def test_bits_catch_siblings_that_wait(monkeypatch):
    """Light of rays that split is added in another order where some of them wait: they must not."""
    settings = h.settings(width=24, height=16, samples=2, max_depth=3, integrator="distributed", branches=4, tile_size=0)
    plan = h.plan_of(scenes.everything(), settings)
    monkeypatch.setattr(rendering, "LANES", 97)
    assert not h.same_bits(h.pixels_of_plan(h.replaced(plan, wait=few_wait)), h.pixels_of_plan(plan))


@pytest.mark.parametrize("k", [-30, -4, 5, 30])
def test_powers_of_two_as_brightness_scale_every_bit(reference, k):
    """E12: render(2^k lights) = 2^k render(lights)."""
    assert h.same_bits(h.pixels(scenes.everything(power=2.0**k), SMALL), reference * np.float32(2.0**k))


@pytest.mark.parametrize("power", [1e-30, 1e30])
def test_brightness_scales_at_the_extremes(reference, power):
    """E12: relative 1e-5, float32."""
    image = h.pixels(scenes.everything(power=power), SMALL).astype(np.float64) / power
    np.testing.assert_allclose(image, reference, rtol=1e-5, atol=1e-6 * reference.max())


@pytest.mark.parametrize("seed", [0, 1, 2**31 - 1, -1, 2**70])
@chance.fresh
def test_every_integer_is_a_seed(seed):
    """H5: and gives noise of its own: residuals of two seeds are not correlated, |r| < 4.9 / sqrt(N)."""
    settings = h.settings(width=32, height=32, samples=1, max_depth=2)
    scene = h.scene([h.thing(h.box(), h.lambert(0.6, emission=1.0))], camera=h.PerspectiveCamera.look_at((0.3, 0.4, 0.5), (0.9, 0.8, 0.2)))
    noise = h.pixels(scene, h.replaced(settings, seed=seed))[0]
    assert h.same_bits(h.pixels(scene, h.replaced(settings, seed=seed))[0], noise)
    other = h.pixels(scene, h.replaced(settings, seed=seed + 1))[0]
    assert abs(np.corrcoef(noise.ravel(), other.ravel())[0, 1]) < h.Z / 32
    # Nor is that of neighbours, as if the seed had moved the noise along.
    assert abs(np.corrcoef(noise[:, 1:].ravel(), other[:, :-1].ravel())[0, 1]) < h.Z / 31
    assert abs(np.corrcoef(noise[:, :-1].ravel(), other[:, 1:].ravel())[0, 1]) < h.Z / 31


@pytest.mark.parametrize("weight", [0, 1])
def test_seeds_catch_noise_that_stays_or_moves(weight, monkeypatch):
    """The mutants forget the seed, or add it to the number of the pixel."""
    monkeypatch.setattr(numbers, "hashed_pixel", lambda px, py, width, seed: mix((py * width + px + weight * seed).astype(np.uint32)))
    with pytest.raises(AssertionError):
        test_every_integer_is_a_seed(1)
