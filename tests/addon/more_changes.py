"""Random changes of what persistent data keeps: images, shapes, instances, and what is another at each frame."""

import bpy

from glanz.tests.addon.changes import NUMBERS, Changes


class MoreChanges(Changes):
    """`Changes`, and those."""

    # --- images

    def do_show_image(self):
        image = bpy.data.images.new("Image", 4, 4, float_buffer=self.rng.random() < 0.3)
        node = self._tree().nodes.new(self.rng.choice(("ShaderNodeTexImage", "ShaderNodeTexEnvironment")))
        node.image = image
        self._link(node.id_data, node)

    def do_paint(self):
        """Blender tells nobody."""
        image = self._pick(bpy.data.images)
        if image is not None and len(image.pixels):
            image.pixels[:] = [self.rng.random() for _ in image.pixels]

    def do_pack(self):
        image = self._pick(bpy.data.images)
        if image is not None:
            image.pack()

    def do_set_image(self):
        image = self._pick(bpy.data.images)
        if image is not None:
            image.alpha_mode = self.rng.choice(("STRAIGHT", "NONE", "CHANNEL_PACKED"))
            image.colorspace_settings.name = self.rng.choice(("sRGB", "Non-Color"))

    def do_reload(self):
        image = self._pick(bpy.data.images)
        if image is not None:
            image.reload()

    # --- shapes, and what moves

    def do_reshape(self):
        mesh = self._pick([mesh for mesh in bpy.data.meshes if mesh.vertices])
        if mesh is not None:
            self._pick(mesh.vertices).co = [self.rng.uniform(-2, 2) for _ in range(3)]

    def do_shape_key(self):
        ob = self._object("MESH")
        if ob is not None and ob.data.vertices:
            if ob.data.shape_keys is None:
                ob.shape_key_add(name="Basis")
            key = ob.shape_key_add(name="Key")
            key.data[0].co.x += 1
            self._animate(key, "value", (0.0, 1.0))

    def do_instance_on_faces(self):
        ob, parent = self._object("MESH", "FONT"), self._object("MESH")
        if ob is not None and ob != parent:
            ob.parent = parent
            parent.instance_type = self.rng.choice(("NONE", "VERTS", "FACES"))

    def do_geometry_nodes(self):
        """A cone, of which one is added to the mesh and two stand beside it, as high as the frame's number."""
        ob = self._object("MESH")
        if ob is None:
            return
        tree = bpy.data.node_groups.new("Geometry", "GeometryNodeTree")
        tree.interface.new_socket("Geometry", in_out="OUTPUT", socket_type="NodeSocketGeometry")
        output, kinds = tree.nodes.new("NodeGroupOutput"), ("JoinGeometry", "InstanceOnPoints", "MeshLine", "MeshCone")
        join, instances, line, cone = (tree.nodes.new(f"GeometryNode{kind}") for kind in kinds)
        line.inputs["Count"].default_value = 2
        cone.inputs["Vertices"].default_value = self.rng.randint(3, 6)
        cone.inputs["Depth"].default_value = self.rng.uniform(0.5, 2)
        links = [(line, 0, instances, "Points"), (cone, 0, instances, "Instance"), (cone, 0, join, 0), (instances, 0, join, 0)]
        if self.rng.random() < 0.5:
            links.append((tree.nodes.new("GeometryNodeInputSceneTime"), "Frame", cone, "Depth"))
        for start, out, end, to in (*links, (join, 0, output, 0)):
            tree.links.new(start.outputs[out], end.inputs[to])
        ob.modifiers.new("Geometry", "NODES").node_group = tree

    def do_key(self):
        """Something moves, or changes, from one frame to the next."""
        ob = self._object()
        owners = [(ob, "location", [[0, 0, n] for n in range(3)]), (ob, "hide_render", (True, False))]
        owners += [(modifier, "show_render", (True, False)) for modifier in getattr(ob, "modifiers", ())]
        owners += [(socket, "default_value", NUMBERS) for node in self._tree().nodes for socket in node.inputs if socket.type == "VALUE"]
        if ob is not None:
            self._animate(*self._pick(owners))

    def _animate(self, owner, path, values):
        for frame in range(4):
            setattr(owner, path, self.rng.choice(values))
            owner.keyframe_insert(path, frame=frame)
