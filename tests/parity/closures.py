"""Shaders beside Cycles: a sphere of each, all in one picture, in a white furnace and under a sun and a grey world.

A sphere in an even white world seen from afar shows the directional albedo of its material, for each angle on a ring of
its own: what is seen where the normal is at an angle with cosine c from the camera is the share of light that goes back
there. An orthographic camera sees the spheres side by side; along its axis they are so far apart that none lights another.
"""

import itertools
import math
from dataclasses import dataclass

import bpy
import numpy as np

from glanz.tests.addon import blender
from glanz.tests.parity import parity

COLUMNS, ROWS, SIDE = 6, 8, 40
"""Spheres per row, rows, and pixels of each sphere's square."""
SPACING = 2.1
FAR = 20.0
"""Between a sphere and the next one along the view [radii]: the share 1/1600 of what one sees."""
COSINES = np.array((0.25, 0.5, 0.75, 0.9, 1.0))
"""Ends of the rings; the rim, in whose pixels the world is seen too, is left out."""
BRIGHTEST = 2.0
"""So much may noise make of a pixel that is at most 1."""
COLOUR = (0.8, 0.6, 0.4, 1.0)
WARM, GREY = 3.0, 0.3
"""Irradiance of the sun [W m^-2] and radiance of the world [W m^-2 sr^-1]."""
DEPTH = 64
"""So many bounces that all light comes out of glass. Through how many it comes depends on the shape of lobes."""
SMOOTH, ROUGH = 0.03, 0.1
"""By how much albedos may differ, of what is smooth or diffuse, and of what is rough."""


@dataclass(frozen=True)
class Shader:
    """A shader node with the values of its inputs; `bar` says how near it is to be."""

    name: str
    node: str
    inputs: tuple
    bar: float
    attributes: tuple = ()

    @property
    def is_offered(self):
        """Whether this version of Blender has such a node, with such inputs."""
        try:
            node = blender.new_nodes(bpy.data.materials.new("Probe")).nodes.new(self.node)
        except RuntimeError:
            return False
        return {name for name, _ in self.inputs} <= {socket.identifier for socket in node.inputs}


def _principled(name, roughness, **inputs):
    values = (("Base Color", COLOUR), ("Roughness", roughness), *((key.replace("_", " "), value) for key, value in inputs.items()))
    return Shader(f"{name}, roughness {roughness:g}", "ShaderNodeBsdfPrincipled", values, ROUGH if roughness > 0 else SMOOTH)


def _plain(name, node, bar=SMOOTH, attributes=(), **inputs):
    return Shader(name, f"ShaderNodeBsdf{node}", (("Color", COLOUR), *inputs.items()), bar, attributes)


def _copper(roughness, bar):
    inputs = ("IOR", (0.2, 0.92, 1.1)), ("Extinction", (3.91, 2.45, 2.14)), ("Roughness", roughness)
    by_index = (("fresnel_type", "PHYSICAL_CONDUCTOR"),)
    return Shader(f"Copper by extinction, roughness {roughness:g}", "ShaderNodeBsdfMetallic", inputs, bar, by_index)


STEPS, IORS = (0.0, 0.25, 0.5, 1.0), (1.1, 1.5, 2.5)
SHADERS = (
    *(_principled("Metal", step, Metallic=1.0) for step in STEPS),
    *(_principled(f"Plastic, IOR {ior:g}", step, IOR=ior) for ior in IORS for step in STEPS),
    *(_principled(f"Glass, IOR {ior:g}", step, IOR=ior, Transmission_Weight=1.0) for ior in IORS for step in STEPS),
    _plain("Diffuse BSDF", "Diffuse"),
    _plain("Translucent BSDF", "Translucent"),
    _plain("Transparent BSDF", "Transparent"),
    _plain("Glossy BSDF, roughness 0", "Glossy", Roughness=0.0),
    _plain("Glossy BSDF, roughness 0.5", "Glossy", ROUGH, Roughness=0.5),
    _plain("Glass BSDF, roughness 0", "Glass", Roughness=0.0),
    _plain("Refraction BSDF, roughness 0", "Refraction", Roughness=0.0),
    *(_plain(f"Sheen BSDF, roughness {step:g}", "Sheen", Roughness=step) for step in (0.2, 0.5, 1.0)),
    *(_plain(f"Velvet, roughness {step:g}", "Sheen", SMOOTH, (("distribution", "ASHIKHMIN"),), Roughness=step) for step in (0.2, 0.5, 1.0)),
    *(_plain(f"Diffuse BSDF, roughness {step:g}", "Diffuse", Roughness=step) for step in (0.5, 1.0)),
    _principled("Clay", 1.0, Diffuse_Roughness=1.0),
    _principled("Cloth", 1.0, Sheen_Weight=1.0, Sheen_Roughness=0.25),
    _copper(0.0, SMOOTH),
    _copper(0.5, ROUGH),
)


def rendered(is_furnace, path, samples=32):
    """(Glanz's, Cycles' picture), (height, width, 3)."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    width, height = SPACING * COLUMNS, SPACING * ROWS
    camera = blender.add_camera(
        (0.5 * (width - SPACING), -0.5 * (height - SPACING), FAR * (len(SHADERS) + 1)), SIDE * COLUMNS, SIDE * ROWS, type="ORTHO"
    )
    camera.data.ortho_scale, camera.data.clip_end = max(width, height), 2 * FAR * len(SHADERS) + 100
    for number, shader in enumerate(SHADERS):
        row, column = divmod(number, COLUMNS)
        bpy.ops.mesh.primitive_uv_sphere_add(segments=64, ring_count=32, location=(SPACING * column, -SPACING * row, FAR * number))
        mesh = bpy.context.object.data
        mesh.polygons.foreach_set("use_smooth", [True] * len(mesh.polygons))
        mesh.materials.append(_material(shader))
    blender.set_world((1, 1, 1) if is_furnace else (GREY,) * 3)
    if not is_furnace:
        sun = blender.link("Sun", bpy.data.lights.new("Sun", "SUN"))
        sun.data.energy, sun.data.angle = WARM, 0.05
        # Along this direction no sphere is in front of another.
        sun.rotation_euler = (math.radians(20), math.radians(45), 0)
    parity.be_exact(samples, DEPTH)
    cycles = bpy.context.scene.cycles
    cycles.glossy_bounces = cycles.transmission_bounces = DEPTH
    return parity.pixels("GLANZ", path), parity.pixels("CYCLES", path)


def _material(shader):
    """The material of a `Shader`; black where there is none in this version of Blender."""
    if not shader.is_offered:
        return blender.new_material(shader.name, "ShaderNodeBsdfDiffuse", Color=(0, 0, 0, 1))
    material = blender.new_material(shader.name, shader.node, **{k.replace(" ", "_"): v for k, v in shader.inputs})
    node = next(node for node in material.node_tree.nodes if node.type != "OUTPUT_MATERIAL")
    for name, value in shader.attributes:
        setattr(node, name, value)
    return material


def squares(picture):
    """The part of a picture with each shader's sphere, (SIDE, SIDE, 3)."""
    for number in range(len(SHADERS)):
        row, column = divmod(number, COLUMNS)
        yield picture[SIDE * row : SIDE * (row + 1), SIDE * column : SIDE * (column + 1)]


def albedos(square):
    """(rings, 3): the mean over each ring of a sphere in the furnace.

    No pixel can be brighter than the world, but for noise: one path in millions comes out of glass as bright as hundreds.
    """
    square = np.minimum(square, BRIGHTEST)
    x = ((np.arange(SIDE) + 0.5) / SIDE - 0.5) * SPACING
    cos = np.sqrt(np.maximum(1 - x[:, None] ** 2 - x**2, 0))
    rings = [(cos > low) & (cos <= high) for low, high in itertools.pairwise(COSINES)]
    return np.stack([square[ring].mean(axis=0) for ring in rings])


def deviations(ours, theirs):
    """{shader: the largest difference of its albedos over rings and channels, signed}."""
    found = {}
    for shader, a, b in zip(SHADERS, squares(ours), squares(theirs)):
        difference = albedos(a) - albedos(b)
        found[shader] = float(difference.ravel()[np.abs(difference).argmax()])
    return found
