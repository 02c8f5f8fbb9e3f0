"""Pictures of the sky light a scene as in Cycles, however they are turned, encoded and folded."""

import math

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix

from glanz.tests.addon import blender
from glanz.tests.addon.sky import new_image, set_sky
from glanz.tests.parity import parity

MOST = 0.01
HOT = np.random.default_rng(2).random((8, 16, 3)).astype(np.float32)
HOT[2, 5] = (150.0, 120.0, 60.0)


def panorama(width=64, height=32):
    """A camera that sees the whole sky as it is stored: +x in the middle, z up."""
    camera = blender.add_camera(width=width, height=height, type="PANO")
    owner = camera.data if hasattr(camera.data, "panorama_type") else camera.data.cycles
    owner.panorama_type = "EQUIRECTANGULAR"
    camera.matrix_world = Matrix(((0, 0, -1, 0), (-1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 0, 1)))


def both(path, samples, max_depth=0):
    parity.be_exact(samples, max_depth)
    return parity.pixels("GLANZ", path), parity.pixels("CYCLES", path)


TURN = (0.4, -0.7, 1.9)
VIEWS = {
    "as it is": {},
    "closest": {"interpolation": "Closest"},
    "twice as bright": {"strength": 2.0},
    "point": {"vector_type": "POINT", "Rotation": TURN, "Location": (0, 0, 0)},
    "texture": {"vector_type": "TEXTURE", "Rotation": TURN, "Location": (0, 0, 0)},
    "vector": {"vector_type": "VECTOR", "Rotation": TURN},
    "normal": {"vector_type": "NORMAL", "Rotation": TURN},
    "mirrored": {"vector_type": "POINT", "Rotation": TURN, "Scale": (1.0, -2.0 / 2, 1.0)},
    "scaled evenly": {"vector_type": "TEXTURE", "Rotation": TURN, "Scale": (3.0, 3.0, 3.0)},
    "mirror ball": {"projection": "MIRROR_BALL"},
}


def rings(side=64):
    """A smooth picture without any symmetry: what is seen behind a mirror ball is its rim, spread over many directions."""
    y, x = np.indices((side, side)) / side
    return np.stack((1 + 0.5 * np.sin(5 * x + 3 * y), 1 + 0.5 * np.sin(2 * x - 6 * y), 0.3 + x), axis=2)


@pytest.mark.parametrize("name", VIEWS)
def test_a_sky_is_seen_as_in_cycles(name, tmp_path):
    """8 x 16 blocks. Left out are those where Cycles repeats the picture beyond its end: at the poles, at the rim of the ball."""
    set_sky(new_image(rings() if name == "mirror ball" else np.random.default_rng(1).random((32, 64, 3))), **VIEWS[name])
    panorama()
    glanz, cycles = both(tmp_path, 256)
    # Blocks of 4 x 4 pixels.
    a, b = (image.reshape(8, 4, 16, 4, 3).mean(axis=(1, 3)) for image in (glanz, cycles))
    apart = np.abs(a / b - 1)
    if "Rotation" in VIEWS[name] or name == "mirror ball":
        assert np.sort(apart.max(axis=2).ravel())[:-4].max() < MOST
    else:
        assert apart[1:-1].max() < MOST
    assert np.abs(np.roll(a, 1, axis=1) / b - 1).max() > 0.1


@pytest.mark.parametrize("kind", ["byte", "float", "byte data", "linear byte"])
def test_colour_spaces_are_those_of_cycles(kind, tmp_path):
    pixels = np.random.default_rng(1).random((8, 16, 3)).astype(np.float32)
    image = new_image(pixels, is_float=kind == "float")
    if kind == "byte data":
        image.colorspace_settings.name = "Non-Color"
    if kind == "linear byte":
        image.colorspace_settings.name = "Linear Rec.709"
    set_sky(image, interpolation="Closest")
    panorama()
    glanz, cycles = both(tmp_path, 64)
    assert parity.difference(glanz[4:-4], cycles[4:-4], 8) < MOST
    assert parity.difference(1.02 * glanz[4:-4], cycles[4:-4], 8) > MOST


def balls():
    """A diffuse and a glossy ball on a white floor, from above."""
    camera = blender.add_camera(location=(0, -4.5, 3.0), width=32, height=32)
    camera.rotation_euler = Euler((math.radians(57), 0, 0))
    floor = blender.add_plane(size=12)
    floor.data.materials.append(blender.new_material("Floor", "ShaderNodeBsdfDiffuse", Color=(0.7, 0.7, 0.7, 1)))
    for x, material in (
        (-0.8, blender.new_material("Diffuse", "ShaderNodeBsdfDiffuse", Color=(0.8, 0.5, 0.3, 1))),
        (0.8, blender.new_material("Mirror", "ShaderNodeBsdfGlossy", Color=(0.9, 0.9, 0.9, 1), Roughness=0.0)),
    ):
        bpy.ops.mesh.primitive_uv_sphere_add(segments=32, ring_count=16, radius=0.7, location=(x, 0, 0.7))
        bpy.ops.object.shade_smooth()
        bpy.context.object.data.materials.append(material)


def test_balls_under_a_sky_with_a_hot_spot_are_lit_as_in_cycles(tmp_path):
    """A turned picture with one pixel of 150; blocks to 1 %, and a turn by 5 degrees is noticed."""
    set_sky(new_image(HOT), vector_type="POINT", Rotation=(0.1, 0.2, 0.5))
    balls()
    glanz, cycles = both(tmp_path, 1024, max_depth=2)
    assert parity.difference(glanz, cycles) < MOST
    assert abs(glanz.mean() / cycles.mean() - 1) < 0.003
    set_sky(new_image(HOT), vector_type="POINT", Rotation=(0.1, 0.2, 0.5 + math.radians(5)))
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles) > MOST


@pytest.mark.parametrize("is_named", [True, False])
def test_a_missing_picture_is_as_in_cycles(is_named, tmp_path):
    """Magenta."""
    image = bpy.data.images.new("lost", 4, 4) if is_named else None
    if is_named:
        image.source, image.filepath = "FILE", "//nowhere.exr"
    set_sky(image)
    panorama(16, 8)
    glanz, cycles = both(tmp_path, 1)
    np.testing.assert_allclose(glanz, cycles, atol=1e-6)
