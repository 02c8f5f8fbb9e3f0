"""Another Glanz in the same Blender, as a newer version from another repository: Blender knows engines and settings by
name, so only one of them can be in use.
"""

import bpy

_OWN = __package__.rpartition(".")[0]


def package():
    """The module that Blender enabled as Glanz before this one; empty: none."""
    panel = getattr(bpy.types, "GLANZ_RENDER_PT_sampling", None)
    owner = panel.__module__.rpartition(".addon.")[0] if panel else ""
    return "" if owner == _OWN else owner


def complaint():
    """Why this Glanz stands back, for a user; empty: it does not."""
    if not package():
        return ""
    return (
        f"Another Glanz is in use, {package()}, so this one, {_OWN}, stands back. "
        "To use this one disable the other, then disable and enable this one"
    )
