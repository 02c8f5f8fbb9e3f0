"""Esc stops a render at once; the tiles that were finished stay."""

import os
import time

import bpy
import harness as ui


def main():
    ui.open_file("cornell_box")
    scene = bpy.context.scene
    scene.render.resolution_x = scene.render.resolution_y = 512
    scene.glanz.samples = 256
    scene.glanz.tile_size = 64
    yield 0.5
    render = ui.start_render()
    yield lambda: len([line for line in render.stats if "%" in line]) > 8, 60
    assert not render.done
    start, work = time.monotonic(), time.process_time()
    ui.press("ESC")
    yield lambda: render.done, 10
    took, work = time.monotonic() - start, time.process_time() - work
    print(f"measured: Esc took {took:.2f} s, {work:.2f} s of work on {os.cpu_count()} processors, which others use too")
    assert render.cancelled and not render.finished
    yield 1.0
    ui.shot("cancelled")
    result = ui.saved_result()
    kept = (result[..., :3].sum(axis=2) > 0).mean()
    print(f"measured: Esc kept {kept:.1%} of the picture")
    assert 0 < kept < 1
