"""Node trees of materials in few words, for the scripts of the sample scenes."""

import bpy
import common


class Net:
    """The node tree of a new material: `net(kind, ...)` adds a node, and hands out its output."""

    def __init__(self, name):
        self.material = bpy.data.materials.new(name)
        self.tree = common.empty_tree(self.material)
        self._count = 0

    def __call__(self, kind, out=0, **values):
        """The output `out` (number or identifier) of a new node of Blender's `kind`.

        `values` are attributes of the node (lower case), or its inputs by identifier, "_" for blanks; outputs are linked.
        """
        node = self.tree.nodes.new(f"ShaderNode{kind}")
        node.location = (-260 * (self._count % 6), -300 * (self._count // 6))
        self._count += 1
        for name, value in values.items():
            if name.islower():
                setattr(node, name, value)
            else:
                self._feed(self._socket(node, name.replace("_", " "), name), value)
        return node.outputs[out] if isinstance(out, int) else next(s for s in node.outputs if s.identifier == out)

    @staticmethod
    def _socket(node, *identifiers):
        return next(s for s in node.inputs if s.identifier in identifiers)

    def _feed(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif socket.type == "RGBA" and len(value) == 3:
            socket.default_value = (*value, 1.0)
        else:
            socket.default_value = value

    def coordinates(self, source="Object", scale=(1.0, 1.0, 1.0), rotation=(0.0, 0.0, 0.0)):
        """Texture coordinates, scaled and turned."""
        return self("Mapping", Vector=self("TexCoord", source), Scale=scale, Rotation=rotation)

    def ramp(self, factor, *stops, interpolation="LINEAR"):
        """A colour ramp of `stops` (place, (r, g, b))."""
        output = self("ValToRGB", Fac=factor)
        ramp = output.node.color_ramp
        ramp.interpolation = interpolation
        while len(ramp.elements) < len(stops):
            ramp.elements.new(1.0)
        for element, (place, colour) in zip(ramp.elements, stops):
            element.position, element.color = place, (*colour, 1.0)
        return output

    def mix(self, factor, a, b, blend="MIX"):
        """Two colours, mixed."""
        return self("Mix", "Result_Color", data_type="RGBA", blend_type=blend, Factor_Float=factor, A_Color=a, B_Color=b)

    def math(self, operation, *values):
        """A Math node of one to three values."""
        output = self("Math", operation=operation)
        for socket, value in zip(output.node.inputs, values):
            self._feed(socket, value)
        return output

    def vector(self, operation, *values):
        """A Vector Math node."""
        output = self("VectorMath", operation=operation)
        for socket, value in zip(output.node.inputs, values):
            self._feed(socket, value)
        return output

    def bump(self, height, strength, distance):
        """Normals of a relief; `distance` [m]."""
        return self("Bump", Height=height, Strength=strength, Distance=distance)

    def principled(self, **values):
        """A Principled BSDF."""
        return self("BsdfPrincipled", **values)

    def shaders(self, factor, first, second):
        """Two shaders, mixed."""
        output = self("MixShader", Fac=factor)
        for socket, value in zip(output.node.inputs[1:], (first, second)):
            self.tree.links.new(value, socket)
        return output

    def done(self, shader):
        """The material, whose surface is `shader`."""
        output = self.tree.nodes.new("ShaderNodeOutputMaterial")
        output.location = (300, 0)
        self.tree.links.new(shader, output.inputs["Surface"])
        return self.material
