"""What random scenes have found, see `test_any_scene`: each once more, as small as it is."""

import numpy as np
import pytest

from glanz.engine import (
    AreaLight,
    CheckerTexture,
    Coordinates,
    Dielectric,
    EnvironmentMap,
    Lens,
    Material,
    Medium,
    Mesh,
    World,
    render_image,
)
from glanz.engine.wavefront import film
from glanz.tests import helpers as h
from glanz.tests.moving import shifted


def test_bodies_of_which_no_triangle_is_left_are_not_there():
    """Two media in one place, and nothing to meet."""
    point = Mesh(name="point", vertices=np.zeros((3, 1)), triangles=np.zeros((3, 4)))
    glasses = [Material(name=f"glass {p}", lobes=(Dielectric(),), medium=Medium(priority=p)) for p in range(2)]
    scene = h.scene([h.thing(point, glass) for glass in glasses], world=0.5)
    image = render_image(scene, h.settings())
    np.testing.assert_allclose(image.passes["Combined"][..., :3], 0.5, rtol=1e-6)


def test_a_camera_whose_frame_is_huge_sees_without_a_complaint():
    """1e120 m per unit: the volume is more than float64 holds."""
    camera = h.scene().camera
    image = render_image(h.scene(world=0.5, camera=h.replaced(camera, world_from_camera=np.diag((1e120, 1e120, 1e120, 1)))), h.settings())
    assert np.isfinite(image.passes["Combined"]).all()


def test_a_light_that_is_larger_than_any_number_is_left_out_by_name():
    """Each side of it is a number, but not their product."""
    vast = AreaLight(name="vast", size_x=1e20, world_from_light=np.diag((1e300, 1e300, 1, 1)))
    image = render_image(h.scene([h.thing(h.quad())], [vast], world=0.5), h.settings())
    assert np.isfinite(image.passes["Combined"]).all()
    assert {line.datablock for line in image.warnings} == {("light", "vast")}


def test_a_shape_that_is_not_finite_at_both_times_leaves_out_its_triangles_alone():
    """Between an infinite place and its opposite there is none."""
    shapes = np.repeat(h.quad().vertices[None], 2, axis=0)
    shapes[:, 0, 0] = np.inf, -np.inf
    mesh = h.replaced(h.quad(), shapes=shapes)
    image = render_image(h.scene([h.thing(mesh), h.thing(h.quad((0, 0, -1)))], world=0.5), h.settings())
    assert np.isfinite(image.passes["Combined"]).all()
    assert {line.datablock for line in image.warnings} == {("object", "quad")}


def test_who_made_a_bad_sample_is_looked_for_without_a_complaint():
    """Rays through a lens that are more than float32 holds. Warnings are errors here, so sending one again may not give any."""
    lens = Lens(radius=1e6, ratio=1e-6, focus_distance=1e-30)
    sky = EnvironmentMap(pixels=np.ones((3, 1, 1)))
    scene = h.scene([h.thing(h.quad())])
    image = render_image(h.replaced(scene, camera=h.replaced(scene.camera, lens=lens), world=World(environment=sky)), h.settings())
    assert np.isfinite(image.passes["Combined"]).all()
    assert any("not finite" in line for line in image.warnings)


def two_factors(way):
    """A world beyond float32, which only a pass shows: the picture is clear."""
    sky = EnvironmentMap(pixels=np.full((3, 1, 1), 3e38), strength=(3e38,) * 3)
    scene = h.scene(world=0.0)
    return render_image(h.replaced(scene, world=World(environment=sky, group="key")), way)


@pytest.mark.parametrize("key", ["Environment", "Combined_key"])
def test_what_is_no_number_in_a_pass_alone_is_black_and_told(key):
    way = h.settings(film_transparent=True, passes=("Combined", key))
    image = two_factors(way)
    assert not image.passes["Combined"].any()
    assert not image.passes[key].any()
    assert any("not finite" in line for line in image.warnings)


def test_a_pass_that_keeps_what_is_no_number_is_noticed(monkeypatch):
    """The mutant looks for no bad numbers."""
    monkeypatch.setattr(film, "_not_finite", lambda values: np.zeros(0, int))
    with pytest.raises(AssertionError):
        test_what_is_no_number_in_a_pass_alone_is_black_and_told("Environment")


@pytest.mark.parametrize("passes", [("Combined",), ("Combined", "Standard Error")])
def test_samples_that_count_more_than_once_stay_finite_at_the_limit_of_float32(passes):
    """Mitchell's filter counts some by 1.2; their mean is the radiance all the same."""
    way = h.settings(samples=16, pixel_filter="mitchell", filter_width=4.0, passes=passes)
    image = render_image(h.scene(world=3.4e38), way)
    np.testing.assert_allclose(image.passes["Combined"][..., :3], 3.4e38, rtol=1e-6)


def test_what_holds_out_more_than_it_covers_is_not_less_than_clear():
    """Nine tenths of the light pass, and three are held out."""
    veil = Material(name="veil", alpha=0.1, holdout=(0.3, 0.3, 0.3))
    scene = h.scene([h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)), veil)])
    image = render_image(scene, h.settings(film_transparent=True))
    np.testing.assert_array_equal(image.passes["Combined"], 0)


def test_a_torn_lamp_that_moves_with_a_texture_gives_no_light():
    """It was the only thing that moved, and was looked up after the last triangle."""
    texture = CheckerTexture(coordinates=Coordinates(source="generated"))
    quad = h.quad((0, 0, 1))
    torn = h.thing(h.replaced(quad, vertices=quad.vertices * np.array((1e30, 1, 1, 1))), Material(name="glow", emission=texture))
    torn = h.replaced(torn, motion=shifted((0, 0, 0), (1, 0, 0)))
    found = render_image(h.scene([h.thing(h.quad()), torn]), h.settings(samples=16, max_depth=0))
    assert any("too far away" in line for line in found.warnings)
    assert (found.passes["Combined"][..., :3] == 0).all()
