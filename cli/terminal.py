"""Everything that is said: results on stdout, all else on stderr, one line each."""

import contextlib
import os
import sys
import time

SECONDS_BETWEEN_LINES = 5.0


class Terminal:
    """Speaks to the user, with `quiet` in warnings and errors only; `stopper` listens whether to end."""

    def __init__(self, quiet, stopper):
        self._out = sys.stdout
        self._quiet = quiet
        self.stopper = stopper
        self._warned = set()

    def keep_stdout_for_us(self):
        """From now on the process writes nothing to stdout but what `say` says: Blender's own messages go nowhere."""
        sys.stdout.flush()
        self._out = os.fdopen(os.dup(1), "w", encoding=sys.stdout.encoding, errors="backslashreplace")
        with open(os.devnull, "w") as nowhere:
            os.dup2(nowhere.fileno(), 1)

    def say(self, text):
        """Print a result."""
        print(text, file=self._out, flush=True)

    def note(self, text):
        """Print what is going on."""
        if not self._quiet:
            print(f"glanz: {text}", file=sys.stderr, flush=True)

    def warn(self, text):
        """Print a warning, once however often it comes."""
        if text not in self._warned:
            self._warned.add(text)
            print(f"glanz: warning: {one_line(text)}", file=sys.stderr, flush=True)

    def wrote(self, path):
        if not self._quiet:
            self.say(f"wrote {path}")

    @contextlib.contextmanager
    def progress(self, title):
        """A context whose value is a function to call with the share that is done, in [0, 1]."""
        if self._quiet:
            yield lambda done: None
            return
        bar = _rich_bar() if sys.stderr.isatty() else None
        if bar is None:
            self.note(title)
            yield _Lines(self.note)
            return
        with bar:
            task = bar.add_task(title, total=1.0)
            yield lambda done: bar.update(task, completed=done)


def one_line(text):
    return " ".join(str(text).split())


def _rich_bar():
    try:
        from rich.console import Console
        from rich.progress import BarColumn, Progress, TaskProgressColumn, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    except ImportError:
        return None
    # Markup is off: names of scenes may hold brackets.
    title = TextColumn("{task.description}", markup=False)
    return Progress(title, BarColumn(), TaskProgressColumn(), TimeElapsedColumn(), TimeRemainingColumn(), console=Console(stderr=True))


class _Lines:
    """Progress as a line now and then, where there is no terminal."""

    def __init__(self, note):
        self._note = note
        self._next = time.monotonic() + SECONDS_BETWEEN_LINES

    def __call__(self, done):
        if time.monotonic() >= self._next:
            self._next = time.monotonic() + SECONDS_BETWEEN_LINES
            self._note(f"{done:.0%} done")
