"""Random changes of the open file, as a restless user makes them: nodes, links, objects, meshes, settings, undo.

It needs Blender and nothing else, so that it also runs where the add-on is installed under another name.
"""

import contextlib
import warnings

import bpy

NUMBERS = (0.0, -0.0, 0.2, 0.5, 1.0, -1.0, 3.7, 1e-20, 1e6, -1e6)
LOCATIONS = (-1.5, -0.5, 0.0, 0.5, 1.5, 1e5)
SCALES = (1.0, 0.5, 2.0, -1.0, 0.0, 1e-6)
MESHES = {
    "Square": ([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [(0, 1, 2, 3)]),
    "Tetrahedron": ([(0, 0, 0), (1, 0, 0), (0, 1, 0), (0, 0, 1)], [(0, 2, 1), (0, 1, 3), (1, 2, 3), (2, 0, 3)]),
    "Nothing": ([], []),
    "Needle": ([(0, 0, 0), (1, 0, 0), (2, 0, 0)], [(0, 1, 2)]),
    "Points": ([(0, 0, 0), (1, 1, 1)], []),
}
MODIFIERS = ("SUBSURF", "ARRAY", "MIRROR", "TRIANGULATE", "SOLIDIFY", "DECIMATE")
MOST_OBJECTS = 12
MOST_NODES = 24


class Changes:
    """Changes by the random numbers of `rng`, a `random.Random`; the same seed gives the same ones in one version of Blender.

    `window` makes the context in which a Blender with windows undoes.
    """

    def __init__(self, rng, window=contextlib.nullcontext):
        self.rng = rng
        self._window = window
        self.log = []
        self._nodes = _shader_nodes()
        self._kinds = [getattr(self, name) for name in sorted(dir(self)) if name.startswith("do_")]
        # A tree takes many changes until it does something.
        self._kinds += 3 * [self.do_add_node, self.do_link, self.do_set_socket, self.do_set_mode]
        start()
        self._remember("start")

    def make(self, count):
        """`count` changes; their names are added to `log`. What Blender itself refuses is no change."""
        for _ in range(count):
            kind = self.rng.choice(self._kinds)
            # Blender refuses what makes no sense, as to link a value to a shader's socket.
            with contextlib.suppress(RuntimeError, TypeError), warnings.catch_warnings(action="ignore"):
                kind()
                self.log.append(kind.__name__.removeprefix("do_"))
            if kind.__name__ != "do_undo":
                self._remember(kind.__name__)
        if bpy.context.scene.camera is None:
            self.new_camera()

    def new_camera(self):
        """Another camera in the place of the present one, if any: Blender renders nothing without one."""
        if bpy.context.scene.camera is not None:
            bpy.data.objects.remove(bpy.context.scene.camera)
        _add_camera()
        self._remember("new camera")

    def _remember(self, name):
        # After every change: whatever Blender's undo does not know of it leaves dangling.
        with self._window():
            bpy.ops.ed.undo_push(message=name)

    def _pick(self, things):
        things = list(things)
        return self.rng.choice(things) if things else None

    def _tree(self):
        return self._pick([block.node_tree for block in (*bpy.data.materials, *bpy.data.worlds, *bpy.data.lights) if block.node_tree])

    # --- nodes

    def do_add_node(self):
        tree = self._tree()
        if len(tree.nodes) < MOST_NODES:
            node = tree.nodes.new(self.rng.choice(self._nodes))
            self._link(tree, node)

    def _link(self, tree, node):
        outputs = [socket for socket in node.outputs if socket.enabled]
        inputs = [socket for other in tree.nodes if other != node for socket in other.inputs if socket.enabled]
        start = self._pick(outputs)
        # A shader belongs into a shader's socket; all others take each other's values.
        fitting = [socket for socket in inputs if start and (socket.type == "SHADER") == (start.type == "SHADER")]
        if fitting:
            tree.links.new(start, self._pick(fitting))

    def do_link(self):
        tree = self._tree()
        self._link(tree, self._pick(tree.nodes))

    def do_remove_node(self):
        tree = self._tree()
        if len(tree.nodes) > 2:
            tree.nodes.remove(self._pick(tree.nodes))

    def do_remove_link(self):
        tree = self._tree()
        if tree.links:
            tree.links.remove(self._pick(tree.links))

    def do_set_socket(self):
        node = self._pick(self._tree().nodes)
        socket = self._pick([one for one in node.inputs if hasattr(one, "default_value")])
        if socket is not None:
            value = socket.default_value
            if isinstance(value, float):
                socket.default_value = self.rng.choice(NUMBERS)
            elif hasattr(value, "__len__") and not isinstance(value, str):
                socket.default_value = [self.rng.choice(NUMBERS) for _ in value]

    def do_set_mode(self):
        node = self._pick(self._tree().nodes)
        # What all nodes have in common describes the node's class: to change that breaks Blender.
        common = bpy.types.ShaderNode.bl_rna.properties
        own = (p for p in node.bl_rna.properties if p.identifier not in common)
        modes = [p for p in own if p.type == "ENUM" and not p.is_readonly and not p.is_enum_flag]
        mode = self._pick(modes)
        if mode:
            setattr(node, mode.identifier, self._pick(mode.enum_items.keys()))

    def do_mute_node(self):
        node = self._pick(self._tree().nodes)
        node.mute = not node.mute

    # --- objects

    def _object(self, *kinds):
        return self._pick([ob for ob in bpy.context.scene.objects if not kinds or ob.type in kinds])

    def do_add_mesh(self):
        if len(bpy.data.objects) < MOST_OBJECTS:
            name = self._pick(MESHES)
            mesh = bpy.data.meshes.new(name)
            mesh.from_pydata(MESHES[name][0], [], MESHES[name][1])
            mesh.materials.append(self._pick(bpy.data.materials))
            _link(name, mesh)

    def do_add_light(self):
        if len(bpy.data.objects) < MOST_OBJECTS:
            kind = self.rng.choice(("POINT", "SPOT", "SUN", "AREA"))
            light = bpy.data.lights.new(kind, kind)
            light.energy = self.rng.choice((0.0, 10.0, 1000.0))
            _link(kind, light).location.z = 3

    def do_add_curve(self):
        if len(bpy.data.objects) < MOST_OBJECTS:
            text = bpy.data.curves.new("Text", "FONT")
            text.body = "g"
            text.extrude = 0.1
            _link("Text", text)

    def do_add_instances(self):
        if len(bpy.data.objects) < MOST_OBJECTS:
            collection = bpy.data.collections.new("Collection")
            collection.objects.link(self._object("MESH", "FONT", "LIGHT"))
            empty = _link("Instances", None)
            empty.instance_type = "COLLECTION"
            empty.instance_collection = collection

    def do_delete_object(self):
        ob = self._object()
        if ob is not None:
            bpy.data.objects.remove(ob)

    def do_swap_mesh(self):
        ob = self._object("MESH")
        if ob is not None:
            ob.data = self._pick(bpy.data.meshes)

    def do_delete_mesh(self):
        mesh = self._pick(bpy.data.meshes)
        if mesh is not None:
            bpy.data.meshes.remove(mesh)

    def do_delete_material(self):
        if len(bpy.data.materials) > 1:
            bpy.data.materials.remove(self._pick(bpy.data.materials))

    def do_new_material(self):
        if len(bpy.data.materials) < 6:
            _new_material()

    def do_set_material(self):
        ob = self._object("MESH", "FONT")
        if ob is not None and ob.data.materials:
            ob.data.materials[0] = self._pick([None, *bpy.data.materials])

    def do_transform(self):
        ob = self._object()
        if ob is not None:
            ob.location = [self.rng.choice(LOCATIONS) for _ in range(3)]
            ob.rotation_euler = [self.rng.uniform(-3, 3) for _ in range(3)]
            ob.scale = [self.rng.choice(SCALES) for _ in range(3)]

    def do_parent(self):
        ob, parent = self._object(), self._object()
        if ob is not None and ob != parent:
            ob.parent = parent

    def do_hide(self):
        ob = self._object()
        if ob is not None:
            ob.hide_render = not ob.hide_render

    def do_modify(self):
        ob = self._object("MESH")
        if ob is not None and len(ob.modifiers) > 1:
            ob.modifiers.clear()
        elif ob is not None:
            ob.modifiers.new("Modifier", self.rng.choice(MODIFIERS))

    def do_set_visibility(self):
        ob = self._object()
        if ob is not None:
            for kind in ("camera", "diffuse", "glossy", "transmission", "shadow"):
                setattr(ob, f"visible_{kind}", self.rng.random() < 0.7)
            ob.is_holdout = self.rng.random() < 0.2

    def do_set_light(self):
        ob = self._object("LIGHT")
        if ob is not None:
            ob.data.type = self.rng.choice(("POINT", "SPOT", "SUN", "AREA"))

    # --- the camera, the world and settings

    def do_set_camera(self):
        camera = bpy.context.scene.camera
        if camera is not None:
            camera.data.type = self.rng.choice(("PERSP", "ORTHO", "PANO"))
            # The only panorama that Glanz renders; others it refuses.
            owner = camera.data if hasattr(camera.data, "panorama_type") else camera.data.cycles
            owner.panorama_type = "EQUIRECTANGULAR"
            camera.data.lens = self.rng.choice((1.0, 35.0, 1000.0))
            camera.data.dof.use_dof = self.rng.random() < 0.5
            camera.data.dof.focus_distance = self.rng.choice((0.1, 5.0))

    def do_set_world(self):
        scene = bpy.context.scene
        scene.world = self._pick([None, *bpy.data.worlds])

    def do_set_engine(self):
        settings = bpy.context.scene.glanz
        for name in ("integrator", "sampler", "pixel_filter"):
            # Choices that are made by a function have no items in their type.
            choices = [item[0] for item in _choices(settings, name)]
            setattr(settings, name, self.rng.choice(choices))
        settings.samples = self.rng.choice((1, 2, 3))
        settings.max_depth = self.rng.choice((0, 1, 3))
        settings.adaptive_threshold = self.rng.choice((0.0, 0.1))
        settings.branches = 2

    def do_set_render(self):
        render = bpy.context.scene.render
        render.film_transparent = self.rng.random() < 0.5
        render.use_motion_blur = self.rng.random() < 0.3
        render.use_border = self.rng.random() < 0.3
        render.border_min_x, render.border_max_x = self.rng.choice(((0.0, 1.0), (0.3, 0.6), (0.5, 0.7)))
        render.use_multiview = self.rng.random() < 0.2

    def do_set_pass(self):
        layer = bpy.context.view_layer
        owner = self._pick([layer, layer.glanz])
        names = [p.identifier for p in owner.bl_rna.properties if p.type == "BOOLEAN" and p.identifier.startswith("use_pass")]
        if names:
            setattr(owner, self._pick(names), self.rng.random() < 0.7)

    def do_set_frame(self):
        bpy.context.scene.frame_set(self.rng.randint(0, 9))

    def do_undo(self):
        with self._window():
            bpy.ops.ed.undo()


def start():
    """A small scene in the place of what is open: a camera, a light, a few meshes and materials."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True, load_ui=False)
    scene = bpy.context.scene
    scene.render.engine = "GLANZ"
    scene.render.resolution_x, scene.render.resolution_y = 12, 8
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    scene.glanz.samples = 1
    scene.world = bpy.data.worlds.new("World")
    _see_to_tree(scene.world)
    for n in range(2):
        material = _new_material()
        mesh = bpy.data.meshes.new("Square")
        mesh.from_pydata(MESHES["Square"][0], [], MESHES["Square"][1])
        mesh.materials.append(material)
        _link("Square", mesh).location.z = n
    _add_camera()


def _see_to_tree(block):
    if block.node_tree is None:
        block.use_nodes = True


def _new_material():
    material = bpy.data.materials.new("Material")
    _see_to_tree(material)
    return material


def _add_camera():
    bpy.context.scene.camera = _link("Camera", bpy.data.cameras.new("Camera"))
    bpy.context.scene.camera.location.z = 5


def _link(name, data):
    ob = bpy.data.objects.new(name, data)
    bpy.context.scene.collection.objects.link(ob)
    return ob


def _choices(settings, name):
    """The items of an EnumProperty that a function makes."""
    return type(settings).__annotations__[name].keywords["items"](settings, bpy.context)


def _shader_nodes():
    """The names of all nodes that a material of this Blender may have."""
    found = []
    tree = _new_material().node_tree
    with warnings.catch_warnings(action="ignore"):
        names = [name for name in sorted(dir(bpy.types)) if name.startswith("ShaderNode") and "Group" not in name]
    for name in names:
        # Base classes cannot be made.
        with contextlib.suppress(RuntimeError):
            tree.nodes.new(name)
            found.append(name)
    return found
