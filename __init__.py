"""Glanz, a render engine for Blender: this folder is both the Blender extension and the Python package `glanz`.

Nothing is imported here at module level, so that `glanz.engine` works where there is no Blender.
"""


def register():
    """Called by Blender when the extension is switched on."""
    from .addon import register

    register()


def unregister():
    """Called by Blender when the extension is switched off."""
    from .addon import unregister

    unregister()
