"""What the user is told: once, in one line, and with the cause."""

import logging

import pytest

from glanz.addon.reports import MOST_WARNINGS, Warnings, describe, errors_shown
from glanz.engine import SceneError


class Engine:
    """Stands for Blender's engine: remembers what it was told."""

    def __init__(self):
        self.reports, self.error = [], None

    def report(self, kinds, text):
        self.reports.append((*kinds, text))

    def error_set(self, text):
        self.error = text


@pytest.mark.parametrize("error", [SceneError("object 'A' is odd"), ValueError("odd"), SystemExit(3), KeyboardInterrupt(), MemoryError()])
def test_every_error_is_reported_and_goes_no_further(error, capsys):
    engine = Engine()
    with errors_shown(engine):
        raise error
    assert engine.reports == [("ERROR", describe(error))]
    assert engine.error == describe(error)
    # Developers need a traceback, users of a scene that cannot be rendered do not.
    assert ("Traceback" in capsys.readouterr().err) == (not isinstance(error, SceneError))


def test_an_error_with_a_hidden_cause_has_a_traceback(capsys):
    with errors_shown(Engine()):
        try:
            raise ValueError("hidden")
        except ValueError as cause:
            raise SceneError("object 'A' cannot be exported") from cause
    assert "hidden" in capsys.readouterr().err


def test_warnings_are_shown_once_and_only_the_first_few(caplog):
    engine = Engine()
    warnings = Warnings(engine)
    lines = [f"warning {i}" for i in range(MOST_WARNINGS + 3)]
    with caplog.at_level(logging.WARNING, "glanz"):
        warnings.show(lines)
        warnings.show(lines)
        warnings.close()
    more = "and 3 more warnings, see Scene Requirements in the Render properties"
    assert engine.reports == [("WARNING", line) for line in (*lines[:MOST_WARNINGS], more)]
    assert [record.getMessage() for record in caplog.records] == [*lines[MOST_WARNINGS:], f"rendered with {len(lines)} warnings"]
    assert len(warnings) == len(lines)


def test_without_warnings_nothing_is_said(caplog):
    engine = Engine()
    Warnings(engine).close()
    assert engine.reports == [] and not caplog.records
