"""What Blender's own command line says to Glanz, for render farms: settings behind `--`, and how Blender is to end.

    blender -b scene.blend -E GLANZ -f 1 -- --glanz-samples 64 --glanz-integrator whitted

Every word behind `--` that begins with `--glanz-` is the name of a field of the engine's `Settings` with its value; words that
are meant for others are left to them. `blender --command glanz` takes what the program `glanz` does.
"""

import os
import sys
from dataclasses import fields
from itertools import pairwise

import bpy

PREFIX = "--glanz-"
_EXIT_CODE = "--python-exit-code"
_NO = ("0", "false", "off", "no")
_YES = ("1", "true", "on", "yes")
_SIZE = ("width", "height")
"""What Blender has made room for."""
_registered = []


def overrides(words=None):
    """{field of `Settings`: value} that the words of the command line ask for.

    Raises SceneError for a name that is none, and for a value of another kind.
    """
    from ..engine import SceneError, Settings

    words = sys.argv if words is None else words
    words = words[words.index("--") + 1 :] if "--" in words else []
    known = {field.name: type(field.default) for field in fields(Settings) if type(field.default) in _READERS and field.name not in _SIZE}
    found = {}
    for i, word in enumerate(words):
        if not word.startswith(PREFIX):
            continue
        name, equals, value = word[len(PREFIX) :].partition("=")
        field = name.replace("-", "_")
        if field not in known:
            listed = ", ".join(PREFIX + key.replace("_", "-") for key in known)
            raise SceneError(f"command line: {PREFIX}{name} is no setting of Glanz; known: {listed}")
        if not equals:
            value = words[i + 1] if i + 1 < len(words) else ""
        try:
            found[field] = _READERS[known[field]](value)
        except ValueError:
            raise SceneError(f"command line: {PREFIX}{name} is '{value}', {_ASKED[known[field]]} is asked for") from None
    return found


def end_after_failure(message):
    """End Blender where its command line says with which status: a farm has to know that a picture is not there.

    Blender asks for the status only where a script fails, and goes on with the next frame where a render does.
    """
    code = exit_code()
    if bpy.app.background and code is not None:
        # Where a script renders, Blender would print it only after this.
        print(f"Error: {message}", flush=True)
        sys.stderr.flush()
        os._exit(code)


def exit_code(words=None):
    """The status that `--python-exit-code` gives, None without it or for 0, which means none."""
    words = sys.argv if words is None else words
    words = words[: words.index("--")] if "--" in words else words
    value = dict(pairwise(words)).get(_EXIT_CODE, "")
    return int(value) or None if value.isdecimal() else None


def _switch(value):
    if value.lower() not in (*_YES, *_NO):
        raise ValueError
    return value.lower() in _YES


_READERS = {int: int, float: float, str: str, bool: _switch}
_ASKED = {int: "a whole number", float: "a number", str: "a name", bool: "on or off"}


def _command(words):
    from ..cli.main import main

    return main(words)


def register():
    """Offer `blender --command glanz`."""
    _registered.append(bpy.utils.register_cli_command("glanz", _command))


def unregister():
    """Take it back."""
    while _registered:
        bpy.utils.unregister_cli_command(_registered.pop())
