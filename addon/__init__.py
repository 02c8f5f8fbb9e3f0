"""Glanz inside Blender: settings, panels, and the render engine that hands scenes to `..engine`."""

import importlib
import logging
import sys

SETTINGS = ("properties", "light_settings", "material_settings")
"""The modules of what a .blend file stores."""
_PANELS = ("panels", "accuracy", "light_panels", "pass_panels", "requirements_panel", "builtin_panels")
_MODULES = ("preferences", *SETTINGS, "render_engine", "checks", "presets", *_PANELS, "command_line", "written")
_registered = []


def register():
    """Add Glanz to Blender's list of render engines; does nothing the second time.

    Works without the engine's own libraries: a panel then says what is missing. Beside another Glanz that is in use it adds
    nothing but preferences that say so.
    """
    if _registered:
        return
    from . import neighbour

    if neighbour.package():
        logging.getLogger("glanz").warning(neighbour.complaint())
    try:
        for name in _MODULES[:1] if neighbour.package() else _MODULES:
            module = importlib.import_module(f"{__name__}.{name}")
            module.register()
            _registered.append(module)
    except BaseException:
        # Half an add-on cannot be switched off again.
        unregister()
        raise


def unregister():
    """Take everything back that `register` added; does nothing the second time. Raises RuntimeError while a picture is rendered."""
    rendering = sys.modules.get(f"{__name__}.render_engine")
    if rendering:
        rendering.refuse_while_rendering()
    while _registered:
        _registered.pop().unregister()
