"""Kinds of rays, which things may be hidden from."""

from ..errors import SceneError

RAY_KINDS = ("camera", "diffuse", "glossy", "transmission", "shadow")
"""From the camera; scattered last by a diffuse or glossy reflection, or through a surface; towards a light. Straight on is no kind."""


def hidden_from(kinds, owner):
    """The different `kinds` (a sequence of names), in the order of `RAY_KINDS`. Raises SceneError, naming `owner`, for an unknown one."""
    kinds = {*kinds}
    unknown = kinds.difference(RAY_KINDS)
    if unknown:
        raise SceneError(f"{owner} is hidden from {', '.join(sorted(map(repr, unknown)))}, allowed: {', '.join(RAY_KINDS)}")
    return tuple(kind for kind in RAY_KINDS if kind in kinds)
