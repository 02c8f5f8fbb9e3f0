"""Every light gives as much light as in Cycles.

A white diffuse plane is seen from above, 16 blocks of 8 x 8 pixels, so that both how much light arrives and how it falls
off are compared. Renders of the same case with other seeds differ by far less than what is allowed: a light that is off
by 1 % is noticed, and each case shows that it would be.
"""

import math

import bpy
import numpy as np
import pytest
from mathutils import Euler, Matrix

from glanz.tests.addon import blender
from glanz.tests.parity import parity

SAMPLES = 256
NOISY_SAMPLES = 1024
FRAME = 1.6
"""Side of the square of the plane that is seen [m]."""


def look_at_plane(scale):
    """A white plane, and a camera that sees `FRAME` metres of it; everything `scale` times as large."""
    camera = blender.add_camera(location=(0, 0, 4 * scale), width=32, height=32)
    camera.data.clip_start, camera.data.clip_end = 0.1 * scale, 100 * scale
    camera.data.sensor_width, camera.data.lens = 36, 36 * 4 / FRAME
    plane = blender.add_plane(size=20 * scale)
    plane.data.materials.append(blender.new_material("White", "ShaderNodeBsdfDiffuse", Color=(1, 1, 1, 1)))
    bpy.context.scene.world = None


def add_light(kind, at=(0.35, -0.2, 1.1), turn=(0, 0, 0), stretch=(1, 1, 1), scale=1.0, energy=37.0, **attributes):
    """A light at `at` [m], turned by Euler angles [rad] and stretched; lengths, and powers to fit, times `scale`."""
    data = bpy.data.lights.new(kind.title(), kind)
    data.energy = energy * (1.0 if kind == "SUN" else scale**2)
    data.color = (1.0, 0.7, 0.4)
    for name, value in attributes.items():
        is_length = name in ("shadow_soft_size", "size", "size_y")
        setattr(data, name, value * scale if is_length else value)
    light = blender.link(data.name, data)
    rotation = Euler(turn).to_matrix().to_4x4()
    light.matrix_world = Matrix.Translation([scale * c for c in at]) @ rotation @ Matrix.Diagonal((*stretch, 1))
    return data


POINTS = {
    "point": {"shadow_soft_size": 0},
    "weak point": {"shadow_soft_size": 0, "energy": 1e-4},
    "strong point": {"shadow_soft_size": 0, "energy": 1e6},
    "soft bulb": {"shadow_soft_size": 0.4},
    "hard bulb": {"shadow_soft_size": 0.4, "use_soft_falloff": False},
    "stretched bulb": {"shadow_soft_size": 0.3, "stretch": (2.0, 0.5, 3.0)},
    "tiny world": {"shadow_soft_size": 0.4, "scale": 0.002},
    "large world": {"shadow_soft_size": 0.4, "scale": 500.0},
}
TURN = (0.25, 0.2, 0.3)
SPOTS = {
    "narrow": {"spot_size": 0.5, "spot_blend": 0.15, "shadow_soft_size": 0},
    "hard edge": {"spot_size": 0.9, "spot_blend": 0, "shadow_soft_size": 0},
    "blend": {"spot_size": 1.2, "spot_blend": 1, "shadow_soft_size": 0},
    "wide": {"spot_size": 2.8, "spot_blend": 1, "shadow_soft_size": 0},
    "half space": {"spot_size": math.pi, "spot_blend": 1, "shadow_soft_size": 0},
    "soft bulb": {"spot_size": 1.0, "spot_blend": 0.5, "shadow_soft_size": 0.2},
    "hard bulb": {"spot_size": 1.0, "spot_blend": 0.5, "shadow_soft_size": 0.2, "use_soft_falloff": False},
    "stretched": {"spot_size": 0.8, "spot_blend": 0.5, "shadow_soft_size": 0, "stretch": (1.6, 0.7, 1.2)},
    "squeezed": {"spot_size": 0.8, "spot_blend": 0.5, "shadow_soft_size": 0, "stretch": (1.5, 2.0, 0.8)},
    "large world": {"spot_size": 1.0, "spot_blend": 0.5, "shadow_soft_size": 0.2, "scale": 500.0},
}
SUNS = {
    "direction": {"angle": 0},
    "small": {"angle": math.radians(0.53)},
    "wide": {"angle": math.radians(60)},
    "half sky": {"angle": math.radians(175)},
    "stretched": {"angle": math.radians(20), "stretch": (2.0, 0.5, 3.0)},
    "weak": {"angle": 0.1, "energy": 1e-4},
}
SQUARE = {"shape": "SQUARE", "size": 0.7}
OBLONG = {"size": 0.9, "size_y": 0.35}
AREAS = {
    "square": SQUARE,
    "rectangle": {"shape": "RECTANGLE", **OBLONG},
    "disk": {"shape": "DISK", "size": 0.8},
    "ellipse": {"shape": "ELLIPSE", **OBLONG},
    "stretched rectangle": {"shape": "RECTANGLE", **OBLONG, "stretch": (1.5, 0.6, 3.0)},
    "stretched disk": {"shape": "DISK", "size": 0.8, "stretch": (1.5, 0.6, 3.0)},
    "mirrored ellipse": {"shape": "ELLIPSE", **OBLONG, "stretch": (-1.5, 0.6, 1.0)},
    "spread of 120 degrees": {**SQUARE, "spread": math.radians(120)},
    "spread of 60 degrees": {"shape": "DISK", "size": 0.6, "spread": math.radians(60)},
    "spread, stretched": {"shape": "ELLIPSE", **OBLONG, "spread": math.radians(90), "stretch": (1.5, 0.6, 3.0)},
    "weak": {**SQUARE, "energy": 1e-4},
    "strong": {**SQUARE, "energy": 1e6},
    "tiny world": {**SQUARE, "scale": 0.002},
    "large world": {**SQUARE, "scale": 500.0},
}
LATER_ATTRIBUTES = {"exposure", "use_temperature", "normalize"}
LATER = {
    "exposure": ("POINT", {"exposure": 1.5}),
    "temperature": ("AREA", {"use_temperature": True, "temperature": 3200.0}),
    "cold temperature": ("SUN", {"use_temperature": True, "temperature": 11000.0, "angle": 0.2}),
    "point, not normalised": ("POINT", {"normalize": False, "shadow_soft_size": 0.3}),
    "point without a size, not normalised": ("POINT", {"normalize": False, "shadow_soft_size": 0.0}),
    "spot, not normalised": ("SPOT", {"normalize": False, "shadow_soft_size": 0.3, "spot_size": 1.2}),
    "area, not normalised": ("AREA", {"normalize": False, "shape": "ELLIPSE", **OBLONG, "stretch": (1.5, 0.6, 1.0)}),
    "sun, not normalised": ("SUN", {"normalize": False, "angle": 0.5}),
    "direction, not normalised": ("SUN", {"normalize": False, "angle": 0.0}),
}
CASES = [
    *((f"point: {name}", "POINT", values) for name, values in POINTS.items()),
    *((f"spot: {name}", "SPOT", {"turn": TURN, **values}) for name, values in SPOTS.items()),
    *((f"sun: {name}", "SUN", {"turn": TURN, **values}) for name, values in SUNS.items()),
    *((f"area: {name}", "AREA", {"turn": TURN, **values}) for name, values in AREAS.items()),
    *((f"later: {name}", kind, {"turn": TURN, **values}) for name, (kind, values) in LATER.items()),
]


def compare(path, samples=SAMPLES, blocks=parity.BLOCKS):
    """Fails where Glanz differs from Cycles, and where it would not if the light were off by 1 %."""
    parity.be_exact(samples, max_depth=0)
    cycles, glanz = parity.pixels("CYCLES", path), parity.pixels("GLANZ", path)
    assert parity.difference(glanz, cycles, blocks) < parity.TOLERANCE
    assert parity.difference(1.01 * glanz, cycles, blocks) > parity.TOLERANCE


@pytest.mark.parametrize(("kind", "attributes"), [case[1:] for case in CASES], ids=[case[0] for case in CASES])
def test_a_light_gives_as_much_as_in_cycles(kind, attributes, tmp_path):
    if not LATER_ATTRIBUTES.isdisjoint(attributes) and bpy.app.version < (4, 5):
        pytest.skip("exposure, temperature and normalisation of lights came with Blender 4.5")
    look_at_plane(attributes.get("scale", 1.0))
    add_light(kind, **attributes)
    # Where light changes within the size of the lamp, noise is greatest.
    is_noisy = (kind == "SPOT" and attributes.get("shadow_soft_size") != 0) or "spread" in attributes
    compare(tmp_path, NOISY_SAMPLES if is_noisy else SAMPLES)


def test_an_emissive_square_gives_as_much_as_in_cycles(tmp_path):
    """Both sides shine; it stands just outside the picture."""
    look_at_plane(1.0)
    lamp = blender.add_plane(name="Lamp", size=0.5)
    lamp.matrix_world = Matrix.Translation((1.3, 0.1, 0.9)) @ Euler((0.3, 0.8, 0.1)).to_matrix().to_4x4()
    lamp.data.materials.append(glow())
    compare(tmp_path, samples=512)


def test_an_emissive_sphere_gives_as_much_as_in_cycles(tmp_path):
    """A light of many triangles, stretched. They hide each other, which is noise, so only the whole picture is compared."""
    look_at_plane(1.0)
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=3, radius=0.3, location=(1.3, 0.1, 0.9), scale=(1.0, 0.7, 1.2))
    bpy.context.object.data.materials.append(glow())
    compare(tmp_path, samples=1024, blocks=1)


def glow():
    return blender.new_material("Glow", "ShaderNodeEmission", Color=(1.0, 0.7, 0.4, 1), Strength=11.0)


@pytest.mark.parametrize("strength", [1e-3, 1.0, 50.0])
def test_a_constant_world_gives_as_much_as_in_cycles(strength, tmp_path):
    """Half of the world is hidden from the plane by a black wall, so that what is compared is not the same everywhere."""
    look_at_plane(1.0)
    wall = blender.add_plane(name="Wall", size=3.0)
    wall.matrix_world = Matrix.Translation((1.2, 0, 0)) @ Euler((0, math.pi / 2, 0)).to_matrix().to_4x4()
    wall.data.materials.append(blender.new_material("Black", "ShaderNodeBsdfDiffuse", Color=(0, 0, 0, 1)))
    blender.set_world((1.0, 0.7, 0.4), strength)
    compare(tmp_path, samples=512)


MUTANTS = {
    "spot angle": ("SPOT", SPOTS["blend"], {"spot_size": 1.2 + math.radians(1)}),
    "spot blend": ("SPOT", SPOTS["soft bulb"], {"spot_blend": 0.55}),
    "falloff of the bulb": ("POINT", POINTS["hard bulb"], {"use_soft_falloff": True}),
    "shape of the area": ("AREA", AREAS["ellipse"], {"shape": "RECTANGLE"}),
    "size of the area": ("AREA", AREAS["square"], {"size": 0.78}),
    "spread of the area": ("AREA", AREAS["spread of 60 degrees"], {"spread": math.radians(61)}),
    "angle of the sun": ("SUN", SUNS["half sky"], {"angle": math.radians(165)}),
}


@pytest.mark.parametrize(("kind", "attributes", "mutant"), MUTANTS.values(), ids=MUTANTS)
def test_a_light_that_differs_in_one_attribute_is_noticed(kind, attributes, mutant, tmp_path):
    look_at_plane(1.0)
    data = add_light(kind, **{"turn": TURN, **attributes})
    parity.be_exact(NOISY_SAMPLES, max_depth=0)
    cycles = parity.pixels("CYCLES", tmp_path)
    for name, value in mutant.items():
        assert getattr(data, name) != value
        setattr(data, name, value)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), cycles) > parity.TOLERANCE


@pytest.mark.parametrize(
    ("kind", "attributes", "samples"),
    [
        ("POINT", POINTS["hard bulb"], SAMPLES),
        ("SPOT", SPOTS["hard bulb"], NOISY_SAMPLES),
        ("SPOT", SPOTS["hard edge"], SAMPLES),
        ("SPOT", SPOTS["narrow"], SAMPLES),
        ("SUN", SUNS["half sky"], SAMPLES),
        ("AREA", AREAS["stretched disk"], SAMPLES),
        ("AREA", AREAS["spread of 60 degrees"], NOISY_SAMPLES),
    ],
)
def test_noise_is_far_below_what_is_allowed(kind, attributes, samples, tmp_path):
    """Two seeds of one engine, for both; their difference has sqrt(2) times the noise of one. Without it, luck would decide."""
    look_at_plane(1.0)
    add_light(kind, **{"turn": TURN, **attributes})
    parity.be_exact(samples, max_depth=0)
    scene = bpy.context.scene
    for engine, settings in (("GLANZ", scene.glanz), ("CYCLES", scene.cycles)):
        first = parity.pixels(engine, tmp_path)
        settings.seed += 1
        second = parity.pixels(engine, tmp_path)
        assert not np.array_equal(first, second)
        assert parity.difference(first, second) < 0.5 * parity.TOLERANCE
