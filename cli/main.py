"""From the command line's words to an exit status that tells the truth.

0: every picture asked for is there; 1: an error, said in one line on stderr; 2: the command was not understood;
128 + n: stopped by signal n, 130 for Ctrl-C.
"""

import os
import sys
import traceback

from .arguments import check_outputs, parser
from .stopping import Stopped, Stopper, farewell
from .terminal import Terminal, one_line

VERSION = "0.1.0"


def run():
    """Entry point of the program: never returns."""
    for name in ("stdout", "stderr"):
        if getattr(sys, name) is None:  # closed by whoever started the program
            setattr(sys, name, open(os.devnull, "w"))  # noqa: SIM115 - stays open to the end
    stopper = Stopper()
    stopper.install()
    status = main(stopper=stopper)
    for stream in (sys.stdout, sys.stderr):
        try:
            stream.flush()
        except OSError:  # whoever read it is gone
            status = status or 1
            os.dup2(os.open(os.devnull, os.O_WRONLY), stream.fileno())
    if "bpy" in sys.modules:
        from .sources import is_blender_fragile

        if is_blender_fragile():
            os._exit(status)
    sys.exit(status)


def main(argv=None, stopper=None):
    """Run the command of `argv`, the words after the program's name; returns the exit status."""
    try:
        commands = parser(VERSION)
        arguments = commands.parse_args(argv)
        try:
            check_outputs(arguments)
        except ValueError as error:
            commands.error(str(error))
    except SystemExit as end:  # argparse has said all
        return end.code
    try:
        return _execute(arguments, stopper or Stopper())
    except Stopped as stop:
        print(farewell(stop.number), file=sys.stderr)
        return 128 + stop.number


def _execute(arguments, stopper):
    terminal = Terminal(getattr(arguments, "quiet", False), stopper)
    try:
        from ..engine import GlanzError
    except ImportError as error:
        return _fail(f"the engine cannot be loaded: {error}; cure: pip install glanz")
    try:
        from . import commands

        getattr(commands, arguments.command)(arguments, terminal)
    except GlanzError as error:
        return _fail(error)
    except MemoryError as error:
        return _fail(f"out of memory {error}")
    except BrokenPipeError:  # nobody listens any more
        return 1
    except OSError as error:
        return _fail(error)
    except Exception as error:
        traceback.print_exc()
        return _fail(f"unexpected {type(error).__name__}: {error}; this is a bug in Glanz, please report it with the lines above")
    return 0


def _fail(error):
    print(f"glanz: error: {one_line(error)}", file=sys.stderr)
    return 1
