"""Access to the engine for code that must work without it: registration, panels, menus.

The engine brings compiled libraries (Embree). Where one is missing Blender must still start, and say so.
"""

from functools import cache


@cache
def _load():
    try:
        from .. import engine
    except (ImportError, OSError) as error:
        return None, f"{type(error).__name__}: {error}"
    return engine, ""


def engine():
    """The package `engine`, or None where it cannot be loaded."""
    return _load()[0]


def problem():
    """Why the engine cannot be loaded, one line for a user; empty: it can."""
    cause = _load()[1]
    return f"Glanz cannot render: {cause}. Install the extension for this platform and Blender version again" if cause else ""


def load_or_raise():
    """The package `engine`; raises RuntimeError with the text of `problem`."""
    if problem():
        raise RuntimeError(problem())
    return engine()
