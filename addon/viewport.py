"""A picture that refines while the user looks at it, and starts again when something changes: rendered by threads of its own.

Nothing here knows Blender. What is to be shown is handed over as values of the engine; `Session.picture` is what there is to
be seen of it, at any time. One thread decides what is done next, and waits while there is nothing to do.

First comes a coarse picture, as coarse as it must be to be there at once, and of few bounces where that does not help, for
each costs its time however few rays there are; it is never given up half done, or whoever moves the view without a pause
would see nothing. Then come finer ones, and at last sample after sample for each pixel, all
of which are given up at once when something else is wished for.
"""

import threading
import time
from dataclasses import dataclass, replace

import numpy as np

from ..engine import prepare, render_plan
from .reports import counted, explain

ENDLESS = 2**16
"""Samples, or bounces, where there shall be no end."""
FIRST_SECONDS = 0.06
"""How long the first picture after a change may take; it is made coarser or finer accordingly."""
SHOW_SECONDS = 0.2
"""How often pictures are shown that are not complete."""
_FIRST = ((1, ENDLESS), (2, ENDLESS), (4, ENDLESS), (8, ENDLESS), (16, ENDLESS), (16, 2))
"""How wide the pixels of the first picture may be, and how many bounces it may have: two show what is behind glass."""
_FINER = 4
"""From a coarse picture to the next one."""
_AT_ONCE = 4
"""Samples that each pixel gets before others get more: few, as what is begun is given up between them only."""
_JOIN_SECONDS = 0.5


@dataclass(frozen=True, eq=False)
class Picture:
    """pixels (height, width, 4) float32, scene-linear and premultiplied, row 0 at the bottom."""

    pixels: np.ndarray


@dataclass(frozen=True, eq=False)
class _Wish:
    scene: object
    view: object
    settings: object

    @property
    def compiled(self):
        """What a compiled world depends on, to be compared: all but the film."""
        return self.scene, replace(self.settings, width=1, height=1, samples=1)


class Session:
    """Renders what was wished for last. Told and asked by one thread, whom it never keeps waiting.

    picture   the newest `Picture`, None before there is one
    status    what is going on, one line
    warnings  what is not rendered as it should be, lines
    is_busy   whether there is more to come
    """

    def __init__(self):
        self.picture, self.status, self.warnings, self.is_busy = None, "", (), False
        self._scene = self._view = self._settings = None
        self._wish = None
        self._changed = threading.Condition()
        self._stale, self._closed = threading.Event(), threading.Event()
        self._plan, self._compiled = None, None
        # What it takes nobody knows yet.
        self._first = len(_FIRST) - 1
        self._thread = None

    @property
    def is_closed(self):
        """Whether there will be nothing more."""
        return self._closed.is_set()

    def show(self, scene):
        """Render another scene, whose camera does not count; None: nothing."""
        self._scene = scene
        self._tell()

    def look(self, view, settings):
        """Look at it so: `view` has a method `camera()`, None sees nothing; `settings` say how large and how many samples.

        Nothing happens where both are equal to what they were.
        """
        if (view, settings) != (self._view, self._settings):
            self._view, self._settings = view, settings
            self._tell()

    def close(self):
        """End all threads. What does not end soon is left alone: it knows nothing but its own copy of the scene, and ends."""
        with self._changed:
            self._closed.set()
            self._stale.set()
            self._wish = None
            self._changed.notify()
        if self._thread:
            self._thread.join(_JOIN_SECONDS)
        self.is_busy = False

    def _tell(self):
        if self._closed.is_set():
            return
        with self._changed:
            self._wish = _Wish(self._scene, self._view, self._settings) if self._scene and self._view else None
            self._stale.set()
            self.is_busy = self.is_busy or self._wish is not None
            self._changed.notify()
        if self._wish and not self._thread:
            self._thread = threading.Thread(target=self._run, name="glanz-viewport", daemon=True)
            self._thread.start()

    def _run(self):
        while wish := self._next():
            try:
                self._fulfil(wish)
            except Exception as error:
                # Nobody hears of what fails because Python ends.
                if self.is_closed:
                    return
                self._plan, self._compiled = None, None
                self.status = explain(error)

    def _next(self):
        with self._changed:
            self.is_busy = self._wish is not None
            self._changed.wait_for(lambda: self._wish or self._closed.is_set())
            wish, self._wish = self._wish, None
            self._stale.clear()
            return None if self._closed.is_set() else wish

    def _fulfil(self, wish):
        self._prepare(wish)
        begun, (coarse, depth) = time.monotonic(), _FIRST[self._first]
        picture = self._refine(wish, coarse, 1, None, self._closed, depth)
        self._adapt(time.monotonic() - begun)
        coarse //= _FINER
        while coarse > 1 and picture:
            picture = self._refine(wish, coarse, 1, picture, self._stale)
            coarse //= _FINER
        if picture:
            self._refine(wish, 1, wish.settings.samples, picture, self._stale)

    def _prepare(self, wish):
        """Let `_plan` be for the scene of a wish: what can stay of the one before does."""
        camera = wish.view.camera()
        plan, scene = self._plan, replace(wish.scene, camera=camera)
        if wish.compiled != self._compiled:
            self.status = "Preparing the scene"
            plan, self.warnings = prepare(scene, wish.settings, before=plan)
        plan = plan.seen_from(camera, wish.settings)
        if not plan.is_exact():
            plan, _ = prepare(scene, wish.settings)
        self._plan, self._compiled = plan, wish.compiled

    def _adapt(self, seconds):
        """Make the next first picture coarser or finer."""
        if seconds > FIRST_SECONDS:
            self._first = min(self._first + 1, len(_FIRST) - 1)
        elif seconds * _FINER < FIRST_SECONDS:
            self._first = max(self._first - 1, 0)

    def _refine(self, wish, coarse, samples, before, cancelled, depth=ENDLESS):
        """Show the picture with pixels so `coarse`, over the one `before`, until it has its `samples`; None where it was given up.

        It has `depth` bounces at most.
        """
        width, height = (-(-side // coarse) for side in (wish.settings.width, wish.settings.height))
        film = {"width": width, "height": height, "samples": samples, "max_depth": min(wish.settings.max_depth, depth)}
        plan = self._plan.seen_from(wish.view.camera(), replace(wish.settings, **film))
        pixels = enlarged(before.pixels, width, height) if before else np.zeros((height, width, 4), np.float32)
        shown = time.monotonic()
        for progress in render_plan(plan, (1, 2, *range(_AT_ONCE, samples, _AT_ONCE)), cancelled):
            for tile in progress.tiles:
                bottom = height - tile.y - tile.height
                pixels[bottom : bottom + tile.height, tile.x : tile.x + tile.width] = tile.passes["Combined"][::-1]
            if coarse == 1:
                self.status = progress_text(progress.done, samples)
            if time.monotonic() - shown > SHOW_SECONDS and not self._stale.is_set():
                self.picture, shown = Picture(pixels.copy()), time.monotonic()
        if cancelled.is_set():
            return None
        self.picture = Picture(pixels)
        return self.picture


def progress_text(done, samples):
    """Such as "Sample 5 of 32", for the share `done` of `samples`."""
    if done == 1:
        return counted(samples, "sample")
    number = int(done * samples) + 1
    return f"Sample {number}" if samples == ENDLESS else f"Sample {number} of {samples}"


def enlarged(pixels, width, height):
    """A picture (h, w, 4) with `width` x `height` pixels, each as the one where it is."""
    rows, columns = (np.arange(size) * old // size for size, old in ((height, pixels.shape[0]), (width, pixels.shape[1])))
    return pixels.take(rows, axis=0).take(columns, axis=1)
