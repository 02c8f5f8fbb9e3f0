"""Which of the compiled libraries can be loaded: asked before a render needs them, told to users."""

from .errors import GlanzError
from .io import exr
from .world import accel


def library_faults():
    """{library: why it cannot be loaded}; empty where all is well.

    Without embreex nothing is rendered; without OpenEXR the engine neither reads nor writes EXR files.
    """
    found = {}
    for name, check in (("embreex", accel.check), ("OpenEXR", exr.check)):
        try:
            check()
        except GlanzError as error:
            found[name] = f"{type(error.__cause__).__name__}: {error.__cause__}"
    return found
