"""Nodes that make and change colours."""


def _own(reader, node, output):
    """RGB and Value hold their value in their output."""
    value = node.outputs[0].default_value
    return float(value) if isinstance(value, float) else tuple(float(c) for c in value)[:3]


TABLE = {"RGB": _own, "VALUE": _own}
