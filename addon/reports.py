"""What the user is told: errors that stop the render, warnings that do not."""

import logging
import traceback
from contextlib import contextmanager

from . import backend, command_line

log = logging.getLogger("glanz")

MOST_WARNINGS = 8
"""Warnings shown in Blender for one render; the others are logged."""


def describe(error):
    """One line for a user: our own errors speak for themselves, others are named."""
    engine = backend.engine()
    if isinstance(error, backend.Unusable):
        return str(error)
    if isinstance(error, MemoryError):
        return f"Glanz ran out of memory: lower the resolution, or simplify the scene ({error or 'no details'})"
    if engine and isinstance(error, engine.GlanzError):
        return str(error)
    if isinstance(error, ImportError) and backend.problem():
        return backend.problem()
    return f"Glanz failed: {type(error).__name__}: {error}"


def is_expected(error):
    """Whether the user can do something about `error`, and a developer needs no traceback."""
    engine = backend.engine()
    own = isinstance(error, backend.Unusable) or (bool(engine) and isinstance(error, engine.GlanzError))
    return own and error.__cause__ is None


def explain(error):
    """`describe(error)`, after its traceback on the console where a developer needs one."""
    if not is_expected(error):
        traceback.print_exception(error)
    return describe(error)


def counted(count, noun):
    """Such as "no warnings", "1 warning", "2 warnings"."""
    return f"{count or 'no'} {noun}{'' if count == 1 else 's'}"


@contextmanager
def errors_shown(engine):
    """Turn whatever is raised inside into an error report of Blender's render `engine`, so that its operator fails.

    An exception that leaves `RenderEngine.render` is printed and forgotten by Blender: it saves a black picture and
    answers FINISHED; SystemExit even ends Blender. Only `report` with ERROR makes it stop; `error_set` shows the text
    where the picture would be.
    """
    try:
        yield
    except BaseException as error:
        message = explain(error)
        engine.error_set(message)
        engine.report({"ERROR"}, message)
        command_line.end_after_failure(message)


@contextmanager
def errors_told(engine):
    """Turn whatever is raised inside into the text of the 3D view that Blender's render `engine` serves; nothing stops there."""
    try:
        yield
    except Exception as error:
        engine.update_stats("", explain(error))


@contextmanager
def errors_logged(engine):
    """Turn whatever is raised inside into a line of the log: a preview that fails must not stop the render that runs beside it."""
    try:
        yield
    except Exception as error:
        message = explain(error)
        log.warning("preview: %s", message)
        engine.error_set(message)


class Warnings:
    """Shows each warning once: the first few as reports of Blender's render `engine`, the others in the log."""

    def __init__(self, engine):
        self._engine = engine
        self._seen = {}

    def show(self, lines):
        for line in lines:
            if line in self._seen:
                continue
            self._seen[line] = True
            if len(self._seen) <= MOST_WARNINGS:
                self._engine.report({"WARNING"}, line)
            else:
                log.warning(line)

    def __len__(self):
        return len(self._seen)

    def close(self):
        """Say how many there were, and how many were not shown."""
        hidden = len(self) - MOST_WARNINGS
        if hidden > 0:
            self._engine.report({"WARNING"}, f"and {hidden} more warnings, see Scene Requirements in the Render properties")
        if len(self):
            log.warning("rendered with %s", counted(len(self), "warning"))
