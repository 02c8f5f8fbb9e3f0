"""The sample scenes as the engine gets them, small, for measurements of the engine alone.

Blender is imported by who loads one, and not before: a process that is forked off one with Blender has none of the threads with which
images are read, and would wait for them.
"""

from dataclasses import replace
from pathlib import Path

import glanz
from glanz.cli import curve

FOLDER = Path(glanz.__file__).resolve().parent / "sample_scenes"
WITHOUT = ("zone_plate",)
"""It is sampled at points, once in a pixel, to show how it aliases: its error is meant."""
NAMES = tuple(sorted(path.stem for path in FOLDER.glob("*.blend") if path.stem not in WITHOUT))


def load(name, width, height):
    """(scene, settings) of a sample scene at so many pixels, on one thread."""
    from glanz.addon.capture import capture, open_blend

    from .blender import quiet

    glanz.register()
    with quiet():
        open_blend(str(FOLDER / f"{name}.blend"))
        scene, settings, _ = capture(overrides={"width": width, "height": height, "threads": 1})
    return scene, settings


def lighted(scene, settings, samples=2048):
    """(H, W) bool: the pixels in which the camera sees no lamp and no world.

    Those that do are far brighter, and noisy at the edges alone; what all others receive would hardly count beside them. It takes
    many samples to find those that a lamp touches with the rim of the pixel filter alone.
    """
    asked = replace(curve.plain(settings), integrator="path", samples=samples, max_depth=0, passes=("Combined", "Emission", "Environment"))
    passes, _, _ = curve.rendered(scene, asked, lambda done: None)
    return ~(sum(passes[key].max(axis=2) for key in ("Emission", "Environment")) > 0)
