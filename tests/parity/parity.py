"""Cycles as an oracle: the same open file rendered by both engines, with nothing cut off by either."""

import bpy
import numpy as np

from glanz.tests.addon import blender

TOLERANCE = 0.005
"""Largest relative difference between the block means of the two engines."""
BLOCKS = 4
"""Blocks per side of the picture."""
FLOOR = 0.25
"""Blocks darker than this share of the brightest one are compared in units of it."""


def be_exact(samples, max_depth):
    """Settings for both engines: box filter, equal samples and bounces, no bias (clamps, thresholds, blurs), two threads."""
    scene = bpy.context.scene
    scene.render.threads_mode, scene.render.threads = "FIXED", 2
    cycles, glanz = scene.cycles, scene.glanz
    cycles.device = "CPU"
    glanz.samples = cycles.samples = samples
    glanz.max_depth = cycles.max_bounces = cycles.diffuse_bounces = max_depth
    glanz.pixel_filter, cycles.pixel_filter_type = "box", "BOX"
    cycles.use_adaptive_sampling = cycles.use_denoising = cycles.use_guiding = False
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = cycles.blur_glossy = 0


def pixels(engine, path):
    """(height, width, 3) float64 of a saved EXR file of single precision, rendered by `engine` through F12."""
    bpy.context.scene.render.engine = engine
    passes = blender.read_exr(blender.render(path / f"{engine}.exr"))
    (combined,) = (values for name, values in passes.items() if name.endswith(".Combined"))
    assert np.isfinite(combined).all()
    return combined[..., :3].astype(np.float64)


def block_means(image, blocks=BLOCKS):
    """(blocks, blocks, 3)."""
    height, width, _ = image.shape
    return image.reshape(blocks, height // blocks, blocks, width // blocks, 3).mean(axis=(1, 3))


def difference(image, reference, blocks=BLOCKS):
    """The largest relative difference of the means of `blocks` x `blocks` blocks of two pictures."""
    a, b = block_means(image, blocks), block_means(reference, blocks)
    brightest = b.max()
    assert brightest > 0, "the reference is black"
    return float((np.abs(a - b) / np.maximum(b, FLOOR * brightest)).max())
