"""Error and time of the presets, and of a ladder of samples and depths, over the sample scenes, by processor time of one thread.

    python -m benchmarks.presets [--quick] [scene ...]

Writes docs/presets.md and docs/presets.json, from which the numbers in the presets' tooltips are. Scenes that are not named stay in
them as they were measured last, unless the presets have changed since. What is quick goes to out/presets.
"""

import json
import os
import time
from dataclasses import asdict
from pathlib import Path

from glanz.addon.presets import PRESETS
from glanz.engine import Settings

from .. import small_scenes
from ..__main__ import describe_machine
from ..words import asked
from . import report
from .measure import QUICK, Effort, measure

ROOT = Path(__file__).resolve().parents[2]
ALWAYS = ("integrator", "sampler", "samples", "max_depth")


def main(words=None):
    without = "few samples, to see that it works"
    names, is_quick = asked("benchmarks.presets", __doc__, "scene", small_scenes.NAMES, without, words)
    effort, folder = (QUICK, ROOT / "out" / "presets") if is_quick else (Effort(), ROOT / "docs")
    presets = {key: told(preset.settings) for key, preset in PRESETS.items()}
    folder.mkdir(parents=True, exist_ok=True)
    begun = time.monotonic()
    for name in names:
        found = {"facts": describe_machine(), **measure(name, presets, effort)}
        print(f"{time.monotonic() - begun:5.0f} s  {name}", flush=True)
        # What is measured is not lost if a later scene fails.
        results = keep(folder / "presets.json", name, found, {"presets": presets, "effort": asdict(effort)})
    labels = {key: preset.label for key, preset in PRESETS.items()}
    (folder / "presets.md").write_text(report.page(results, labels), encoding="utf-8")
    print("\n".join(report.summary_table(results, labels)))
    print(f"wrote {(folder / 'presets.md').relative_to(ROOT)} and presets.json beside it", flush=True)
    # Without Python's clean-up, which some versions of bpy do not survive.
    os._exit(0)


def told(settings):
    """Those of a preset that say what it is: all that the engine would not do anyway, so that what is measured outlasts new settings."""
    plain = Settings()
    return {name: value for name, value in settings.items() if name in ALWAYS or value != getattr(plain, name)}


def keep(path, name, found, asked_for):
    """Everything measured, with what is `found` for the scene `name`, which is written to `path`."""
    old = json.loads(path.read_text(encoding="utf-8")) if path.exists() else {}
    scenes = old["scenes"] if json.loads(json.dumps(asked_for)) == {key: old.get(key) for key in asked_for} else {}
    scenes = dict(sorted((scenes | {name: found}).items()))
    results = json.loads(json.dumps(asked_for | {"summary": report.summary(scenes, asked_for["presets"]), "scenes": scenes}))
    path.write_text(report.as_text(results), encoding="utf-8")
    return results


if __name__ == "__main__":
    main()
