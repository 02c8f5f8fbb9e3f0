"""Every camera sees what Cycles' sees: glowing cards at random places, and what is hidden by the clip range.

The pictures have sharp edges everywhere, so that a camera that is off by a fraction of a pixel is noticed; each kind of
camera shows that it would be. Nothing is random but the places in the pixel and on the lens.
"""

import math
import random

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix, Vector

from glanz.tests.addon import blender
from glanz.tests.parity import parity, welch

SIDE, BLOCKS = 64, 8
SAMPLES = 64
LENS_SAMPLES = 512
MOST = 0.01
TURN = Euler((1.1, 0.2, -0.6))
COLOURS = ((1.0, 0.2, 0.1), (0.1, 0.9, 0.3), (0.2, 0.3, 1.0), (0.8, 0.7, 0.1), (0.6, 0.1, 0.7))


def glow(colour, strength):
    return blender.new_material("Glow", "ShaderNodeEmission", Color=(*colour, 1), Strength=strength)


def cards(directions, distances, size=0.35, seed=3):
    """Glowing squares at `distances` [m] into random ones of `directions` (of the camera's frame); size in radians."""
    rng = random.Random(seed)
    materials = [glow(colour, 1.0) for colour in COLOURS]
    for i, distance in enumerate(distances):
        away = Vector(directions(rng)).normalized()
        card = blender.add_plane(name=f"Card {i}", size=size * distance * rng.uniform(0.5, 1.5))
        card.data.materials.append(materials[i % len(materials)])
        turn = away.to_track_quat("Z", "Y").to_matrix() @ Euler([rng.uniform(-0.5, 0.5) for _ in range(3)]).to_matrix()
        card.matrix_world = camera_matrix() @ Matrix.Translation(distance * away) @ turn.to_4x4()
    blender.set_world((0.2, 0.25, 0.3))


def camera_matrix():
    return Matrix.Translation((3.0, -2.0, 1.0)) @ TURN.to_matrix().to_4x4()


def ahead(rng):
    return rng.uniform(-0.4, 0.4), rng.uniform(-0.4, 0.4), -1.0


def around(rng):
    return rng.gauss(0, 1), rng.gauss(0, 1), rng.gauss(0, 1)


def add_camera(kind, **attributes):
    """A camera at an odd place; dotted names reach into its data."""
    ob = blender.add_camera(width=SIDE, height=SIDE, type=kind)
    ob.matrix_world = camera_matrix()
    for name, value in attributes.items():
        change(name, value)
    return ob


def change(name, value):
    owner = bpy.context.scene.camera.data
    if name.startswith("dof_"):
        owner, name = owner.dof, name.removeprefix("dof_")
    elif not hasattr(owner, name):
        owner = owner.cycles
    setattr(owner, name, value)


CAMERAS = {
    "perspective": ("PERSP", ahead, {"lens": 40.0, "shift_x": 0.1, "shift_y": -0.07}),
    "orthographic": ("ORTHO", ahead, {"ortho_scale": 4.5, "shift_x": 0.1, "shift_y": -0.07}),
    "orthographic, fitted": ("ORTHO", ahead, {"ortho_scale": 4.0, "sensor_fit": "VERTICAL", "shift_x": -0.1}),
    "panorama": ("PANO", around, {"panorama_type": "EQUIRECTANGULAR"}),
    "part of a panorama": (
        "PANO",
        around,
        {
            "panorama_type": "EQUIRECTANGULAR",
            "longitude_min": -2.0, "longitude_max": 1.2, "latitude_min": -0.3, "latitude_max": 1.3,
            "shift_x": 0.1, "shift_y": 0.05,
        },
    ),
}  # fmt: skip


def render_both(path, samples=SAMPLES):
    parity.be_exact(samples, max_depth=0)
    return parity.pixels("GLANZ", path), parity.pixels("CYCLES", path)


@pytest.mark.parametrize("name", CAMERAS)
def test_a_camera_sees_what_it_sees_in_cycles(name, tmp_path):
    """A view that is shifted by half a pixel is noticed."""
    kind, directions, attributes = CAMERAS[name]
    add_camera(kind, **attributes)
    cards(directions, [2 + 0.3 * i for i in range(25)])
    bpy.context.scene.render.pixel_aspect_x = 1.0 if kind == "PANO" else 1.3
    glanz, cycles = render_both(tmp_path)
    assert parity.difference(glanz, cycles, BLOCKS) < MOST
    change("shift_x", bpy.context.scene.camera.data.shift_x + 0.5 / SIDE)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, BLOCKS) > MOST


def depths(engine, path):
    parity.pixels(engine, path)
    passes = blender.read_exr(path / f"{engine}.exr")
    (depth,) = (values for name, values in passes.items() if name.endswith(".Depth"))
    return depth[..., 0].astype(np.float64)


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO", "PANO"])
def test_depth_is_that_of_cycles(kind, tmp_path):
    """Along the axis, or along the ray in a panorama, which is 30 % apart at a corner; to 0.5 % on a large tilted plane.

    Depth is that of one random point of the pixel, so blocks of pixels are compared.
    """
    add_camera(kind, **({"panorama_type": "EQUIRECTANGULAR"} if kind == "PANO" else {"lens": 18.0}))
    plane = blender.add_plane(size=1e4)
    plane.matrix_world = camera_matrix() @ Matrix.Translation((0, 0, -5)) @ Euler((0.1, 0.05, 0)).to_matrix().to_4x4()
    plane.data.materials.append(glow((1, 1, 1), 1.0))
    bpy.context.view_layer.use_pass_z = True
    parity.be_exact(1, max_depth=0)
    glanz, cycles = depths("GLANZ", tmp_path), depths("CYCLES", tmp_path)
    blocks = glanz.reshape(8, 8, 8, 8), cycles.reshape(8, 8, 8, 8)
    near = np.maximum(*(values.max(axis=(1, 3)) for values in blocks)) < 12
    assert near.sum() >= 8
    ratio = blocks[0].mean(axis=(1, 3))[near] / blocks[1].mean(axis=(1, 3))[near]
    assert np.abs(ratio - 1).max() < 0.005


@pytest.mark.parametrize("kind", ["PERSP", "ORTHO", "PANO"])
def test_the_clip_range_hides_as_in_cycles_and_leaves_shadows(kind, tmp_path):
    """Cards before, in and behind the range over a floor lit by a sun; what is hidden still shades."""
    add_camera(kind, lens=24.0, clip_start=3.0, clip_end=8.0, **({"panorama_type": "EQUIRECTANGULAR"} if kind == "PANO" else {}))
    cards(around if kind == "PANO" else ahead, [1 + 0.35 * i for i in range(25)])
    floor = blender.add_plane(name="Floor", size=40.0)
    floor.matrix_world = camera_matrix() @ Matrix.Translation((0, 0, -7)) @ Euler((0.8, 0.2, 0)).to_matrix().to_4x4()
    floor.data.materials.append(blender.new_material("White", "ShaderNodeBsdfDiffuse", Color=(1, 1, 1, 1)))
    sun = bpy.data.lights.new("Sun", "SUN")
    sun.angle, sun.energy = 0.0, 3.0
    blender.link("Sun", sun).matrix_world = camera_matrix() @ Euler((0.35, 0.3, 0)).to_matrix().to_4x4()
    bpy.context.scene.world = None
    glanz, cycles = render_both(tmp_path, 4 * SAMPLES)
    # Cards glow on the floor too, which is noise.
    assert parity.difference(glanz, cycles, 4) < 2 * MOST
    for name, value in (("clip_start", 0.01), ("clip_end", 1000.0)):
        before = getattr(bpy.context.scene.camera.data, name)
        change(name, value)
        assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, 4) > 4 * MOST
        change(name, before)


LENSES = {
    "disk": ("PERSP", {}),
    "turned triangle": ("PERSP", {"dof_aperture_blades": 3, "dof_aperture_rotation": 0.4}),
    "anamorphic hexagon": ("PERSP", {"dof_aperture_blades": 6, "dof_aperture_rotation": 0.2, "dof_aperture_ratio": 2.0}),
    "orthographic": ("ORTHO", {"ortho_scale": 4.5, "dof_aperture_fstop": 1.2, "dof_aperture_blades": 5}),
    "panorama": ("PANO", {"panorama_type": "EQUIRECTANGULAR", "dof_aperture_blades": 3, "dof_aperture_ratio": 0.7}),
}


@pytest.mark.parametrize("name", LENSES)
def test_defocus_is_that_of_cycles(name, tmp_path):
    """Cards from 2 to 10 m, in focus at 4 m. An aperture of another size, or the same one half a blade on, is noticed."""
    kind, attributes = LENSES[name]
    add_camera(kind, dof_use_dof=True, dof_focus_distance=4.0, dof_aperture_fstop=0.05 if kind != "ORTHO" else 1.0)
    for key, value in attributes.items():
        change(key, value)
    cards(around if kind == "PANO" else ahead, [2 + 0.32 * i for i in range(25)])
    glanz, cycles = render_both(tmp_path, LENS_SAMPLES)
    assert parity.difference(glanz, cycles, BLOCKS) < MOST
    dof = bpy.context.scene.camera.data.dof
    if dof.aperture_blades == 3:
        change("dof_aperture_rotation", dof.aperture_rotation + math.pi / 3)
    else:
        change("dof_aperture_fstop", 1.1 * dof.aperture_fstop)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, BLOCKS) > MOST


def test_focus_on_an_object_is_that_of_cycles(tmp_path):
    """The distance is that of its plane, along the axis of the camera."""
    add_camera("PERSP", dof_use_dof=True, dof_aperture_fstop=0.05)
    target = blender.link("Target", None)
    target.matrix_world = camera_matrix() @ Matrix.Translation((2.5, -1.0, -4.0))
    bpy.context.scene.camera.data.dof.focus_object = target
    cards(ahead, [2 + 0.32 * i for i in range(25)])
    glanz, cycles = render_both(tmp_path, LENS_SAMPLES)
    assert parity.difference(glanz, cycles, BLOCKS) < MOST
    target.matrix_world = target.matrix_world @ Matrix.Translation((0, 0, -0.4))
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles, BLOCKS) > MOST


def test_no_tile_of_a_picture_out_of_focus_differs_from_cycles(tmp_path):
    """By Welch's test on tiles of 16 x 16 pixels, 8 replicates of 64 samples; an aperture a tenth smaller is noticed."""
    add_camera("PERSP", dof_use_dof=True, dof_focus_distance=4.0, dof_aperture_fstop=0.05, dof_aperture_blades=5)
    cards(ahead, [1.5 + 0.3 * i for i in range(25)])
    parity.be_exact(64, max_depth=0)
    ours, theirs = (welch.replicates(engine, tmp_path, 8) for engine in ("GLANZ", "CYCLES"))
    assert parity.difference(ours.mean(axis=0), theirs.mean(axis=0)) < MOST
    assert welch.agree(ours, theirs)
    change("dof_aperture_fstop", 0.055)
    smaller = welch.replicates("GLANZ", tmp_path, 8)
    assert np.isfinite(smaller).all()
    assert not welch.agree(smaller, theirs)
