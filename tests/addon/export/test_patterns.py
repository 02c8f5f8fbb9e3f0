"""Nodes that make patterns become the engine's, with their numbers and modes."""

import bpy
import pytest

from glanz.engine import CheckerTexture, GradientTexture, WaveTexture
from glanz.tests.addon import blender
from glanz.tests.addon.export.test_textures import reflectance, textured


def test_a_checker_takes_its_colours_and_scale():
    material, _, _ = textured("Checker", Color1=(0.1, 0.2, 0.3, 1), Color2=(0.4, 0.5, 0.6, 1), Scale=7)
    texture = reflectance(material)
    assert type(texture) is CheckerTexture
    assert texture.odd == pytest.approx((0.1, 0.2, 0.3))
    assert texture.even == pytest.approx((0.4, 0.5, 0.6))
    assert (texture.scale, texture.output) == (7.0, "color")
    assert texture.coordinates.attribute == ("generated", "")


def test_the_factor_of_a_checker_is_a_number():
    assert reflectance(textured("Checker", "Fac")[0]).output == "fac"


def test_noise_takes_its_numbers():
    numbers = {"Detail": 3.5, "Roughness": 0.75, "Lacunarity": 2.5, "Distortion": 0.25}
    texture = reflectance(textured("Noise", Scale=3, **numbers)[0])
    assert [getattr(texture, name.lower()) for name in numbers] == [*numbers.values()]
    assert (texture.scale, texture.is_normalized, texture.is_coloured) == (3.0, True, True)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    material, _, node = textured("Noise", "Fac", Offset=0.5, Gain=2, W=3)
    node.noise_type, node.noise_dimensions, node.normalize = "RIDGED_MULTIFRACTAL", "4D", False
    texture = reflectance(material)
    assert (texture.kind, texture.dimensions) == ("ridged multifractal", 4)
    assert (texture.offset, texture.gain, texture.w, texture.is_normalized, texture.is_coloured) == (0.5, 2.0, 3.0, False, False)


@pytest.mark.parametrize("shape", ["LINEAR", "QUADRATIC", "EASING", "DIAGONAL", "SPHERICAL", "QUADRATIC_SPHERE", "RADIAL"])
def test_gradients(shape):
    material, _, node = textured("Gradient")
    node.gradient_type = shape
    texture = reflectance(material)
    assert type(texture) is GradientTexture
    texture.check("Mat")
    assert texture.shape == shape.lower().replace("_", " ")


def words(item):
    return item.lower().replace("_", " ")


@pytest.mark.parametrize("feature", ["F1", "F2", "SMOOTH_F1", "DISTANCE_TO_EDGE", "N_SPHERE_RADIUS"])
def test_cells_take_their_numbers_and_modes(feature):
    numbers = {"Scale": 3, "W": 0.5, "Detail": 1.5, "Roughness": 0.25, "Lacunarity": 2.5, "Exponent": 2, "Randomness": 0.75}
    output = {"DISTANCE_TO_EDGE": "Distance", "N_SPHERE_RADIUS": "Radius"}.get(feature, "Color")
    material, _, node = textured("Voronoi", output, **numbers)
    node.feature, node.distance, node.voronoi_dimensions, node.normalize = feature, "MINKOWSKI", "4D", True
    texture = reflectance(material)
    texture.check("Mat")
    assert [getattr(texture, name.lower()) for name in numbers] == [*numbers.values()]
    assert (texture.feature, texture.metric, texture.output) == (words(feature), "minkowski", output.lower())
    assert (texture.dimensions, texture.is_normalized) == (4, True)
    assert texture.is_integer == (bpy.app.version >= (5, 0, 0))


@pytest.mark.parametrize(("kind", "direction"), [("BANDS", "DIAGONAL"), ("RINGS", "SPHERICAL")])
def test_waves_take_their_numbers_and_modes(kind, direction):
    numbers = {"Detail Scale": 2, "Detail Roughness": 0.25, "Phase Offset": 1.5, "Distortion": 2.5}
    material, _, node = textured("Wave", "Fac", Scale=3)
    for name, value in numbers.items():
        blender.node_input(node, name).default_value = value
    node.wave_type, node.wave_profile = kind, "TRI"
    node.bands_direction, node.rings_direction = "DIAGONAL", "SPHERICAL"
    texture = reflectance(material)
    assert (texture.shape, texture.profile, texture.scale) == (f"{words(kind)} {words(direction)}", "triangle", 3.0)
    assert (texture.detail_scale, texture.roughness, texture.phase, texture.distortion) == tuple(numbers.values())


def test_bricks_take_their_numbers():
    material, _, node = textured("Brick", Color1=(0.1, 0.2, 0.3, 1), Mortar=(0.4, 0.5, 0.6, 1), Bias=-0.5)
    blender.node_input(node, "Row Height").default_value = 0.75
    node.offset, node.offset_frequency, node.squash, node.squash_frequency = 0.25, 3, 1.5, 4
    texture = reflectance(material)
    assert texture.colour1 == pytest.approx((0.1, 0.2, 0.3)) and texture.mortar == pytest.approx((0.4, 0.5, 0.6))
    assert (texture.bias, texture.height, texture.output) == (-0.5, 0.75, "color")
    assert (texture.shift, texture.shift_every, texture.squash, texture.squash_every) == (0.25, 3, 1.5, 4)


def test_magic_white_noise_and_gabor_take_their_modes():
    material, _, node = textured("Magic", Distortion=2.5)
    node.turbulence_depth = 7
    texture = reflectance(material)
    assert (texture.depth, texture.distortion, texture.scales_first) == (7, 2.5, bpy.app.version >= (5, 2, 0))
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    material, _, node = textured("WhiteNoise", "Color", W=3)
    node.noise_dimensions = "4D"
    texture = reflectance(material)
    assert (texture.dimensions, texture.output, texture.w) == (4, "color", 3.0)
    if bpy.app.version >= (4, 3, 0):
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        material, _, node = textured("Gabor", "Phase", Frequency=3, Anisotropy=0.5)
        node.gabor_type = "3D"
        texture = reflectance(material)
        assert (texture.dimensions, texture.output, texture.frequency, texture.anisotropy) == (3, "phase", 3.0, 0.5)
        assert texture.orientation == pytest.approx((2**0.5, 2**0.5, 0))


def test_inputs_of_patterns_may_be_patterns():
    material, tree, node = textured("Noise", "Fac")
    inner = tree.nodes.new("ShaderNodeTexWave")
    for name in ("Detail", "Roughness", "Vector"):
        tree.links.new(inner.outputs["Color" if name == "Vector" else "Fac"], blender.node_input(node, name))
    texture = reflectance(material)
    assert type(texture.detail) is type(texture.coordinates) is WaveTexture
    assert texture.detail is texture.roughness
