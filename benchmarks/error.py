"""The error at equal samples: both engines against a long render of their own, which is kept in out/.

The picture is small, for error does not depend on its size. Pixels are cut off at white first: the rim of the lamp, 27
times as bright, would else be all that counts.
"""

import hashlib

import bpy
import numpy as np

from . import blender

SAMPLES, REFERENCE, SIDE, SEEDS = 16, 2048, 128, 4


def main():
    result = {"samples": SAMPLES, "reference_samples": REFERENCE}
    for engine in ("GLANZ", "CYCLES"):
        reference = kept_reference(engine)
        blender.open_cornell_box(SAMPLES, SIDE, SIDE)
        squares = [np.mean((picture(engine, seed) - reference) ** 2) for seed in range(1, 1 + SEEDS)]
        result[engine.lower()] = float(np.sqrt(np.mean(squares)))
    result["ratio"] = result["glanz"] / result["cycles"]
    blender.finish(result)


def kept_reference(engine):
    """A picture of `REFERENCE` samples, rendered once for each version of the file and of Blender."""
    mark = hashlib.sha256(blender.CORNELL_BOX.read_bytes() + bpy.app.version_string.encode()).hexdigest()[:12]
    path = blender.OUT / f"bench_reference_{engine.lower()}_{REFERENCE}_{mark}.npy"
    if not path.exists():
        blender.open_cornell_box(REFERENCE, SIDE, SIDE)
        np.save(path, picture(engine, seed=0))
    return np.load(path)


def picture(engine, seed):
    """(SIDE, SIDE, 4) linear pixels, cut off at white."""
    scene = bpy.context.scene
    scene.glanz.seed = scene.cycles.seed = seed
    return np.minimum(blender.picture(engine), 1)


if __name__ == "__main__":
    main()
