"""What must agree with Cycles, and what does not, and why."""

NODES = {
    "ShaderNodeMapping": ("only constant locations, rotations and scales are read", None),
}
"""{node type: (reason, condition (case) or None for all cases)}."""


def excuse(case):
    """The reason why a case may differ, or None."""
    reason, applies = NODES.get(case.kind, (None, None))
    return reason if reason and (applies is None or applies(case)) else None


def bar(kind):
    """The share of pixels that must agree."""
    return 0.98 if kind.startswith("ShaderNodeTex") and kind != "ShaderNodeTexCoord" else 0.99
