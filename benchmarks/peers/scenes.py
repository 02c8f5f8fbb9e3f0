"""The scenes that all engines render alike, made in Blender: what each of them has in the same form, and nothing else.

Surfaces are diffuse, mirrors, smooth glass and mixtures of these; what glows are meshes, seen from the front, and points; the pixel
filter is the box. Textures hold linear numbers and are not averaged over footprints. There is a camera, or a thin lens with a round
aperture.
"""

import math
from pathlib import Path

import bpy
import numpy as np
from mathutils import Matrix

import glanz
from glanz.sample_scenes import common

from ..blender import THREADS, quiet

ROOT = Path(glanz.__file__).resolve().parent
WHITE, CLAY, SLATE = (0.73, 0.73, 0.73), (0.6, 0.25, 0.12), (0.15, 0.2, 0.3)
GRID = 708
"""Squares along a side of the terrain: 2 * 708^2 triangles are a little more than a million."""


def build(name):
    """Make the scene `name` of `SCENES` the open file; it is set up for both engines but for samples, size and seed."""
    glanz.register()
    with quiet():
        SCENES[name]()
    scene = bpy.context.scene
    scene.name = name
    scene.render.threads_mode, scene.render.threads = "FIXED", THREADS
    scene.render.use_persistent_data = False
    scene.glanz.pixel_filter, scene.cycles.pixel_filter_type = "box", "BOX"
    scene.glanz.filter_textures = False
    scene.glanz.sampler = "sobol"
    if scene.cycles.device != "CPU":
        scene.cycles.device = "CPU"
    depth = scene.glanz.max_depth
    # The files of the sample scenes may be older than what is asked of Cycles here.
    common.unbiased_cycles(scene, 1, depth)
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.volume_bounces = 0
    for ob in scene.objects:
        if ob.type == "MESH":
            common.exact_shadows(ob)
    return scene


def set_frame(scene, samples, side, seed=0):
    """Equal samples, size and seed for both engines; `side` is the longer one [px]."""
    width, height = scene.render.resolution_x, scene.render.resolution_y
    scene.render.resolution_x, scene.render.resolution_y = (max(1, round(side * n / max(width, height))) for n in (width, height))
    scene.render.resolution_percentage = 100
    scene.glanz.samples = scene.cycles.samples = samples
    scene.glanz.seed = scene.cycles.seed = seed


def _open(name):
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "sample_scenes" / f"{name}.blend"))
    return bpy.context.scene


def cornell_box():
    """Diffuse surfaces, one square lamp; 8 bounces."""
    _open("cornell_box")


def _room(name, max_depth):
    """A diffuse room, open towards the camera, with a wide lamp under the ceiling."""
    scene = common.new_scene(name, 512, 512, samples=64, max_depth=max_depth)
    white, red, green = (common.diffuse(n, c) for n, c in (("White", WHITE), ("Clay", CLAY), ("Slate", SLATE)))
    lamp = common.emission("Lamp", (1.0, 0.9, 0.78), 3.5)
    for mesh in (
        common.quad("Floor", (-1.5, -1, 0), (3, 0, 0), (0, 2.5, 0), white),
        common.quad("Back wall", (-1.5, 1.5, 0), (3, 0, 0), (0, 0, 2.2), white),
        common.quad("Left wall", (-1.5, -1, 0), (0, 2.5, 0), (0, 0, 2.2), red),
        common.quad("Right wall", (1.5, 1.5, 0), (0, -2.5, 0), (0, 0, 2.2), green),
        _ceiling(white, lamp),
    ):
        common.add(scene, mesh.name, mesh)
    common.camera(scene, (0.0, -4.6, 1.1), (0.0, 0.0, 1.08), lens=60.0)
    return scene


def _ceiling(white, lamp):
    """The lamp is flush with it, for its back must not be seen: Mitsuba's would be dark there."""
    xs, ys = (-1.5, -0.9, 0.9, 1.5), (-1.0, -0.6, 1.0, 1.5)
    vertices = [(x, y, 2.2) for y in ys for x in xs]
    # Seen from below, counter-clockwise.
    faces = [(4 * j + i, 4 * (j + 1) + i, 4 * (j + 1) + i + 1, 4 * j + i + 1) for j in range(3) for i in range(3)]
    return common.mesh("Ceiling", vertices, faces, [white, lamp], material_indices=[int(n == 4) for n in range(9)])


def _balls(scene, materials):
    """A row of large balls, and small ones before them."""
    for i, material in enumerate(materials):
        radius = 0.4 if i < 3 else 0.2
        x, y = ((i - 1) * 0.95, 0.45) if i < 3 else ((i - 4) * 0.8, -0.45)
        ball = common.sphere(f"Ball {i}", radius, material, segments=128, rings=64)
        common.add(scene, ball.name, ball, Matrix.Translation((x, y, radius)))


def gloss():
    """Mirrors, and diffuse balls with the share of a mirror, in a room with a wide lamp; 8 bounces."""
    scene = _room("Gloss", 8)
    mirrors = [common.glossy(f"Mirror {i}", colour, 0.0) for i, colour in enumerate(((0.9, 0.9, 0.9), (0.85, 0.62, 0.25)))]
    mixed = [_lacquer(f"Lacquer {i}", colour) for i, colour in enumerate(((0.5, 0.1, 0.08), (0.1, 0.3, 0.12), (0.1, 0.15, 0.5)))]
    _balls(scene, (mirrors[0], mixed[0], mirrors[1], mixed[1], mirrors[0], mixed[2]))


def _lacquer(name, colour, share=0.2):
    """Diffuse, and the `share` of a mirror."""
    material = common.diffuse(name, colour)
    tree = material.node_tree
    base = common.shader(material)
    (output,) = (node for node in tree.nodes if node.type == "OUTPUT_MATERIAL")
    coat, mix = common.nodes(material, "ShaderNodeBsdfGlossy", "ShaderNodeMixShader")
    coat.inputs["Roughness"].default_value, coat.inputs["Color"].default_value = 0.0, (0.9, 0.9, 0.9, 1.0)
    mix.inputs[0].default_value = share
    tree.links.new(base.outputs[0], mix.inputs[1])
    tree.links.new(coat.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    return material


def glass():
    """Smooth glass balls in a room with a wide lamp; 12 bounces."""
    scene = _room("Glass", 12)
    clear = common.glass("Glass", (1.0, 1.0, 1.0), 1.5)
    _balls(scene, (clear, common.diffuse("Plaster", (0.6, 0.6, 0.6)), clear, clear, clear, clear))


def many_lights():
    """1,024 point lamps over a plain of blocks; 3 bounces."""
    _open("many_lights")
    for lamp in bpy.data.lights:
        lamp.shadow_soft_size = 0.0


def million():
    """A terrain of a million triangles under an even sky and a large square lamp; 4 bounces."""
    scene = common.new_scene("Million", 512, 512, samples=64, max_depth=4)
    line = np.linspace(-1, 1, GRID + 1, dtype=np.float32)
    x, y = np.meshgrid(line, line)
    z = sum(0.3 / k * np.sin(2.3 * k * x + k) * np.cos(2.9 * k * y + 2 * k * k) for k in (1, 2, 4, 8, 16, 32))
    first = (np.arange(GRID)[:, None] * (GRID + 1) + np.arange(GRID)).ravel()
    corners = np.stack((first, first + 1, first + GRID + 2, first + GRID + 1), axis=1).astype(np.int32)
    mesh = bpy.data.meshes.new("Terrain")
    mesh.vertices.add(x.size)
    mesh.vertices.foreach_set("co", np.stack((2 * x, 2 * y, z), axis=-1).astype(np.float32).ravel())
    mesh.loops.add(corners.size)
    mesh.loops.foreach_set("vertex_index", corners.ravel())
    mesh.polygons.add(len(corners))
    mesh.polygons.foreach_set("loop_start", np.arange(0, corners.size, 4, dtype=np.int32))
    mesh.polygons.foreach_set("use_smooth", np.zeros(len(corners), bool))
    mesh.materials.append(common.diffuse("Sand", (0.6, 0.5, 0.38)))
    mesh.update(calc_edges=True)
    common.add(scene, "Terrain", mesh)
    lamp = common.quad("Lamp", (-0.6, -0.6, 0.0), (0, 1.2, 0), (1.2, 0, 0), common.emission("Lamp", (1.0, 0.85, 0.65), 14.0))
    common.add(scene, "Lamp", lamp, Matrix.Translation((-1.6, -0.4, 2.2)) @ Matrix.Rotation(math.radians(-35), 4, "Y"))
    scene.world = common.world((0.6, 0.75, 1.0), 0.3)
    common.camera(scene, (1.2, -2.6, 2.3), (0.0, -0.15, 0.0), lens=50.0)


def textured_interior():
    """A room whose walls, floor and boxes show six pictures of 512 x 512; 6 bounces."""
    scene = _room("Textured interior", 6)
    for number, name in enumerate(("Floor", "Back wall", "Left wall", "Right wall")):
        _dress(scene.objects[name].data, number, repeats=3 + number)
    for number, (size, x, y, turn) in enumerate((((0.6, 0.6, 0.9), -0.6, 0.4, 20), ((0.5, 0.5, 0.5), 0.55, -0.1, -30))):
        box = common.box(f"Box {number}", size, common.diffuse(f"Box {number}", WHITE))
        _dress(box, 4 + number, repeats=1)
        place = Matrix.Translation((x, y, 0)) @ Matrix.Rotation(math.radians(turn), 4, "Z")
        common.add(scene, box.name, box, place)


def _dress(mesh, number, repeats):
    """A picture of its own on every face of `mesh`, `repeats` times along each side."""
    layer = mesh.uv_layers.new(name="UVMap")
    corners = [(u * repeats, v * repeats) for u, v in ((0, 0), (1, 0), (1, 1), (0, 1))]
    layer.uv.foreach_set("vector", np.array(corners * len(mesh.polygons), np.float32).ravel())
    material = common.diffuse(f"Picture {number}", WHITE)
    texture, coordinates = common.nodes(material, "ShaderNodeTexImage", "ShaderNodeTexCoord")
    texture.image = _picture(number)
    common.connect(material, coordinates.outputs["UV"], texture.inputs["Vector"])
    common.colour_by(material, texture.outputs["Color"])
    mesh.materials.clear()
    mesh.materials.append(material)


def _picture(number, side=512):
    """Bands and soft noise, bytes that are linear."""
    rng = np.random.default_rng(number)
    y, x = np.mgrid[:side, :side] / side * 2 * math.pi
    bands = 0.5 + 0.5 * np.sin((number + 2) * x + 2 * np.sin((number + 1) * y))
    low, high = rng.uniform(0.1, 0.4, 3), rng.uniform(0.5, 0.85, 3)
    colour = low + (high - low) * np.clip(bands + rng.normal(0, 0.05, bands.shape), 0, 1)[..., None]
    made = bpy.data.images.new(f"Picture {number}", side, side)
    made.colorspace_settings.name = "Non-Color"
    made.pixels.foreach_set(np.concatenate((colour, np.ones((side, side, 1))), axis=2).astype(np.float32).ravel())
    made.update()
    made.pack()
    return made


def environment():
    """Diffuse balls on a plain under a sky with a small bright sun; 6 bounces."""
    scene = _open("environment")
    for name, colour in (("Brass", (0.8, 0.6, 0.25)), ("Chrome", (0.8, 0.8, 0.8))):
        scene.objects[name].data.materials[0] = common.diffuse(f"Dull {name}", colour)


def depth_of_field():
    """A row of balls that runs out of focus, a square lamp and an even sky; 4 bounces."""
    scene = _open("depth_of_field")
    for ob in list(scene.objects):
        if ob.name.startswith(("Bulb", "Key")):
            bpy.data.objects.remove(ob)
    lamp = common.quad("Lamp", (-1, -1, 0), (0, 2, 0), (2, 0, 0), common.emission("Lamp", (1.0, 0.95, 0.88), 28.0))
    turned = common.look_at((-4.5, -1.0, 6.5), (1.0, 4.0, 0.0))
    common.add(scene, "Lamp", lamp, turned)
    scene.camera.data.dof.aperture_blades = 0


_ALL = (cornell_box, gloss, glass, many_lights, million, textured_interior, environment, depth_of_field)
SCENES = {function.__name__: function for function in _ALL}
