"""Access to the engine for code that must work without it: registration, panels, menus.

The engine brings compiled libraries (Embree). Where one is missing Blender must still start, and say so.
"""

from functools import cache

CURE = "Install the extension for this platform and this version of Blender again, then restart Blender"


class Unusable(Exception):
    """The engine cannot be loaded; the text is for a user."""


@cache
def _load():
    try:
        from .. import engine
    except Exception as error:  # whatever a library raises that was built for another NumPy or another system
        return None, f"{type(error).__name__}: {error}"
    return engine, ""


@cache
def _faults():
    """Why the engine's libraries cannot be loaded, by name. Loads them, so not asked when Blender starts."""
    return engine().library_faults() if engine() else {}


def engine():
    """The package `engine`, or None where it cannot be loaded."""
    return _load()[0]


def problem():
    """Why Glanz cannot render, for a user; empty: it can."""
    cause = _load()[1]
    if not cause and "embreex" in _faults():
        cause = f"its library embreex cannot be loaded ({_faults()['embreex']})"
    return f"Glanz cannot render: {cause}. {CURE}" if cause else ""


def remark():
    """What works less than it should, for a user; empty: nothing."""
    cause = _faults().get("OpenEXR")
    return f"Glanz renders, but its library OpenEXR cannot be loaded ({cause}). {CURE}" if cause else ""


def load_or_raise():
    """The package `engine`; raises Unusable with the text of `problem`."""
    if problem():
        raise Unusable(problem())
    return engine()
