"""Lights carry Blender's units, one formula after the other; the right sides are the closed forms that Cycles agrees with."""

import math

import bpy
import numpy as np
import pytest

from glanz.engine import CosineSpotLight
from glanz.tests.addon import blender

PI = math.pi
HAS_EXPOSURE = hasattr(bpy.types.Light, "exposure") or bpy.app.version >= (4, 5)


def _light(kind, **attributes):
    """(light object, light) of a new light of 100 W, or W/m^2."""
    light = bpy.data.lights.new("Light", kind)
    light.energy = 100
    for name, value in attributes.items():
        setattr(light, name, value)
    return blender.link("Light", light), light


def _exported():
    scene, warnings = blender.export()
    assert len(scene.lights) == 1, warnings
    return scene.lights[0]


@pytest.mark.parametrize("kind", ["POINT", "SPOT"])
@pytest.mark.parametrize("radius", [0, 0.5])
def test_bulbs_have_intensity_power_over_4_pi(kind, radius):
    _light(kind, shadow_soft_size=radius, color=(1, 0.5, 0.25))
    light = _exported()
    assert light.intensity == pytest.approx((100 / (4 * PI), 50 / (4 * PI), 25 / (4 * PI)))
    assert light.radius == radius


@pytest.mark.parametrize("kind", ["POINT", "SPOT"])
@pytest.mark.parametrize("is_soft", [True, False])
def test_soft_falloff_is_kept(kind, is_soft):
    _light(kind, use_soft_falloff=is_soft)
    assert _exported().soft_falloff == is_soft


def test_a_spots_cone_does_not_change_its_intensity():
    _light("SPOT", spot_size=0.3, spot_blend=0.7)
    light = _exported()
    assert light.intensity == pytest.approx([100 / (4 * PI)] * 3)
    assert (light.angle, light.blend) == pytest.approx((0.3, 0.7))


def test_a_spots_frame_is_scaled():
    ob, _ = _light("SPOT")
    ob.scale = (2, 1, 0.5)
    np.testing.assert_allclose(_exported().world_from_light[:3, :3], np.diag((2, 1, 0.5)), atol=1e-7)


def test_the_widest_spot_is_a_half_space():
    _light("SPOT", spot_size=PI)
    assert _exported().angle == pytest.approx(PI)


def test_a_spot_takes_the_lectures_characteristic_where_asked():
    """As bright on the axis as Blender's cone, I_0 = P / (4 pi); the cone's own settings do not count."""
    _, light = _light("SPOT", spot_size=0.3, shadow_soft_size=0.2, color=(1, 0.5, 0.25))
    light.glanz.characteristic, light.glanz.exponent = "COSINE", 20
    light = _exported()
    assert type(light) is CosineSpotLight
    assert light.intensity == pytest.approx((100 / (4 * PI), 50 / (4 * PI), 25 / (4 * PI)))
    assert (light.exponent, light.radius) == pytest.approx((20, 0.2))
    assert light.power()[0] == pytest.approx(100 / 2 / 21)


def test_a_characteristic_that_a_script_sets_is_seen_at_once():
    _, light = _light("SPOT")
    assert type(_exported()) is not CosineSpotLight
    light.glanz.characteristic, light.glanz.exponent = "COSINE", 20
    assert _exported().exponent == 20
    light.glanz.exponent = 30
    assert _exported().exponent == 30


def test_the_lectures_spot_shows_its_characteristic_in_a_saved_file(tmp_path):
    """E = I_0 cos^n cos / d^2 on a white floor below: pixels at 0 and 45 degrees, to 1 %."""
    blender.add_camera(location=(0, 0, 10), width=33, height=33, type="ORTHO", ortho_scale=6.6)
    blender.add_plane(size=20).data.materials.append(blender.new_material("White", "ShaderNodeBsdfDiffuse", Color=(1, 1, 1, 1)))
    ob, light = _light("SPOT", energy=4 * PI * 100, shadow_soft_size=0)
    ob.location.z = 2
    light.glanz.characteristic, light.glanz.exponent = "COSINE", 4
    scene = bpy.context.scene
    scene.render.engine, scene.glanz.max_depth, scene.glanz.samples, scene.glanz.pixel_filter = "GLANZ", 0, 64, "box"
    image = next(iter(blender.read_exr(blender.render(tmp_path / "a.exr")).values()))[..., 0]
    on_axis = 100 / 4 / PI
    assert image[16, 16] == pytest.approx(on_axis, rel=0.01)
    assert image[16, 26] == pytest.approx(on_axis / 2 * 0.5**2 * math.sqrt(0.5), rel=0.01)


def test_suns_have_irradiance_and_shine_along_minus_z():
    ob, _ = _light("SUN", angle=0.1)
    ob.rotation_euler.y = PI / 2
    ob.scale = (3, 3, 3)
    light = _exported()
    assert light.irradiance == pytest.approx((100, 100, 100))
    assert light.towards == pytest.approx((1, 0, 0), abs=1e-6)
    assert light.angle == pytest.approx(0.1)


@pytest.mark.parametrize(
    ("shape", "area"),
    [("SQUARE", 4.0), ("RECTANGLE", 6.0), ("DISK", PI), ("ELLIPSE", PI / 4 * 6.0)],
)
@pytest.mark.parametrize("scale", [(1, 1, 1), (2, 3, 5)])
def test_area_lights_have_radiance_power_over_pi_and_area_in_the_world(shape, area, scale):
    ob, _ = _light("AREA", shape=shape, size=2, size_y=3)
    ob.scale = scale
    light = _exported()
    world_area = area * scale[0] * scale[1]
    assert light.radiance == pytest.approx([100 / (PI * world_area)] * 3, rel=1e-6)
    assert light.area() == pytest.approx(world_area, rel=1e-6)
    assert light.is_ellipse == (shape in ("DISK", "ELLIPSE"))


def test_a_parents_scale_counts_for_the_area():
    ob, _ = _light("AREA", size=1)
    ob.parent = blender.link("Parent", None)
    ob.parent.scale = (2, 2, 2)
    assert _exported().radiance == pytest.approx([100 / (4 * PI)] * 3)


@pytest.mark.parametrize(("spread", "expected"), [(PI, PI), (1.0, 1.0), (0.0, math.radians(0.1))])
def test_spread_stays_within_what_light_can_do(spread, expected):
    _light("AREA", spread=spread)
    assert _exported().spread == pytest.approx(expected)
    assert _exported().spread <= PI


def test_an_area_light_without_area_is_named_and_left_out():
    ob, _ = _light("AREA")
    ob.scale = (0, 1, 1)
    scene, warnings = blender.export()
    assert scene.lights == ()
    assert "light 'Light'" in warnings[0]


@pytest.mark.skipif(not HAS_EXPOSURE, reason="Blender has exposure, temperature and normalize from 4.5 on")
class TestFromBlender45:
    def test_exposure_counts_in_powers_of_two(self):
        _light("SUN", exposure=3)
        assert _exported().irradiance == pytest.approx([800] * 3)

    def test_temperature_colours_the_light(self):
        _, light = _light("SUN", use_temperature=True, temperature=3000)
        assert _exported().irradiance == pytest.approx([100 * c for c in light.temperature_color])
        assert light.temperature_color[0] > 2 * light.temperature_color[2]

    @pytest.mark.parametrize(("radius", "factor"), [(0.5, 4 * PI * 0.25), (0, 4)])
    def test_bulbs_that_are_not_normalised_count_per_surface(self, radius, factor):
        _light("POINT", normalize=False, shadow_soft_size=radius)
        assert _exported().intensity == pytest.approx([100 * factor / (4 * PI)] * 3)

    def test_area_lights_that_are_not_normalised_count_per_area(self):
        _light("AREA", normalize=False, shape="RECTANGLE", size=2, size_y=3)
        assert _exported().radiance == pytest.approx([100 / PI] * 3)

    @pytest.mark.parametrize(("angle", "factor"), [(0.2, PI * math.sin(0.1) ** 2), (0, 1)])
    def test_suns_that_are_not_normalised_count_per_solid_angle(self, angle, factor):
        _light("SUN", normalize=False, angle=angle)
        assert _exported().irradiance == pytest.approx([100 * factor] * 3)


def test_the_emission_node_multiplies():
    _, light = _light("SUN", color=(1, 0.5, 1))
    tree = blender.new_nodes(light)
    emission = blender.add_node(tree, "ShaderNodeEmission", Color=(1, 1, 0.5, 1), Strength=3)
    tree.links.new(emission.outputs[0], tree.nodes.new("ShaderNodeOutputLight").inputs[0])
    assert _exported().irradiance == pytest.approx((300, 150, 150))


@pytest.mark.parametrize("is_visible", [False, True])
def test_lights_are_seen_by_the_camera_as_in_blender(is_visible):
    ob, _ = _light("AREA")
    assert not ob.visible_camera
    ob.visible_camera = is_visible
    assert _exported().is_visible == is_visible


def test_lights_inside_instances_are_placed():
    collection = bpy.data.collections.new("Lamps")
    collection.objects.link(bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT")))
    for x in (1, 2):
        empty = blender.link("Empty", None, (x, 0, 0))
        empty.instance_type, empty.instance_collection = "COLLECTION", collection
    assert sorted(light.position[0] for light in blender.export()[0].lights) == [1, 2]


def test_a_light_that_is_nowhere_is_named_and_left_out():
    ob, _ = _light("POINT")
    ob.location.x = float("nan")
    scene, warnings = blender.export()
    assert scene.lights == ()
    assert warnings == ("the transform is not finite, so it is left out: light 'Light'",)


def test_switched_off_shadows_are_named():
    _light("POINT", use_shadow=False)
    assert "light 'Light'" in blender.export()[1][0]


def test_a_limit_of_bounces_is_named():
    _light("POINT")[1].cycles.max_bounces = 1023
    assert blender.export()[1] == ("its Max Bounces are ignored, it shines however often light has bounced: light 'Light'",)
