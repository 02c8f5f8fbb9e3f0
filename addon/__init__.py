"""Glanz inside Blender: settings, panels, and the render engine that hands scenes to `..engine`."""

import importlib

SETTINGS = ("properties", "light_settings", "material_settings")
"""The modules of what a .blend file stores."""
_MODULES = (*SETTINGS, "render_engine", "panels", "builtin_panels")
_registered = []


def register():
    """Add Glanz to Blender's list of render engines; does nothing the second time.

    Works without the engine's own libraries: a panel then says what is missing.
    """
    if _registered:
        return
    try:
        for name in _MODULES:
            module = importlib.import_module(f"{__name__}.{name}")
            module.register()
            _registered.append(module)
    except BaseException:
        # Half an add-on cannot be switched off again.
        unregister()
        raise


def unregister():
    """Take everything back that `register` added; does nothing the second time."""
    while _registered:
        _registered.pop().unregister()
