"""Sunflowers of thousands of instances: florets by geometry nodes, whole flowers as instances of a collection."""

import math

import bpy
import common
from mathutils import Matrix

FLORETS = 900
"""Instances in each flower."""
FLOWERS = ((-2.35, 0.9, 0.82, 20), (2.4, 0.75, 0.86, 75), (-1.35, -1.75, 0.5, 130), (1.5, -1.7, 0.55, 190), (0.15, 2.75, 0.8, 250))
"""x, y [m], scale and turn [degrees] of the flowers that are instances of the first, which stands in the middle."""
GOLDEN_ANGLE = math.pi * (3 - math.sqrt(5))
# The share of the radius at which each kind of floret ends, its colour, and its size and lean.
KINDS = (
    ("Seed", 0.45, (0.07, 0.03, 0.02)),
    ("Pollen", 0.66, (0.62, 0.2, 0.02)),
    ("Petal", 1.0, (0.9, 0.46, 0.02)),
)


def floret(name, material, segments, rings):
    """A drop with its foot at the origin that grows along z."""
    made = common.sphere(name, 1.0, material, segments, rings)
    for vertex in made.vertices:
        x, y, z = vertex.co
        taper = 0.5 * (1 - 0.55 * z)
        vertex.co = (x * taper, y * taper, 0.5 * (z + 1))
    return made


def florets(scene, detail):
    """A collection with one floret of each kind, outside the scene: it is only seen as instances."""
    collection = bpy.data.collections.new("Florets")
    for name, _, colour in KINDS:
        made = floret(name, common.diffuse(name, colour), segments=2 * detail, rings=detail)
        common.add(scene, name, made, collection=collection)
    return collection


def spiral(count):
    """Points in a golden spiral over a shallow dome, with what each floret needs to know as attributes."""
    points, kinds, sizes, turns = [], [], [], []
    for i in range(count):
        share = math.sqrt((i + 0.5) / count)
        phi = i * GOLDEN_ANGLE
        kind = next(k for k, (_, end, _) in enumerate(KINDS) if share <= end)
        inside = share / KINDS[-1][1]
        points.append((share * math.cos(phi), share * math.sin(phi), 0.34 * (1 - share * share)))
        kinds.append(kind)
        grown = 0.055 + 0.035 * inside
        sizes.append((grown, grown, (0.09, 0.16, 0.3 + 0.14 * inside)[kind]))
        # Leaning outwards: first about y, then turned about z.
        turns.append((0.0, (0.5, 0.75, 1.15)[kind] * inside, phi))
    made = common.mesh("Spiral", points, [])
    for name, kind, values in (("kind", "INT", kinds), ("size", "FLOAT_VECTOR", sizes), ("turn", "FLOAT_VECTOR", turns)):
        attribute = made.attributes.new(name, kind, "POINT")
        if kind == "INT":
            attribute.data.foreach_set("value", values)
        else:
            attribute.data.foreach_set("vector", [component for vector in values for component in vector])
    return made


def growth(collection):
    """Geometry nodes that put a floret of the right kind, size and turn on each point."""
    tree = bpy.data.node_groups.new("Growth", "GeometryNodeTree")
    tree.interface.new_socket("Geometry", in_out="INPUT", socket_type="NodeSocketGeometry")
    tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")

    def node(kind, x, y=0, **attributes):
        made = tree.nodes.new(kind)
        made.location = (x, y)
        for key, value in attributes.items():
            setattr(made, key, value)
        return made

    def attribute(name, data_type, y):
        made = node("GeometryNodeInputNamedAttribute", -400, y, data_type=data_type)
        made.inputs["Name"].default_value = name
        return next(socket for socket in made.outputs if socket.enabled and socket.name == "Attribute")

    source = node("NodeGroupInput", -400, 200)
    put = node("GeometryNodeInstanceOnPoints", 0)
    result = node("NodeGroupOutput", 250)
    kinds = node("GeometryNodeCollectionInfo", -400, 60)
    kinds.inputs["Collection"].default_value = collection
    kinds.inputs["Separate Children"].default_value = True
    put.inputs["Pick Instance"].default_value = True
    link = tree.links.new
    link(source.outputs["Geometry"], put.inputs["Points"])
    link(kinds.outputs[0], put.inputs["Instance"])
    link(attribute("kind", "INT", -120), put.inputs["Instance Index"])
    link(attribute("turn", "FLOAT_VECTOR", -260), put.inputs["Rotation"])
    link(attribute("size", "FLOAT_VECTOR", -400), put.inputs["Scale"])
    link(put.outputs["Instances"], result.inputs["Geometry"])
    return tree


def build(count=FLORETS, detail=6):
    """The scene with `count` florets in each flower; a floret has 4 detail (detail - 1) triangles."""
    scene = common.new_scene("Instances", 768, 512, samples=64, max_depth=5)
    flower = bpy.data.collections.new("Flower")
    scene.collection.children.link(flower)
    # Collection Info sorts its children by name.
    names = sorted(name for name, _, _ in KINDS)
    points = spiral(count)
    order = [names.index(name) for name, _, _ in KINDS]
    stored = points.attributes["kind"].data
    for element in stored:
        element.value = order[element.value]
    head = common.add(scene, "Flower", points, Matrix.Translation((0.0, 0.0, 0.12)), collection=flower)
    head.modifiers.new("Growth", "NODES").node_group = growth(florets(scene, detail))
    for number, (x, y, scale, turn) in enumerate(FLOWERS, 2):
        made = common.add(scene, f"Flower {number}", None)
        made.instance_type, made.instance_collection = "COLLECTION", flower
        made.matrix_world = Matrix.Translation((x, y, 0.0)) @ Matrix.Rotation(math.radians(turn), 4, "Z") @ Matrix.Scale(scale, 4)
    ground = common.diffuse("Ground", (0.16, 0.28, 0.33))
    common.add(scene, "Ground", common.quad("Ground", (-30, -30, 0), (60, 0, 0), (0, 60, 0), ground))
    common.light(scene, "Sun", "SUN", (-4.0, -2.0, 5.0), (0.0, 0.0, 0.0), 3.4, angle=math.radians(6), color=(1.0, 0.9, 0.74))
    scene.world = common.world((0.5, 0.7, 1.0), 0.5)
    common.camera(scene, (0.0, -7.0, 7.0), (0.0, 0.22, 0.0), lens=49.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
