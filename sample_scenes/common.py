"""What the scripts of the sample scenes share. Needs Blender as a module (`bpy`) and the package `glanz`."""

import math
import os
import sys
from pathlib import Path

import bpy
from mathutils import Matrix, Vector


def new_scene(name, width, height, samples, max_depth):
    """An empty scene with a black world, set up for Glanz; Cycles is set to compute the same picture."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    _register_glanz()
    scene = bpy.context.scene
    scene.name = name
    scene.render.engine = "GLANZ"
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.render.resolution_percentage = 100
    scene.glanz.samples, scene.glanz.max_depth = samples, max_depth
    scene.display_settings.display_device = "sRGB"
    scene.view_settings.view_transform = "Standard"
    scene.view_settings.look = "None"
    scene.render.image_settings.file_format = "PNG"
    unbiased_cycles(scene, samples, max_depth)
    scene.world = world((0.0, 0.0, 0.0), 0.0)
    return scene


def _register_glanz():
    try:
        import glanz
    except ImportError as error:
        raise SystemExit(f"cannot import glanz ({error}); install it first, as `make setup` does") from None
    glanz.register()


def unbiased_cycles(scene, samples, max_depth):
    """Settings under which Cycles cuts nothing off, so that pictures can be compared; without Cycles nothing happens."""
    if not hasattr(scene, "cycles"):
        return
    cycles = scene.cycles
    cycles.samples = samples
    cycles.use_adaptive_sampling = False
    cycles.use_denoising = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0.0
    cycles.light_sampling_threshold = 0.0
    cycles.blur_glossy = 0.0
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = max_depth
    cycles.transmission_bounces = cycles.transparent_max_bounces = max_depth
    cycles.pixel_filter_type = "BLACKMAN_HARRIS"
    cycles.filter_width = 1.5


def exact_shadows(made):
    """Keep Cycles from shifting shadow rays near the terminator of a smooth object: pretty, but not what is there."""
    owner = made if hasattr(made, "shadow_terminator_geometry_offset") else made.cycles
    owner.shadow_terminator_geometry_offset = 0.0


def save(scene, script):
    """Write the .blend file named on the command line, or the one beside `script`, and leave.

    Leaves without the interpreter's clean-up, which crashes in some versions of the module `bpy`.
    """
    path = Path(sys.argv[1]) if len(sys.argv) > 1 else Path(script).with_suffix(".blend")
    bpy.context.preferences.filepaths.save_version = 0  # no .blend1 beside it
    bpy.ops.wm.save_as_mainfile(filepath=str(path.resolve()), compress=True)
    print(f"wrote {path}: {len(scene.objects)} objects, {path.stat().st_size} bytes")
    sys.stdout.flush()
    os._exit(0)


# --- the world, cameras and lights ------------------------------------------------------------------------------------


def world(colour, strength):
    """A world of constant colour."""
    made = bpy.data.worlds.new("World")
    tree = empty_tree(made)
    background = tree.nodes.new("ShaderNodeBackground")
    background.inputs["Color"].default_value = (*colour, 1.0)
    background.inputs["Strength"].default_value = strength
    output = tree.nodes.new("ShaderNodeOutputWorld")
    output.location = (300, 0)
    tree.links.new(background.outputs[0], output.inputs["Surface"])
    return made


def picture_world(name, pixels, turned=0.0):
    """A world that shows an equirectangular picture, linear (H, W, 4) float32 with row 0 at the bottom, turned about z [rad]."""
    height, width, _ = pixels.shape
    image = bpy.data.images.new(name, width, height, float_buffer=True)
    image.pixels.foreach_set(pixels.reshape(-1))
    image.update()
    image.pack()
    made = world((0.0, 0.0, 0.0), 1.0)
    tree = made.node_tree
    (background,) = (node for node in tree.nodes if node.type == "BACKGROUND")
    chain = [tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexCoord", "Mapping", "TexEnvironment")]
    for i, node in enumerate(chain):
        node.location = (200 * i - 700, 0)
    coordinates, mapping, texture = chain
    mapping.inputs["Rotation"].default_value = (0.0, 0.0, turned)
    texture.image = image
    tree.links.new(coordinates.outputs["Generated"], mapping.inputs["Vector"])
    tree.links.new(mapping.outputs[0], texture.inputs["Vector"])
    tree.links.new(texture.outputs["Color"], background.inputs["Color"])
    return made


def camera(scene, position, target, lens):
    """The scene's camera at `position`, looking at `target` [m], with a focal length of `lens` [mm]."""
    data = bpy.data.cameras.new("Camera")
    data.lens = lens
    made = add(scene, "Camera", data, look_at(position, target))
    scene.camera = made
    return made


def look_at(position, target):
    """The matrix that stands at `position` and looks along -z at `target`, y up."""
    position, target = Vector(position), Vector(target)
    rotation = (target - position).to_track_quat("-Z", "Y")
    return Matrix.Translation(position) @ rotation.to_matrix().to_4x4()


def light(scene, name, kind, position, target, energy, **attributes):
    """A light of Blender's `kind` that looks at `target`; `attributes` go to its data."""
    data = bpy.data.lights.new(name, kind)
    data.energy = energy
    for attribute, value in attributes.items():
        setattr(data, attribute, value)
    return add(scene, name, data, look_at(position, target))


def add(scene, name, data, matrix=None, parent=None, collection=None):
    """An object with `data`, placed by `matrix`, in `collection` or the scene's own."""
    made = bpy.data.objects.new(name, data)
    (collection or scene.collection).objects.link(made)
    made.parent = parent
    if matrix is not None:
        made.matrix_world = matrix
    return made


# --- materials --------------------------------------------------------------------------------------------------------


def diffuse(name, colour):
    """Ideal diffuse reflection (Lambert)."""
    return _material(name, "ShaderNodeBsdfDiffuse", colour, Roughness=0.0)


def glossy(name, colour, roughness):
    """A mirror lobe of Blender's roughness."""
    return _material(name, "ShaderNodeBsdfGlossy", colour, Roughness=roughness)


def glass(name, colour, ior):
    """A smooth boundary with an index of refraction."""
    return _material(name, "ShaderNodeBsdfGlass", colour, Roughness=0.0, IOR=ior)


def emission(name, colour, strength):
    """Light of radiance `colour` times `strength`."""
    return _material(name, "ShaderNodeEmission", colour, Strength=strength)


def shader(material):
    """The node that feeds the surface of a material of this file."""
    (output,) = (node for node in material.node_tree.nodes if node.type == "OUTPUT_MATERIAL")
    return output.inputs["Surface"].links[0].from_node


def nodes(material, *types):
    """New nodes of Blender's `types` in a material, side by side on the left."""
    made = [material.node_tree.nodes.new(kind) for kind in types]
    for i, node in enumerate(made):
        node.location = (-300 * (i + 1), 0)
    return made


def connect(material, output, socket):
    """Link an output to an input."""
    material.node_tree.links.new(output, socket)


def colour_by(material, output):
    """Let an output be the colour of a material of this file."""
    connect(material, output, shader(material).inputs["Color"])


def picture(name, width, height, pixels, is_colour=True, has_alpha=False):
    """A packed 8-bit picture; `pixels` are linear RGBA numbers from the bottom left on, or plain data unless `is_colour`."""
    made = bpy.data.images.new(name, width, height, alpha=has_alpha)
    made.colorspace_settings.name = "sRGB" if is_colour else "Non-Color"
    values = [float(v) for v in pixels]
    if is_colour:
        # What is stored is encoded; alpha is not.
        values = [v if i % 4 == 3 else 1.055 * max(v, 0.0031308) ** (1 / 2.4) - 0.055 for i, v in enumerate(values)]
    made.pixels.foreach_set(values)
    made.update()
    made.pack()
    return made


def _material(name, node_type, colour, **inputs):
    made = bpy.data.materials.new(name)
    made.diffuse_color = (*colour, 1.0)  # what the solid viewport shows
    tree = empty_tree(made)
    shader = tree.nodes.new(node_type)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    output.location = (300, 0)
    shader.inputs["Color"].default_value = (*colour, 1.0)
    for key, value in inputs.items():
        shader.inputs[key].default_value = value
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return made


def empty_tree(datablock):
    """The node tree of a material or world, emptied."""
    if datablock.node_tree is None:  # from Blender 5 on there always is one, and the setting is on its way out
        datablock.use_nodes = True
    datablock.node_tree.nodes.clear()
    return datablock.node_tree


# --- meshes -----------------------------------------------------------------------------------------------------------


def mesh(name, vertices, faces, materials=(), smooth=False, material_indices=None):
    """A mesh from lists; faces counter-clockwise seen from the front."""
    made = bpy.data.meshes.new(name)
    made.from_pydata([tuple(v) for v in vertices], [], faces)
    made.polygons.foreach_set("use_smooth", [smooth] * len(faces))
    if material_indices is not None:
        made.polygons.foreach_set("material_index", material_indices)
    for material in materials:
        made.materials.append(material)
    made.update()
    return made


def quad(name, corner, side_a, side_b, material):
    """The parallelogram at `corner` along `side_a` and `side_b`; its front is where a x b points."""
    c, a, b = Vector(corner), Vector(side_a), Vector(side_b)
    return mesh(name, [c, c + a, c + a + b, c + b], [(0, 1, 2, 3)], [material])


def box(name, size, material):
    """A box of `size` (x, y, z) [m] that stands on the origin."""
    x, y, z = 0.5 * size[0], 0.5 * size[1], size[2]
    vertices = [(sx * x, sy * y, h) for h in (0.0, z) for sx, sy in ((-1, -1), (1, -1), (1, 1), (-1, 1))]
    faces = [(3, 2, 1, 0), (4, 5, 6, 7), (0, 1, 5, 4), (1, 2, 6, 5), (2, 3, 7, 6), (3, 0, 4, 7)]
    return mesh(name, vertices, faces, [material])


def wrapped(made, around=1.0, up=1.0, start=0.0):
    """A mesh of a sphere about the origin with UVs: longitude, `around` times and from `start` on, and latitude, `up` times."""
    layer = made.uv_layers.new(name="UVMap")
    uvs = []
    for polygon in made.polygons:
        corners = [made.vertices[i].co for i in polygon.vertices]
        middle = math.atan2(sum(c.y for c in corners), sum(c.x for c in corners)) / (2 * math.pi)
        for c in corners:
            u = math.atan2(c.y, c.x) / (2 * math.pi) if math.hypot(c.x, c.y) > 1e-6 else middle
            # No face across the seam.
            u += round(middle - u)
            uvs += [around * (u + start), up * (math.asin(max(-1.0, min(1.0, c.z / c.length))) / math.pi + 0.5)]
    layer.uv.foreach_set("vector", uvs)
    return made


def sphere(name, radius, material, segments=64, rings=32):
    """A smooth sphere about the origin: 2 segments (rings - 1) triangles once triangulated."""
    vertices = [(0.0, 0.0, radius)]
    for ring in range(1, rings):
        theta = math.pi * ring / rings
        for segment in range(segments):
            phi = 2 * math.pi * segment / segments
            vertices.append((radius * math.sin(theta) * math.cos(phi), radius * math.sin(theta) * math.sin(phi), radius * math.cos(theta)))
    vertices.append((0.0, 0.0, -radius))
    last = len(vertices) - 1

    def at(ring, segment):
        return 1 + (ring - 1) * segments + segment % segments

    faces = [(0, at(1, s), at(1, s + 1)) for s in range(segments)]
    faces += [(at(r, s), at(r + 1, s), at(r + 1, s + 1), at(r, s + 1)) for r in range(1, rings - 1) for s in range(segments)]
    faces += [(last, at(rings - 1, s + 1), at(rings - 1, s)) for s in range(segments)]
    return mesh(name, vertices, faces, [material], smooth=True)
