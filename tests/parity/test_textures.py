"""Textures are Cycles', pixel by pixel: a glowing tilted plane seen through the middles of pixels by both engines."""

import bpy
import numpy as np
import pytest

from glanz.tests.addon import blender
from glanz.tests.parity import parity

SIDE = 64
NEAR = 1 / 255


def new_image(colour_space="Non-Color", is_float=False, alpha=False):
    image = bpy.data.images.new("Picture", 8, 6, alpha=alpha, float_buffer=is_float)
    image.colorspace_settings.name = colour_space
    pixels = np.random.default_rng(3).random((6, 8, 4)).astype(np.float32)
    if not alpha:
        pixels[..., 3] = 1
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    return image


def glowing_plane(kind, output="Color", source=None, mapping=None, image=None, **values):
    """A tilted plane that glows with a texture; `values` are attributes of its node in lower case, else inputs."""
    blender.add_camera((0, 0, 5), SIDE, SIDE, type="ORTHO", ortho_scale=2.2)
    plane = blender.add_plane(size=2.0)
    plane.rotation_euler = (0.2, 0.1, 0.3)
    plane.data.uv_layers.new(name="UVMap").uv.foreach_set("vector", [0.1, -0.2, 1.3, 0.1, 1.1, 1.4, -0.3, 0.9])
    material = blender.new_material("Glow", "ShaderNodeEmission")
    plane.data.materials.append(material)
    tree = material.node_tree
    node = tree.nodes.new(f"ShaderNodeTex{kind}")
    if image is not None:
        node.image = new_image(**image)
    for name, value in values.items():
        if name.islower():
            setattr(node, name, value)
        else:
            blender.node_input(node, name).default_value = value
    emission = next(n for n in tree.nodes if n.type == "EMISSION")
    tree.links.new(next(s for s in node.outputs if s.identifier == output), emission.inputs["Color"])
    if source:
        coordinates = tree.nodes.new("ShaderNodeTexCoord")
        found = next(s for s in coordinates.outputs if s.identifier == source)
        if mapping:
            mapper = tree.nodes.new("ShaderNodeMapping")
            mapper.vector_type = mapping
            for name, value in (("Location", (0.3, -0.2, 0.5)), ("Rotation", (0.4, 0.2, -0.7)), ("Scale", (1, 1.5, 0.5))):
                socket = blender.node_input(mapper, name)
                if socket.enabled:
                    socket.default_value = value
            tree.links.new(found, mapper.inputs["Vector"])
            found = mapper.outputs[0]
        tree.links.new(found, node.inputs["Vector"])
    return node


CASES = {
    "repeated": ("Image", {"image": {}}),
    "extended, closest": ("Image", {"image": {}, "extension": "EXTEND", "interpolation": "Closest"}),
    "clipped": ("Image", {"image": {}, "extension": "CLIP"}),
    "clipped, closest": ("Image", {"image": {}, "extension": "CLIP", "interpolation": "Closest"}),
    "mirrored": ("Image", {"image": {}, "extension": "MIRROR"}),
    "sRGB": ("Image", {"image": {"colour_space": "sRGB"}}),
    "with alpha": ("Image", {"image": {"alpha": True, "colour_space": "sRGB"}}),
    "floats": ("Image", {"image": {"is_float": True}}),
    "checker": ("Checker", {"Scale": 4.3}),
    "factor of a checker at uv": ("Checker", {"output": "Fac", "source": "UV", "Scale": 3.0}),
    "checker at mapped points": ("Checker", {"source": "Object", "mapping": "POINT", "Scale": 2.0}),
    "checker in a mapped texture": ("Checker", {"source": "Object", "mapping": "TEXTURE", "Scale": 2.0}),
    "checker at mapped vectors": ("Checker", {"source": "Object", "mapping": "VECTOR", "Scale": 2.0}),
    "noise": ("Noise", {"output": "Fac"}),
    "coloured noise": ("Noise", {"Scale": 7.0, "Detail": 3.6, "Roughness": 0.7, "Lacunarity": 2.3}),
    "distorted noise": ("Noise", {"Distortion": 1.5}),
    "radial gradient": ("Gradient", {"source": "Object", "gradient_type": "RADIAL"}),
    "spherical gradient": ("Gradient", {"source": "Object", "gradient_type": "SPHERICAL"}),
    "eased gradient": ("Gradient", {"source": "UV", "gradient_type": "EASING"}),
}


def share_of_equal_pixels(path):
    """How many pixels of both engines differ by at most 1 / 255; footprints are small, filters smaller."""
    parity.be_exact(1024, max_depth=0)
    scene = bpy.context.scene
    scene.glanz.pixel_filter, scene.cycles.pixel_filter_type = "blackman_harris", "BLACKMAN_HARRIS"
    scene.glanz.filter_width = scene.cycles.filter_width = 0.01
    scene.cycles.samples = 1
    a, b = parity.pixels("GLANZ", path), parity.pixels("CYCLES", path)
    assert b.std() > 0.05
    return (np.abs(a - b).max(axis=2) <= NEAR).mean()


@pytest.mark.parametrize("name", CASES)
def test_a_texture_is_that_of_cycles(name, tmp_path):
    kind, values = CASES[name]
    glowing_plane(kind, **values)
    assert share_of_equal_pixels(tmp_path) >= 0.98


@pytest.mark.parametrize("changed", ["stretched", "subdivided", "texture space"])
def test_generated_coordinates_are_those_of_cycles(changed, tmp_path):
    """Those of the mesh before it was deformed, in its own texture space."""
    glowing_plane("Checker", Scale=4.3)
    plane = bpy.data.objects["Plane"]
    if changed == "stretched":
        modifier = plane.modifiers.new("Stretch", "SIMPLE_DEFORM")
        modifier.deform_method, modifier.factor = "STRETCH", -0.4
    elif changed == "subdivided":
        plane.modifiers.new("Round", "SUBSURF").render_levels = 2
    else:
        plane.data.use_auto_texspace = False
        plane.data.texspace_location, plane.data.texspace_size = (0.1, 0.2, 0.3), (0.5, 0.7, 0.9)
    assert share_of_equal_pixels(tmp_path) >= 0.98


def test_pixels_catch_a_texture_that_is_moved(tmp_path):
    """By a sixteenth of a texel."""
    node = glowing_plane("Image", image={})
    share = share_of_equal_pixels(tmp_path)
    layer = bpy.data.meshes[0].uv_layers[0]
    before = parity.pixels("CYCLES", tmp_path)
    layer.uv.foreach_set("vector", np.array([0.1, -0.2, 1.3, 0.1, 1.1, 1.4, -0.3, 0.9]) + 1 / 8 / 16)
    after = parity.pixels("GLANZ", tmp_path)
    assert node.image
    assert (np.abs(after - before).max(axis=2) <= NEAR).mean() < 0.7 < share
