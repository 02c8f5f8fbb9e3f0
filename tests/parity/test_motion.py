"""Blur is that of Cycles: of a camera, of things that slide, spin and grow, and of a mesh that changes its shape.

Glowing things before a dim world, and a lit floor with a moving shadow; every block mean within 1 %. Motion at 10 % another
speed is noticed in each case.
"""

import math

import bpy
import numpy as np
import pytest
from mathutils import Euler

from glanz.tests.addon import blender
from glanz.tests.addon.export.test_motion import animate
from glanz.tests.parity import parity, test_transport, welch

SIDE, BLOCKS, SAMPLES = 64, 8, 512
MOST = 0.01
FRAME = 10


def open_shutter(shutter=1.0, position="CENTER"):
    scene = bpy.context.scene
    scene.render.use_motion_blur, scene.render.motion_blur_shutter = True, shutter
    owner = scene.render if hasattr(scene.render, "motion_blur_position") else scene.cycles
    owner.motion_blur_position = position


def stage(max_depth=0):
    """A camera, a dim world, cards that glow in several colours at several depths."""
    camera = blender.add_camera(location=(0, -6, 3), width=SIDE, height=SIDE)
    camera.rotation_euler = (math.radians(63), 0, 0)
    blender.set_world((0.2, 0.25, 0.3))
    colours = ((1, 0.2, 0.1), (0.2, 1, 0.3), (0.2, 0.3, 1), (0.9, 0.8, 0.2))
    for i, colour in enumerate(colours):
        card = blender.add_plane(f"Card {i}", 1.2, (1.3 * (i - 1.5), 0.6 * i, 0.4 * i))
        card.rotation_euler = (1.0, 0.3 * i, 0.2)
        card.data.materials.append(blender.new_material(f"Glow {i}", "ShaderNodeEmission", Color=(*colour, 1), Strength=1.0))
    open_shutter()
    bpy.context.scene.frame_set(FRAME)
    parity.be_exact(SAMPLES, max_depth)
    return camera


def keyed(owner, path, before, after, index=-1):
    """From `before` to `after` over the two frames around, so that one frame of shutter sees half of it."""
    animate(owner, path, {FRAME - 1: before, FRAME + 1: after}, index)


def move_camera(camera, speed):
    keyed(camera, "location", (-0.5 * speed, -6, 3), (0.5 * speed, -6, 3.3))
    keyed(camera, "rotation_euler", Euler((math.radians(63), 0, -0.05 * speed)), Euler((math.radians(63), 0, 0.1 * speed)))


def slide(speed):
    keyed(bpy.data.objects["Card 1"], "location", (-0.65 - speed, 0.6, 0.4), (-0.65 + speed, 0.6, 0.9))


def spin(speed):
    keyed(bpy.data.objects["Card 2"], "rotation_euler", Euler((1.0, 0.6, -speed)), Euler((1.0, 0.6, 1.5 * speed)))


def grow(speed):
    keyed(bpy.data.objects["Card 2"], "scale", (1, 1, 1), (1 + 2 * speed, 1 - 0.5 * speed, 1))


def deform(speed):
    ob = bpy.data.objects["Card 1"]
    if not ob.data.shape_keys:
        ob.shape_key_add(name="Basis")
        for i, point in enumerate(ob.shape_key_add(name="Bent").data):
            point.co += point.co * (0.8 if i % 2 else -0.4)
    keyed(ob.data.shape_keys.key_blocks["Bent"], "value", 0.0, min(speed, 1.0))


CASES = {
    "camera": lambda speed: move_camera(bpy.context.scene.camera, speed),
    "slide": slide,
    "spin": spin,
    "grow": lambda speed: grow(0.7 * speed),
    "deform": lambda speed: deform(0.9 * speed),
}


@pytest.mark.parametrize("name", CASES)
def test_blur_is_that_of_cycles(name, tmp_path):
    """Another speed by 10 % is noticed."""
    stage()
    bpy.context.scene.glanz.motion_steps = 32
    CASES[name](1.0)
    bpy.context.scene.frame_set(FRAME)
    cycles = parity.pixels("CYCLES", tmp_path)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, BLOCKS) < MOST
    CASES[name](1.1)
    bpy.context.scene.frame_set(FRAME)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, BLOCKS) > MOST


@pytest.mark.parametrize("position", ["START", "END"])
def test_the_shutter_opens_when_it_does_in_cycles(position, tmp_path):
    """A quarter of a frame off is noticed."""
    stage()
    open_shutter(0.5, position)
    slide(1.5)
    bpy.context.scene.frame_set(FRAME)
    cycles = parity.pixels("CYCLES", tmp_path)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, BLOCKS) < MOST
    open_shutter(0.5, "CENTER")
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, BLOCKS) > MOST


def test_moving_things_give_and_take_light_as_in_cycles(tmp_path):
    """A floor under a sun, a white box that spins over it, and light that bounces between them: 1 % in 16 blocks."""
    camera = blender.add_camera(location=(0, -6, 5), width=SIDE, height=SIDE)
    camera.rotation_euler = (math.radians(50), 0, 0)
    white = blender.new_material("White", "ShaderNodeBsdfDiffuse", Color=(0.8, 0.7, 0.6, 1))
    floor = blender.add_plane("Floor", 8.0)
    floor.data.materials.append(white)
    box = blender.add_plane("Box", 1.6, (0, 0, 0.8))
    box.data.materials.append(white)
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.angle, sun.energy = 0.1, 3.0
    blender.link("Sun", sun).rotation_euler = (0.5, 0.4, 0)
    blender.set_world((0.3, 0.3, 0.4))
    open_shutter()
    keyed(box, "rotation_euler", Euler((0.5, 0, -0.9)), Euler((0.5, 0, 1.4)))
    keyed(box, "location", (-0.7, 0, 0.8), (1.0, 0.3, 1.2))
    bpy.context.scene.frame_set(FRAME)
    parity.be_exact(SAMPLES, 2)
    glanz, cycles = parity.pixels("GLANZ", tmp_path), parity.pixels("CYCLES", tmp_path)
    assert parity.difference(glanz, cycles, 4) < MOST
    bpy.context.scene.render.use_motion_blur = False
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, BLOCKS) > 3 * MOST
    assert np.isfinite(glanz).all()


def life(moves):
    """The still life of `test_transport` under its glowing ball; `moves` says what else than the light moves."""
    test_transport.still_life(test_transport.glowing_ball)
    blender.set_world((0.15, 0.2, 0.25))
    open_shutter()
    if moves == "camera":
        keyed(bpy.context.scene.camera, "location", (-0.6, -7, 3), (0.6, -7.4, 3.2))
    else:
        keyed(bpy.data.objects["Cube"], "rotation_euler", Euler((0, 0, -0.6)), Euler((0.3, 0, 1.6)))
        keyed(bpy.data.objects["Sphere"], "location", (-1.5, -0.3, 0.8), (-0.7, 0.3, 1.1))
        keyed(bpy.data.objects["Icosphere"], "location", (0.6, -1.4, 3.0), (1.8, -0.4, 3.4))
    bpy.context.scene.frame_set(FRAME)


@pytest.mark.parametrize("moves", ["camera", "things"])
def test_life_in_motion_is_that_of_cycles_tile_by_tile(moves, tmp_path):
    """Mirrors, glass, dull things and a lamp: Welch's test on tiles, and blocks within 1 %. A still picture is noticed."""
    life(moves)
    ours, theirs = (welch.replicates(engine, tmp_path, test_transport.REPLICATES) for engine in ("GLANZ", "CYCLES"))
    assert parity.difference(ours.mean(axis=0), theirs.mean(axis=0)) <= MOST
    assert welch.agree(ours, theirs)
    bpy.context.scene.render.use_motion_blur = False
    assert not welch.agree(welch.replicates("GLANZ", tmp_path, 3), theirs)
