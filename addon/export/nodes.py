"""Reading Blender's node trees: what feeds a socket, and which constant it holds.

Nodes and sockets are found by type and identifier, never by name: names are translated and renamed.
"""

_RGB_WEIGHTS = (0.2126, 0.7152, 0.0722)


def has_nodes(datablock):
    """Whether the nodes of a material, world or light count; `use_nodes` means nothing any more where it is deprecated."""
    if datablock.node_tree is None:
        return False
    is_deprecated = getattr(datablock.bl_rna.properties["use_nodes"], "is_deprecated", False)
    return is_deprecated or datablock.use_nodes


def output_node(tree):
    """The active output node of a material, world or light, or None. Outputs meant for Cycles count, as it traces rays too."""
    return tree.get_output_node("CYCLES")


def input_by_identifier(node, identifier):
    """The input socket of `node` with this identifier, or None where this version of Blender has none."""
    return next((socket for socket in node.inputs if socket.identifier == identifier), None)


class Reader:
    """Reads the sockets of one node tree and of the groups in it, and notes what it cannot read.

    owner   who is named in notes, such as "material 'Wood'"
    bitmaps the images of textures, or None where textures are not read
    groups  the group nodes entered, outermost first
    trail   the nodes passed on the way from the output, each with the groups it is in
    """

    def __init__(self, owner, findings, bitmaps=None, groups=(), trail=()):
        self.owner = owner
        self.findings = findings
        self.bitmaps = bitmaps
        self.groups = groups
        self.trail = trail

    def _elsewhere(self, groups, trail):
        return Reader(self.owner, self.findings, self.bitmaps, groups, trail)

    def beyond(self, node):
        """A reader for what feeds `node`, or None, with a note, where that leads back to `node` itself."""
        if (node, self.groups) in self.trail:
            self.note("its nodes form a circle, which is cut off")
            return None
        return self._elsewhere(self.groups, (*self.trail, (node, self.groups)))

    def note(self, what):
        self.findings.note(what, self.owner)

    def source(self, socket):
        """(reader, socket, output): the output that feeds an input `socket`, None if nothing does.

        Goes through reroutes, muted nodes and groups; `reader` reads in the tree where the search ended, and `socket`
        is the last input on the way, whose own value counts where nothing feeds it.
        """
        reader = self
        while link := next((link for link in socket.links if not link.is_muted), None):
            beyond = reader.beyond(link.from_node)
            if beyond is None:
                return reader, socket, None
            onwards = beyond._passed_on(link.from_node, link.from_socket)
            if onwards is None:
                return reader, socket, link.from_socket
            reader, next_socket = onwards
            if next_socket is None:
                return reader, socket, None
            socket = next_socket
        return reader, socket, None

    def _passed_on(self, node, output):
        """(reader, input socket) whose value `output` only passes on, or None where `node` makes a value of its own."""
        if node.mute:
            return self, next((link.from_socket for link in node.internal_links if link.to_socket == output), None)
        if node.type == "REROUTE":
            return self, node.inputs[0]
        if node.type == "GROUP":
            if node.node_tree is None:
                self.note(f"the node group of '{node.name}' is missing")
                return self, None
            inside = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
            reader = self._elsewhere((*self.groups, node), self.trail)
            return reader, inside and input_by_identifier(inside, output.identifier)
        if node.type == "GROUP_INPUT" and self.groups:
            reader = self._elsewhere(self.groups[:-1], self.trail)
            return reader, input_by_identifier(self.groups[-1], output.identifier)
        return None

    def is_linked(self, node, identifier):
        """Whether a node feeds the input."""
        socket = input_by_identifier(node, identifier)
        return socket is not None and self.source(socket)[2] is not None

    def colour(self, node, identifier, default=(0.0, 0.0, 0.0)):
        """The constant of an input as (r, g, b)."""
        value = self._constant(node, identifier, default)
        return tuple(value) if isinstance(value, tuple) else (value,) * 3

    def number(self, node, identifier, default=0.0):
        """The constant of an input as a float; a colour counts with its luminance."""
        value = self._constant(node, identifier, default)
        return sum(w * c for w, c in zip(_RGB_WEIGHTS, value, strict=True)) if isinstance(value, tuple) else value

    def _constant(self, node, identifier, default):
        socket = input_by_identifier(node, identifier)
        if socket is None:
            return default
        _, end, output = self.source(socket)
        if output is not None:
            if output.node.type in ("RGB", "VALUE"):
                return _value(output, default)
            source = output.node.bl_label
            self.note(f"{identifier} of {node.bl_label} is linked to {source}, which is not read; the socket's own value is used")
            end = socket
        return _value(end, default)


def _value(socket, default):
    value = getattr(socket, "default_value", default)
    if isinstance(value, (bool, int, float)):
        return float(value)
    return tuple(float(c) for c in value)[:3]
