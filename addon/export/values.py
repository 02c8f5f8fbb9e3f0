"""Reading the values of sockets: constants, or the engine's textures where nodes make them vary."""

from ...engine import Average, Luminance, folded, is_texture
from . import environment, nodes_colours, nodes_converters, nodes_images, nodes_inputs, nodes_lights, nodes_patterns, nodes_sky
from .bitmaps import Bitmaps
from .colours import typical, varies
from .findings import IGNORED
from .nodes import Links, input_by_identifier

TABLE = {
    **environment.TABLE,
    **nodes_colours.TABLE,
    **nodes_converters.TABLE,
    **nodes_images.TABLE,
    **nodes_inputs.TABLE,
    **nodes_lights.TABLE,
    **nodes_patterns.TABLE,
    **nodes_sky.TABLE,
}
"""Node type -> function (reader, node, identifier of the output) -> value, in the kind of the output's socket."""
_TRIPLES = ("RGBA", "VECTOR")
_AT_ONCE = 24
"""Nodes, one within the other, that are read on Python's stack, which holds 1,000 frames: each takes up to twelve."""
MOST = 10_000
"""Nodes that are read for a material, those of groups each time that the group is used: groups in groups may be countless."""


class _Later(Exception):
    """What is to be read first, the arguments of `_Known.read`."""


class _Known:
    """What has been worked out: {(groups, node, output): value}; and how many nodes are being read, one within the other."""

    def __init__(self):
        self.values, self.depth = {}, 0

    def read(self, key, make):
        self.depth += 1
        try:
            self.values[key] = make()
        finally:
            self.depth -= 1


class Reader(Links):
    """Reads the values of sockets: a number, three numbers, a texture, or `Coordinates`, which stand for vectors.

    bitmaps  the images of textures; None: whoever asks has no points to look textures up at
    known    the `_Known` of the whole material: what feeds several sockets is worked out once and is one value for all
    """

    def __init__(self, owner, findings, bitmaps=None, groups=(), trail=(), links=None, known=None):
        super().__init__(owner, findings, groups, trail, links)
        self.has_points = bitmaps is not None
        self.bitmaps = bitmaps if self.has_points else Bitmaps()
        self._known = known or _Known()

    def _elsewhere(self, groups, trail):
        reader = Reader(self.owner, self.findings, self.bitmaps, groups, trail, self._links, self._known)
        reader.has_points = self.has_points
        return reader

    def beyond(self, node):
        """See `Links.beyond`."""
        if len(self._known.values) >= MOST:
            self.note(f"its nodes are more than {MOST}, those of groups counted each time: '{node.name}' and others are cut off", IGNORED)
            return None
        return super().beyond(node)

    def value(self, node, identifier, default=0.0):
        """The value of an input in the kind of its socket; `default` where this version of Blender has no such input."""
        socket = input_by_identifier(node, identifier)
        return default if socket is None else self.value_of(socket, default)

    def vector(self, node, default, identifier="Vector"):
        """The same for the vector at which a texture is looked up: `default` where nothing feeds it."""
        return self.value(node, identifier, default) if self.is_linked(node, identifier) else default

    def colour(self, node, identifier, default=(0.0, 0.0, 0.0)):
        """The value of an input as a constant (r, g, b); what varies counts with its average, and is noted."""
        value = self._constant(node, identifier, default)
        return value if isinstance(value, tuple) else (value,) * 3

    def number(self, node, identifier, default=0.0):
        """The value of an input as a constant number; what varies counts with its average, and is noted."""
        value = self._constant(node, identifier, default)
        return _as_kind(value, "RGBA", "VALUE") if isinstance(value, tuple) else value

    def value_of(self, socket, default=0.0):
        """The value of an input `socket`."""
        reader, end, output = self.source(socket)
        if output is not None:
            found = reader._read(output)
            if found is not None and (self.has_points or not varies(found)):
                return _as_kind(found, output.type, socket.type)
            where = f"{socket.identifier} of {socket.node.bl_label}"
            self.note(f"{where} is linked to {output.node.bl_label}, which is not read; the socket's own value is used", IGNORED)
            end = socket
        return _as_kind(_own_value(end, default), end.type, socket.type)

    def _constant(self, node, identifier, default):
        value = self.value(node, identifier, default)
        if not varies(value):
            return value
        self.note(f"{identifier} of {node.bl_label} varies, which is not rendered; its average is used")
        return typical(value)

    def _read(self, output):
        """The value of an output, or None where its node is not known, or feeds itself."""
        node, inside = output.node, self.beyond(output.node)
        if inside is None:
            return None

        def make():
            read = TABLE.get(node.type)
            value = read and read(inside, node, output.identifier)
            return folded(value) if is_texture(value) else value

        return self.once(output, make)

    def once(self, output, make):
        """What `make`() returns for an output in these groups, worked out once.

        What is too deep for the stack is worked out first, by itself; then what has asked for it starts anew.
        """
        key = (tuple(group.as_pointer() for group in self.groups), output.node.as_pointer(), output.identifier)
        known, waiting = self._known, [(key, make)]
        if known.depth == _AT_ONCE and key not in known.values:
            raise _Later(key, make)
        while waiting:
            if waiting[-1][0] in known.values:
                waiting.pop()
                continue
            try:
                known.read(*waiting[-1])
            except _Later as later:
                if known.depth:
                    raise
                waiting.append(later.args)
        return known.values[key]


def _as_kind(value, source, target):
    """A value of a socket of type `source` as one of type `target` takes it."""
    if target in _TRIPLES:
        return value if varies(value) or isinstance(value, tuple) else (value,) * 3
    if source not in _TRIPLES or not (varies(value) or isinstance(value, tuple)):
        return value
    return folded((Luminance if source == "RGBA" else Average)(value))


def _own_value(socket, default):
    value = getattr(socket, "default_value", default)
    if isinstance(value, (bool, int, float)):
        return float(value)
    # Without the alpha of a colour; a vector of two numbers has no third.
    return (*(float(c) for c in value), 0.0)[:3]
