"""Inside Blender: runs a script of this folder from Blender's event loop, and gives it what it needs to see and to act.

    blender --python harness.py -- SCRIPT.py FOLDER

A script has a generator function `main()`. What it yields is how long to wait: seconds, or a condition (a function that
is called until its answer is true), or (condition, seconds), which are 30 unless told. In between Blender draws, renders
and takes events as it does for a user. A script imports this file as `import harness as ui`.

The last word is FOLDER/verdict: 0 or 1. Pictures of the screen are FOLDER/NAME.png, and the whole of the screen is shown
by FOLDER/failure.png after an exception.
"""

import gc
import os
import re
import runpy
import sys
import time
import traceback
from contextlib import contextmanager
from pathlib import Path

import bpy

FOLDER = Path(__file__).resolve().parent
ROOT = FOLDER.parents[1]
sys.path[:0] = [str(FOLDER), str(ROOT / "tests" / "addon")]

import screen  # noqa: E402 - Blender does not put the folder of a script into the path

PATIENCE = 30.0
"""Seconds that a condition gets to come true."""
out = Path(sys.argv[sys.argv.index("--") + 2])
"""The folder of what the script leaves behind."""
package = os.environ.get("GLANZ_PACKAGE", "bl_ext.user_default.glanz")
"""Glanz as the module that Blender enabled."""
_screen = screen.open_screen()


# --- to see


def pixels():
    """Blender's main window on the screen, (height, width, 3) bytes as a NumPy array, row 0 at the top."""
    import numpy as np

    rgb, width, height = _grab()
    return np.frombuffer(rgb, np.uint8).reshape(height, width, 3)


def shot(name):
    """Keep what the main window shows as FOLDER/NAME.png. Not redrawn: yield a moment before."""
    path = out / f"{name}.png"
    if _screen is None:
        with bpy.context.temp_override(window=window()):
            bpy.ops.screen.screenshot(filepath=str(path))
    else:
        screen.write_png(path, *_grab())
    print(f"picture {path.name}", flush=True)
    return path


def _grab():
    if _screen is None:
        raise RuntimeError("only on X11 can a script read the screen")
    one = window()
    left, top = max(one.x, 0), max(_screen.height - one.y - one.height, 0)
    width, height = min(one.width, _screen.width - left), min(one.height, _screen.height - top)
    return _screen.grab(left, top, width, height), width, height


def saved_result():
    """The Render Result as (height, width, 4) float32, row 0 at the bottom, by way of an EXR file; a cancelled render has one too."""
    import numpy as np

    image, scene = bpy.data.images["Render Result"], bpy.context.scene
    kept = scene.render.image_settings
    if hasattr(kept, "media_type"):
        kept.media_type = "IMAGE"
    kept.file_format, kept.color_mode, kept.color_depth = "OPEN_EXR", "RGBA", "32"
    path = out / "result.exr"
    image.save_render(str(path))
    loaded = bpy.data.images.load(str(path))
    values = np.empty(len(loaded.pixels), np.float32)
    loaded.pixels.foreach_get(values)
    width, height = loaded.size
    bpy.data.images.remove(loaded)
    return values.reshape(height, width, 4)


def redraw():
    """Draw all windows now. Not during a render, which would wait for this and this for it."""
    for one in bpy.context.window_manager.windows:
        with bpy.context.temp_override(window=one):
            bpy.ops.wm.redraw_timer(type="DRAW_WIN_SWAP", iterations=1)


def resident_megabytes():
    """What this process holds of the machine's memory."""
    gc.collect()
    return int(re.search(r"VmRSS:\s+(\d+)", Path("/proc/self/status").read_text())[1]) / 1024


def expect(text):
    """What Blender prints with `text` in its line is no failure."""
    print(f"expected: {text}", flush=True)


# --- to act


def window():
    """Blender's main window."""
    return bpy.context.window_manager.windows[0]


def area(kind=None):
    """The largest area of a kind, as "VIEW_3D", or of all kinds."""
    found = [one for one in window().screen.areas if kind in (None, one.type)]
    if not found:
        raise LookupError(f"there is no area {kind}")
    return max(found, key=lambda one: one.width * one.height)


def context(kind):
    """For operators that need an area: `with context("VIEW_3D"): ...`."""
    one = area(kind)
    region = next(region for region in one.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window(), area=one, region=region)


def shading(kind):
    """Show the largest 3D viewport as "SOLID", "MATERIAL" or "RENDERED"."""
    area("VIEW_3D").spaces.active.shading.type = kind


def show_image(image=None):
    """Show an image, the Render Result unless told, in the largest area; returns the area."""
    editor = area()
    editor.type = "IMAGE_EDITOR"
    editor.spaces.active.image = image or bpy.data.images["Render Result"]
    with context("IMAGE_EDITOR"):
        bpy.ops.image.view_all(fit_view=True)
    return editor


def show_preferences():
    """Show Glanz among the add-ons of the preferences, with what it says of itself, in the largest area; returns the area."""
    editor = area()
    editor.type = "PREFERENCES"
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Glanz"
    bpy.ops.preferences.addon_expand(module=package)
    redraw()
    return editor


def press(key):
    """Press "ESC", "RETURN" or "F12" on the keyboard, above the middle of the main window."""
    move()
    _screen.press(key)


def move():
    """Move the mouse to the middle of the main window. Blender shows some things, as errors of a render, when it gets an event."""
    if _screen is None:
        raise RuntimeError("only on X11 can a script press keys and move the mouse")
    one = window()
    _screen.move(one.x + one.width // 2, _screen.height - one.y - one.height // 2)


def open_file(name):
    """Open the sample scene NAME.blend, as it is, in the window's present layout."""
    bpy.ops.wm.open_mainfile(filepath=str(ROOT / "sample_scenes" / f"{name}.blend"), load_ui=False)


class Render:
    """What Blender says of a render: `begun`, then `finished` or `cancelled`; `stats`, its status lines."""

    def __init__(self):
        self.begun = self.finished = self.cancelled = False
        self.stats = []

    @property
    def done(self):
        """Whether it is over, its thread included."""
        return (self.finished or self.cancelled) and not bpy.app.is_job_running("RENDER")


_watched = None


def watch_render():
    """A `Render` that follows the next render, whoever starts it."""
    global _watched
    if _watched is None:
        _listen()
    _watched = Render()
    return _watched


def _listen():
    def listener(name):
        def note(*arguments):
            if name == "stats":
                _watched.stats.append(str(arguments[0]))
            else:
                setattr(_watched, name, True)

        return bpy.app.handlers.persistent(note)

    names = {"render_init": "begun", "render_complete": "finished", "render_cancel": "cancelled", "render_stats": "stats"}
    for handlers, name in names.items():
        getattr(bpy.app.handlers, handlers).append(listener(name))


def start_render(display="AREA", **options):
    """F12, without waiting; returns a `Render`. `display`: where Blender shows it, "AREA", "WINDOW", "SCREEN" or "NONE"."""
    bpy.context.preferences.view.render_display_type = display
    render = watch_render()
    with bpy.context.temp_override(window=window()):
        bpy.ops.render.render("INVOKE_DEFAULT", **options)
    return render


# --- to run


def run(path):
    """Run the script `path` from the event loop, and end Blender after it."""
    bpy.context.preferences.view.show_splash = False
    # Whatever this script does, the next finds Blender as it was installed.
    bpy.context.preferences.use_preferences_save = False
    with _ending_badly():
        steps = runpy.run_path(path, run_name="__main__")["main"]()
        bpy.app.timers.register(_Driver(steps), first_interval=0.5, persistent=True)


class _Driver:
    """A timer that goes on with the generator `steps` when what it waits for has come."""

    def __init__(self, steps):
        self._steps = steps
        self._condition = None
        self._end = 0.0

    def __call__(self):
        with _ending_badly(), bpy.context.temp_override(window=window()):
            return self._turn()

    def _turn(self):
        value = self._condition and self._condition()
        if self._condition and not value:
            if time.monotonic() < self._end:
                return 0.02
            return self._wait_for(self._steps.throw(TimeoutError("it did not come true in time")))
        try:
            wish = self._steps.send(value)
        except StopIteration:
            return _end(0)
        return self._wait_for(wish)

    def _wait_for(self, wish):
        condition, seconds = wish if isinstance(wish, tuple) else (wish, PATIENCE)
        self._condition = condition if callable(condition) else None
        self._end = time.monotonic() + seconds
        return 0.02 if self._condition else float(condition)


@contextmanager
def _ending_badly():
    try:
        yield
    except BaseException:
        traceback.print_exc()
        try:
            shot("failure")
        except Exception as error:
            print(f"no picture of it: {error}", flush=True)
        _end(1)


def _end(status):
    (out / "verdict").write_text(str(status))
    sys.stdout.flush()
    bpy.ops.wm.quit_blender()


if __name__ == "__main__":
    # Once more under its own name, which scripts import.
    import harness

    harness.run(sys.argv[sys.argv.index("--") + 1])
