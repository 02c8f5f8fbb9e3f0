"""Ctrl-C and the like: where the program may end at once, and where it has something to put in order first.

A signal never becomes an exception wherever the program happens to be: raised while compiled modules load, that
crashes Python, and raised inside Blender, it gets lost.
"""

import contextlib
import os
import signal
import sys


class Stopped(BaseException):
    """The user has asked for the end; `number` is the signal's."""

    def __init__(self, number):
        super().__init__(number)
        self.number = number


class Stopper:
    """Ends the program when a signal asks for it: at once, or, inside `orderly`, at the next `check`."""

    def __init__(self):
        self._is_orderly = False
        self._asked = 0

    def install(self):
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, self._handle)

    @contextlib.contextmanager
    def orderly(self):
        """A context in which a first signal waits for `check`; a second one does not."""
        self._is_orderly = True
        try:
            yield
            self.check()
        finally:
            self._is_orderly = False

    def check(self):
        """Raises Stopped if a signal has come."""
        if self._asked:
            raise Stopped(self._asked)

    def _handle(self, number, frame):
        if self._is_orderly and not self._asked:
            self._asked = number
            return
        show_cursor = "\x1b[?25h" if sys.stderr.isatty() else ""  # a progress bar hides it
        os.write(2, f"{show_cursor}{farewell(number)}\n".encode())
        os._exit(128 + number)


def farewell(number):
    return f"glanz: stopped by {signal.Signals(number).name}"
