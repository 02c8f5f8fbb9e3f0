"""Which rays see an object: its own ray visibility, that of what it is an instance of, and what the view layer says."""

from dataclasses import replace

from ...engine import RAY_KINDS


def sights_of(instance, part, view_layer):
    """The `part` of an instance as its rays see it: once, twice where the camera sees it held out, or never.

    `view_layer` is evaluated. As Cycles: holdouts and what is but indirectly seen go by the object that makes the instances.
    """
    placing = instance.parent if instance.is_instance else instance.object
    hidden = {kind for ob in {instance.object, placing} for kind in RAY_KINDS if not getattr(ob, f"visible_{kind}")}
    if placing.holdout_get(view_layer=view_layer):
        parts = () if "camera" in hidden else (part.held,)
        hidden.add("camera")
    else:
        parts = ()
        if placing.indirect_only_get(view_layer=view_layer):
            hidden.add("camera")
    if len(hidden) == len(RAY_KINDS):
        return parts
    return (*parts, replace(part, hidden_from=tuple(kind for kind in RAY_KINDS if kind in hidden)) if hidden else part)
