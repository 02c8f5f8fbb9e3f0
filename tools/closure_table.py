"""Compare shaders with Cycles and write docs/closures.md with its picture: `make closures`, in two minutes."""

import itertools
import os
import sys
import tempfile
from pathlib import Path

import bpy
import numpy as np
from PIL import Image

import glanz
from glanz.tests.parity import closures

DOCS = Path(__file__).resolve().parent.parent / "docs"
HEAD = """# Shaders, compared with Cycles

![Spheres of every shader: Cycles on the left, Glanz on the right](images/closures.png)

Cycles on the left, Glanz on the right: spheres under a sun and a grey world, in the order of the table, six in a row.

The table has the directional albedo of each in a white furnace: what a sphere shows on the ring where the cosine between its normal
and the view is in the range. All but copper are of the colour (0.8, 0.6, 0.4), of which green is listed: Glanz / Cycles. The
deviation is the largest over rings and channels. At most 3 % is asked of what is smooth or diffuse, 10 % of what is rough. Rough
reflection and refraction are Phong's lobes, as wide as those of GGX and scaled to its directional albedo; velvet is Sheen BSDF with
the distribution of Ashikhmin; clay and cloth are Principled with Diffuse Roughness and Sheen: see [lobes](lobes.md).

"""


def page(ours, theirs, version):
    """The text of docs/closures.md."""
    ends = [f"{low:g} to {high:g}" for low, high in itertools.pairwise(closures.COSINES)]
    rows = ["| shader | " + " | ".join(ends) + " | deviation | asked |", "|---" * (len(ends) + 3) + "|"]
    worst = closures.deviations(ours, theirs)
    for shader, a, b in zip(closures.SHADERS, closures.squares(ours), closures.squares(theirs)):
        rings = [f"{x:.2f} / {y:.2f}" for x, y in zip(closures.albedos(a)[:, 1], closures.albedos(b)[:, 1])]
        rows.append(f"| {shader.name} | " + " | ".join(rings) + f" | {worst[shader]:+.1%} | {shader.bar:.0%} |")
    return HEAD + "\n".join(rows) + f"\n\nBlender {version}. Written by `make closures`; `make test` checks the same.\n"


def main():
    """Render, measure, and write."""
    glanz.register()
    with tempfile.TemporaryDirectory() as folder:
        furnace = closures.rendered(True, Path(folder))
        ours, theirs = closures.rendered(False, Path(folder), samples=64)
    version = "{}.{}".format(*bpy.app.version)
    (DOCS / "closures.md").write_text(page(*furnace, version))
    sheet = np.concatenate((theirs, ours), axis=1).clip(0, 1)
    # The transfer function of sRGB.
    sheet = np.where(sheet <= 0.0031308, 12.92 * sheet, 1.055 * sheet ** (1 / 2.4) - 0.055)
    sheet = Image.fromarray(np.rint(255 * sheet).astype(np.uint8))
    sheet.resize((2 * sheet.width, 2 * sheet.height), Image.Resampling.LANCZOS).save(DOCS / "images" / "closures.png", optimize=True)
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
