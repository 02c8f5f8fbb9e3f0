"""The zone plate of sample_scenes under each sampler and pixel filter: writes docs/images/zone_plate.png.

    python -m benchmarks.zone_plate

Each cell has the picture at 128, 64 and 32 pixels, as they are; rows are samplers with 1, 4 and 16 samples per pixel.
"""

import os
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from PIL import Image, ImageDraw, ImageFont

import glanz
from glanz.engine import FILTERS, SAMPLERS, render_image

ROOT = Path(glanz.__file__).resolve().parent
SIDES = (128, 64, 32)
SAMPLES = (1, 4, 16)
WIDTHS = {"box": 1.0, "tent": 2.0, "gaussian": 3.0, "mitchell": 4.0, "blackman_harris": 1.5}
"""Of the filters [px]: those that their own texts speak of, and Blender's for Blackman-Harris."""
GAP, LEFT, TOP, TITLE = 6, 170, 28, 24
CELL = SIDES[0] + SIDES[1] + GAP
PAPER, INK = 255, 0


def sample_scene():
    """(scene, settings) of the engine, from the script of the sample."""
    sys.path.insert(0, str(ROOT / "sample_scenes"))
    glanz.register()
    import zone_plate

    from glanz.addon.capture import capture

    zone_plate.build()
    scene, settings, warnings = capture()
    assert not warnings, warnings
    return scene, settings


def shades(scene, settings):
    """(H, W) uint8 as a display shows it."""
    L = np.clip(render_image(scene, settings).passes["Combined"][..., 0], 0, 1)
    encoded = np.where(L <= 0.0031308, 12.92 * L, 1.055 * L ** (1 / 2.4) - 0.055)
    return np.rint(255 * encoded).astype(np.uint8)


def cell(scene, settings):
    """The three sizes: the largest on the left, the others on top of each other beside it."""
    result = np.full((SIDES[0], CELL), PAPER, np.uint8)
    x, y = 0, 0
    for side in SIDES:
        result[y : y + side, x : x + side] = shades(scene, replace(settings, width=side, height=side))
        x, y = SIDES[0] + GAP, (y + side + GAP if x else 0)
    return result


def sheet(scene, settings):
    """The whole page, an image of Pillow."""
    filters = [key for key in WIDTHS if key in FILTERS]
    assert set(filters) == set(FILTERS), "a filter without a width"
    step_x, step_y = CELL + 2 * GAP, SIDES[0] + GAP
    height = TOP + len(SAMPLERS) * (len(SAMPLES) * step_y + TITLE)
    page = Image.new("L", (LEFT + len(filters) * step_x, height), PAPER)
    draw, font = ImageDraw.Draw(page), ImageFont.load_default(15)
    for column, key in enumerate(filters):
        draw.text((LEFT + column * step_x, 6), f"{FILTERS[key].label}, {WIDTHS[key]:g} px", INK, font)
    y = TOP
    for sampler, plugin in SAMPLERS.items():
        for samples in SAMPLES:
            draw.text((GAP, y), f"{plugin.label.split(' (')[0]}\n{samples} sample{'s' * (samples > 1)}", INK, font)
            for column, key in enumerate(filters):
                chosen = replace(settings, sampler=sampler, samples=samples, pixel_filter=key, filter_width=WIDTHS[key])
                page.paste(Image.fromarray(cell(scene, chosen)), (LEFT + column * step_x, y))
            y += step_y
        y += TITLE
        print(plugin.label, flush=True)
    return page


def main():
    page = sheet(*sample_scene())
    path = ROOT / "docs" / "images" / "zone_plate.png"
    # Noise is hard to pack; 16 greys are enough to see it.
    page.point(lambda shade: round(shade / 17) * 17).quantize(16).save(path, optimize=True, bits=4)
    print(f"wrote {path}: {page.width} x {page.height} px, {path.stat().st_size} bytes", flush=True)
    # Without Python's clean-up, which some versions of bpy do not survive.
    os._exit(0)


if __name__ == "__main__":
    main()
