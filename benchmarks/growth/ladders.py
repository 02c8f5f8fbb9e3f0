"""The ladders: of each what grows, its sizes, and the scene and settings of a rung."""

import dataclasses
import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from glanz.engine import (
    Bitmap,
    Coordinates,
    ImageTexture,
    Lambert,
    Material,
    Mesh,
    Object,
    PerspectiveCamera,
    PointLight,
    Scene,
    Settings,
)

from ..many_lights import block, hall

BASE = Settings(width=128, height=128, samples=4, max_depth=3, threads=2)
LAMPS = 10
"""In the hall, where something else than lamps grows."""
TILE = 128
"""Longer side of each picture where their number grows [texels]."""
GENERATED = Coordinates(source="generated")


@dataclass(frozen=True)
class Ladder:
    """What grows.

    label   of what the sizes are numbers
    sizes   of the rungs, rising
    quick   how many of them are in the quick ladder
    rung    size -> (scene, settings)
    """

    label: str
    sizes: tuple
    quick: int
    rung: Callable


def hills(triangles):
    """About so many `triangles` of one mesh, a lamp above; the view is the same for all."""
    side = max(round(math.sqrt(triangles / 2)), 1)
    x, y = np.meshgrid(*[np.linspace(-3, 3, side + 1, dtype=np.float32)] * 2)
    z = 0.3 * np.sin(3 * x) * np.cos(2 * y)
    corner = (np.arange(side)[:, None] * (side + 1) + np.arange(side)).ravel().astype(np.int32)
    a, b, c, d = corner, corner + 1, corner + side + 2, corner + side + 1
    triangles = np.concatenate((np.stack((a, b, c)), np.stack((a, c, d))), axis=1)
    mesh = Mesh(name="hills", vertices=np.stack((x.ravel(), y.ravel(), z.ravel())), triangles=triangles)
    return _lit([Object(name="hills", mesh=mesh, materials=(Material(name="grey", lobes=(Lambert((0.6,) * 3),)),))])


def board(count, side):
    """Blocks side by side, each with one of `count` pictures of `side` x `side` texels; all of them are seen at any number."""
    columns = math.ceil(math.sqrt(count))
    rng, step, objects = np.random.default_rng(1), 6 / columns, []
    for i in range(count):
        x, y = -3 + step * (i % columns), -3 + step * (i // columns)
        picture = Bitmap(name=f"picture {i}", pixels=rng.integers(0, 256, (4, side, side), np.uint8))
        dressed = Material(name=f"material {i}", lobes=(Lambert(ImageTexture(picture, GENERATED)),))
        objects.append(dataclasses.replace(block((x, y, -0.1), (x + step, y + step, 0), f"block {i}"), materials=(dressed,)))
    return _lit(objects)


def _lit(objects):
    camera = PerspectiveCamera.look_at((4, -5, 4), (0, 0, 0), fov=0.8)
    return Scene(camera=camera, objects=objects, lights=[PointLight(name="lamp", position=(1, -1, 4), intensity=(30,) * 3)])


def _with(**changes):
    return dataclasses.replace(BASE, **changes)


LADDERS = {
    "pixels": Ladder(
        "pixels",
        tuple(side**2 for side in (32, 64, 128, 256, 512, 1024, 2048)),
        5,
        lambda size: (hall(LAMPS), _with(width=math.isqrt(size), height=math.isqrt(size))),
    ),
    "samples": Ladder("samples per pixel", (1, 4, 16, 64, 256, 1024), 4, lambda size: (hall(LAMPS), _with(samples=size))),
    "triangles": Ladder("triangles", (10**3, 10**4, 10**5, 10**6, 10**7), 4, lambda size: (hills(size), BASE)),
    "lights": Ladder("point lamps", (1, 10, 100, 1000, 10_000), 5, lambda size: (hall(size), BASE)),
    "textures": Ladder(f"pictures of {TILE} x {TILE} texels", (1, 4, 16, 64, 256, 1024), 4, lambda size: (board(size, TILE), BASE)),
    "texels": Ladder(
        "texels of one picture",
        tuple(side**2 for side in (64, 256, 1024, 2048, 4096, 8192)),
        4,
        lambda size: (board(1, math.isqrt(size)), BASE),
    ),
    "threads": Ladder("threads", (1, 2), 2, lambda size: (hall(LAMPS), _with(width=256, height=256, samples=16, threads=size))),
}
"""By name. Each grows alone: the rest is a hall with ten lamps, or as small, at the settings BASE."""
