"""Random changes by a user at work, with a rendered view in sight, and a render after every few of them."""

import random

import changes
import harness as ui

COUNT = 60
BEFORE_MEASURING = 20
MOST_GROWTH = 50.0
"""Megabytes."""


def main():
    yield 0.2
    made = changes.Changes(random.Random(7), window=lambda: ui.context("VIEW_3D"))
    # A rendered view follows every change.
    ui.shading("RENDERED")
    before = None
    refused = 0
    # Cameras are refused by name; anything else that is printed as an error fails.
    ui.expect("Error: camera 'Camera")
    # Blender 4.2 says so of base classes.
    ui.expect("Error: Node type")
    for n in range(0, COUNT, 4):
        made.make(4)
        ui.redraw()
        render = ui.start_render("NONE")
        yield lambda render=render: render.done, 60
        if render.cancelled:
            # As for a camera whose parent is flat; it says so, and with another camera it goes on.
            refused += 1
            made.new_camera()
        if before is None and n >= BEFORE_MEASURING:
            before = ui.resident_megabytes()
    growth = ui.resident_megabytes() - before
    assert refused <= COUNT / 16
    print(f"measured: after {COUNT} changes Blender had grown by {growth:.0f} MB")
    assert growth <= MOST_GROWTH
    ui.shot("end")
