"""Reading Blender's node trees: what feeds a socket, and which constant it holds.

Nodes and sockets are found by type and identifier, never by name: names are translated and renamed.
"""

from .findings import APPROXIMATED, IGNORED, MISSING
from .missing import is_missing


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


def aov_nodes(links, tree):
    """(links, node) for each AOV Output node of a tree and of the groups in it; `links` follow those of that tree."""
    for node in tree.nodes:
        if node.mute:
            continue
        if node.type == "OUTPUT_AOV":
            yield links, node
        elif node.type == "GROUP" and node.node_tree:
            yield from aov_nodes(links.inside(node), node.node_tree)


def words(mode):
    """Blender's identifier of a mode as the engine's name: in lower case, with blanks."""
    return mode.lower().replace("_", " ")


def _counts(link):
    # Cycles ignores the same ones.
    return not link.is_muted and link.from_socket.enabled and link.to_socket.enabled


DEEPEST = 1000
"""Nodes in a row, from the output on, that are followed."""


class Links:
    """Follows the links of one node tree and of the groups in it, and notes what is odd about them.

    Blender looks through all links of a tree for those of a socket, so that they are looked through once for all.

    owner   who is named in notes, such as "material 'Wood'"
    groups  the group nodes entered, outermost first
    trail   the nodes passed on the way from the output, each with the groups it is in
    """

    def __init__(self, owner, findings, groups=(), trail=(), links=None):
        self.owner = owner
        self.findings = findings
        self.groups = groups
        self.trail = trail
        self._links = {} if links is None else links

    def _elsewhere(self, groups, trail):
        return type(self)(self.owner, self.findings, groups, trail, self._links)

    def _link(self, socket):
        """The first link into an input `socket` that is neither muted nor at a socket that a mode has put away, or None.

        A node may lack an input, as a light's output in a material.
        """
        if socket is None:
            return None
        tree = socket.id_data
        key = tree.as_pointer()
        if key not in self._links:
            # The first of several counts.
            self._links[key] = {link.to_socket.as_pointer(): link for link in [*tree.links][::-1] if _counts(link)}
        return self._links[key].get(socket.as_pointer())

    def beyond(self, node):
        """A reader for what feeds `node`, or None, with a note, where that leads back to `node` itself, or too deep."""
        if (node, self.groups) in self.trail:
            self.note("its nodes form a circle, which is cut off")
            return None
        if len(self.trail) >= DEEPEST:
            self.note(f"its nodes feed each other more than {DEEPEST} deep, what is beyond '{node.name}' is cut off", IGNORED)
            return None
        return self._elsewhere(self.groups, (*self.trail, (node, self.groups)))

    def inside(self, group):
        """A reader for the tree of the node `group`."""
        return self._elsewhere((*self.groups, group), self.trail)

    def note(self, what, kind=APPROXIMATED):
        """Record what happened to the node that is being read."""
        node, groups = self.trail[-1] if self.trail else (None, ())
        self.findings.note(what, self.owner, kind, tuple(n.name for n in (*groups, node)) if node else ())

    def source(self, socket):
        """(reader, socket, output): the output that feeds an input `socket`, None if nothing does.

        Goes through reroutes, muted nodes and groups; `reader` reads in the tree where the search ended, and `socket`
        is the last input on the way, whose own value counts where nothing feeds it.
        """
        reader = self
        while link := reader._link(socket):
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
            if node.node_tree is None or is_missing(node.node_tree):
                self.note("the node group is missing", MISSING)
                return self, None
            inside = next((n for n in node.node_tree.nodes if n.type == "GROUP_OUTPUT" and n.is_active_output), None)
            return self.inside(node), inside and input_by_identifier(inside, output.identifier)
        if node.type == "GROUP_INPUT" and self.groups:
            return self._elsewhere(self.groups[:-1], self.trail), input_by_identifier(self.groups[-1], output.identifier)
        return None

    def is_linked(self, node, identifier):
        """Whether a node feeds the input."""
        socket = input_by_identifier(node, identifier)
        return socket is not None and self.source(socket)[2] is not None
