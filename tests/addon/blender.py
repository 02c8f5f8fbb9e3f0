"""What the add-on's tests share: building things in the open file, exporting and rendering it, reading EXR files."""

from contextlib import contextmanager

import bpy
import numpy as np
import OpenEXR

from glanz.addon.export import export_scene
from glanz.addon.settings import settings_of


def link(name, data, location=(0, 0, 0)):
    """A new object in the scene."""
    ob = bpy.data.objects.new(name, data)
    ob.location = location
    bpy.context.scene.collection.objects.link(ob)
    return ob


def add_camera(location=(0, 0, 5), width=64, height=64, **attributes):
    """The scene's camera, looking down unless turned."""
    ob = link("Camera", bpy.data.cameras.new("Camera"), location)
    for name, value in attributes.items():
        setattr(ob.data, name, value)
    scene = bpy.context.scene
    scene.camera = ob
    scene.render.resolution_x, scene.render.resolution_y = width, height
    scene.glanz.samples = 4
    return ob


def new_mesh(name, vertices, faces):
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata(vertices, [], faces)
    return mesh


def add_plane(name="Plane", size=2.0, location=(0, 0, 0), mesh=None):
    """A square that faces up."""
    h = 0.5 * size
    return link(name, mesh or new_mesh(name, [(-h, -h, 0), (h, -h, 0), (h, h, 0), (-h, h, 0)], [(0, 1, 2, 3)]), location)


def add_tetrahedron(name="Tetrahedron", location=(0, 0, 0)):
    vertices = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)]
    return link(name, new_mesh(name, vertices, [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]), location)


def new_nodes(datablock):
    """The node tree of a material, world or light, emptied."""
    if datablock.node_tree is None:
        datablock.use_nodes = True
    datablock.node_tree.nodes.clear()
    return datablock.node_tree


def new_material(name, node_type, **inputs):
    """A material of one shader node; inputs by identifier, blanks as underscores."""
    material = bpy.data.materials.new(name)
    tree = new_nodes(material)
    shader = add_node(tree, node_type, **inputs)
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    tree.links.new(shader.outputs[0], output.inputs["Surface"])
    return material


def add_node(tree, node_type, **inputs):
    node = tree.nodes.new(node_type)
    for name, value in inputs.items():
        node_input(node, name.replace("_", " ")).default_value = value
    return node


def node_input(node, identifier):
    return next(socket for socket in node.inputs if socket.identifier == identifier)


def set_world(colour, strength=1.0):
    """A constant world."""
    world = bpy.data.worlds.new("World")
    tree = new_nodes(world)
    background = add_node(tree, "ShaderNodeBackground", Color=(*colour, 1), Strength=strength)
    tree.links.new(background.outputs[0], tree.nodes.new("ShaderNodeOutputWorld").inputs["Surface"])
    bpy.context.scene.world = world
    return world


def export(**overrides):
    """(engine scene, warnings) of the open file, without a render; a camera is added where there is none."""
    if bpy.context.scene.camera is None:
        add_camera()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    settings = settings_of(depsgraph.scene_eval, depsgraph.view_layer_eval, **overrides)
    return export_scene(depsgraph, settings)


def export_object(name):
    """The one engine object called `name`."""
    found = [o for o in export()[0].objects if o.name == name]
    assert len(found) == 1, f"{len(found)} objects are called {name}"
    return found[0]


def world_vertices(o):
    """(V, 3) of an engine object, in world space."""
    return (o.world_from_object[:3, :3] @ o.mesh.vertices + o.world_from_object[:3, 3:]).T


def render(path):
    """F12 into a multilayer EXR file of single precision; its path. Raises RuntimeError where the operator does."""
    scene = bpy.context.scene
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "MULTI_LAYER_IMAGE"
    image.file_format = "OPEN_EXR_MULTILAYER"
    image.color_depth = "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    return path


def compositor():
    """The tree of the scene's compositor, emptied, and its last node's input."""
    scene = bpy.context.scene
    if hasattr(scene, "compositing_node_group"):
        tree = scene.compositing_node_group = bpy.data.node_groups.new("Compositor", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        return tree, tree.nodes.new("NodeGroupOutput").inputs[0]
    scene.use_nodes = True
    scene.node_tree.nodes.clear()
    return scene.node_tree, scene.node_tree.nodes.new("CompositorNodeComposite").inputs["Image"]


def composited(path):
    """What the compositor makes of F12, (height, width, channels) float32, by way of an EXR file."""
    scene = bpy.context.scene
    image = scene.render.image_settings
    if hasattr(image, "media_type"):
        image.media_type = "IMAGE"
    image.file_format, image.color_depth = "OPEN_EXR", "32"
    scene.render.filepath = str(path)
    bpy.ops.render.render(write_still=True)
    (found,) = read_exr(path).values()
    return found


@contextmanager
def heard_by(handler):
    """Let `handler` (scene, depsgraph) hear what Blender tells of the changes that are made inside."""
    bpy.app.handlers.depsgraph_update_post.append(handler)
    try:
        yield
        bpy.context.view_layer.update()
    finally:
        bpy.app.handlers.depsgraph_update_post.remove(handler)


def read_exr(path, order="RGBAXYZ"):
    """{"Layer.Pass": (height, width, channels) float32}, row 0 at the top, channels in the `order` of Blender's names."""
    passes = {}
    with OpenEXR.File(str(path), separate_channels=True) as file:
        for part in file.parts:
            for name, channel in part.channels.items():
                key, _, letter = name.rpartition(".")
                passes.setdefault(key, {})[letter] = np.array(channel.pixels)
    return {key: np.stack([c[k] for k in sorted(c, key=order.find)], axis=-1) for key, c in passes.items()}


def header(path):
    """The header of the first part of an EXR file."""
    with OpenEXR.File(str(path), separate_channels=True) as file:
        return dict(file.parts[0].header)
