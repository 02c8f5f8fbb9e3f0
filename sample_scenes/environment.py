"""Light from a picture all around: a sky with a small bright sun and a dark ground, over a dull, a glossy and a mirror ball."""

import math

import common
import numpy as np
from mathutils import Matrix

WIDTH, HEIGHT = 128, 64
SUN_LONGITUDE, SUN_LATITUDE, SUN_RADIANCE = math.radians(62), math.radians(33), 900.0


def sky():
    """Linear radiance (HEIGHT, WIDTH, 4), row 0 at the bottom: blue that pales to the horizon, brown ground, a sun of a few pixels."""
    latitude = ((np.arange(HEIGHT) + 0.5) / HEIGHT - 0.5)[:, None] * math.pi
    longitude = ((np.arange(WIDTH) + 0.5) / WIDTH - 0.5)[None] * 2 * math.pi
    up = np.clip(np.sin(latitude), 0, 1)[..., None]
    colour = np.array((0.9, 0.85, 0.8)) * (1 - up) ** 3 + np.array((0.1, 0.25, 0.75)) * (1 - (1 - up) ** 3)
    colour = np.where(latitude[..., None] < 0, np.array((0.1, 0.07, 0.05)), 0.6 * colour) * np.ones((1, WIDTH, 1))
    apart = np.sin(latitude) * math.sin(SUN_LATITUDE) + np.cos(latitude) * math.cos(SUN_LATITUDE) * np.cos(longitude - SUN_LONGITUDE)
    colour[apart > math.cos(math.radians(2.5))] = SUN_RADIANCE * np.array((1.0, 0.85, 0.6))
    return np.concatenate((colour, np.ones((HEIGHT, WIDTH, 1))), axis=2).astype(np.float32)


def build():
    """The scene."""
    scene = common.new_scene("Environment", 512, 288, samples=128, max_depth=6)
    scene.glanz.sampler = "sobol"
    scene.world = common.picture_world("Sky", sky(), turned=math.radians(20))
    concrete = common.diffuse("Concrete", (0.32, 0.31, 0.3))
    common.add(scene, "Ground", common.quad("Ground", (-90, -90, 0), (180, 0, 0), (0, 180, 0), concrete))
    for x, material in (
        (-1.5, common.diffuse("Clay", (0.55, 0.28, 0.18))),
        (0.0, common.glossy("Brass", (0.8, 0.6, 0.25), 0.3)),
        (1.5, common.glossy("Chrome", (0.9, 0.9, 0.9), 0.0)),
    ):
        ball = common.sphere(material.name, 0.65, material, segments=48, rings=24)
        common.add(scene, material.name, ball, Matrix.Translation((x, 0.0, 0.65)))
    common.camera(scene, (0.3, -6.3, 1.5), (0.0, 0.0, 0.85), lens=46.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
