"""What must agree with Cycles, and what does not, and why."""

_POLES = "where it divides by next to nothing: both engines look at places that are up to a hundredth of a pixel apart"
_ROUNDED = "; and, from Blender 5.0 on, Cycles rounds the remainders of vectors a million times as long as what they are divided by"

NODES = {
    "ShaderNodeMath": (_POLES, lambda case: case.properties.get("operation") == "DIVIDE"),
    "ShaderNodeVectorMath": (_POLES + _ROUNDED, lambda case: case.properties.get("operation") in ("DIVIDE", "MODULO")),
    "ShaderNodeMapRange": (_POLES, lambda case: case.properties.get("interpolation_type") in ("LINEAR", "STEPPED")),
}
"""{node type: (reason, condition (case))}."""


def excuse(case):
    """The reason why a case may differ, or None."""
    reason, applies = NODES.get(case.kind, (None, None))
    return reason if reason and applies(case) else None


def bar(kind):
    """The share of pixels that must agree."""
    return 0.98 if kind.startswith("ShaderNodeTex") and kind != "ShaderNodeTexCoord" else 0.99
