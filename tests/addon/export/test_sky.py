"""Sky Texture becomes the engine's sky; what that lacks is named."""

import math

import bpy
import pytest

from glanz.engine import LinearTexture, SceneError, Settings, render_image
from glanz.tests.addon import blender
from glanz.tests.parity.test_sky import set_sky


def exported(model, **values):
    set_sky(model, values)
    scene, warnings = blender.export()
    sky = scene.world.radiance
    (sky,) = sky.textures if isinstance(sky, LinearTexture) else (sky,)
    return sky, warnings


def test_a_sky_has_the_values_of_its_node():
    sky, warnings = exported("MULTIPLE_SCATTERING", sun_elevation=0.5, altitude=2000.0, ozone_density=2.0, sun_disc=False)
    assert warnings == ()
    assert sky.sun_elevation == pytest.approx(0.5)
    assert (sky.altitude, sky.ozone, sky.has_disk) == (2000, 2, False)


@pytest.mark.parametrize(("turned", "elevation", "rotation"), [(2.0, 3.14159265 - 2.0, 3.14159265), (7.0, 7.0 - 6.2831853, 0.0)])
def test_a_sun_past_the_zenith_stands_on_the_other_side(turned, elevation, rotation):
    sky, _ = exported("SINGLE_SCATTERING", sun_elevation=turned)
    assert sky.sun_elevation == pytest.approx(elevation, abs=1e-5)
    assert abs(sky.sun_rotation) == pytest.approx(rotation, abs=1e-5)


@pytest.mark.parametrize(
    ("model", "name", "value"),
    [
        ("SINGLE_SCATTERING", "sun_elevation", math.inf),
        ("SINGLE_SCATTERING", "sun_rotation", math.inf),
        ("PREETHAM", "sun_direction", (math.nan, 0.0, 1.0)),
    ],
)
def test_a_place_of_the_sun_that_is_not_finite_is_refused_by_its_name(model, name, value):
    set_sky(model, {name: value})
    scene, _ = blender.export()
    with pytest.raises(SceneError, match=f"world.*{name} of a sky is .*(inf|nan).*, allowed: (finite numbers|a unit vector)"):
        render_image(scene, Settings(width=2, height=2, samples=1))


def test_a_sun_without_a_size_is_the_smallest_of_cycles():
    assert exported("SINGLE_SCATTERING", sun_size=0.0)[0].sun_size == pytest.approx(0.0005)


def test_hosek_wilkie_has_haze_and_ground():
    sky, warnings = exported("HOSEK_WILKIE", turbidity=4.0, ground_albedo=0.6)
    assert warnings == ()
    assert (sky.model, sky.turbidity, sky.ground_albedo) == ("hosek wilkie", 4.0, pytest.approx(0.6))


def test_a_sky_can_be_turned_by_a_mapping():
    node = set_sky("PREETHAM", {})
    tree = bpy.context.scene.world.node_tree
    mapping = blender.add_node(tree, "ShaderNodeMapping", Rotation=(0.3, 0.2, 0.1))
    tree.links.new(tree.nodes.new("ShaderNodeTexCoord").outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs["Vector"], node.inputs["Vector"])
    (sky,) = blender.export()[0].world.radiance.textures
    assert sky.coordinates.matrix[0][1] != 0
