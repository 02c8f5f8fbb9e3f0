"""One to ten thousand lamps of the same power in all: time and error at equal samples, and what one choice costs."""

import dataclasses
import json
import os
import time

import numpy as np

from glanz.engine import Lambert, Material, Mesh, Object, PerspectiveCamera, PointLight, Requirements, Scene, Settings, render_image
from glanz.engine.plan import Plan

COUNTS = (1, 10, 100, 1000, 10_000)
SETTINGS = Settings(width=192, height=192, samples=16, max_depth=2, threads=2)
LANES = 2**16


def block(low, high, name):
    """An axis-aligned box as an `Object`."""
    low, high = np.array(low, float)[:, None], np.array(high, float)[:, None]
    corners = np.array([(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)], float).T
    faces = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))
    triangles = [triangle for a, b, c, d in faces for triangle in ((a, b, c), (a, c, d))]
    mesh = Mesh(name=name, vertices=low + corners * (high - low), triangles=np.array(triangles).T)
    return Object(name=name, mesh=mesh, materials=(Material(name="grey", lobes=(Lambert((0.6,) * 3),)),))


def hall(count):
    """A floor with 25 blocks, `count` bulbs at random places above it."""
    rng = np.random.default_rng(1)
    squares = [(x, y) for x in range(-2, 3) for y in range(-2, 3)]
    blocks = [block((x - 0.2, y - 0.2, 0), (x + 0.2, y + 0.2, 0.3 + 0.1 * ((x + y) % 3)), f"{x} {y}") for x, y in squares]
    places = np.stack((rng.uniform(-3, 3, count), rng.uniform(-3, 3, count), rng.uniform(0.8, 1.6, count)), axis=1)
    return Scene(
        camera=PerspectiveCamera.look_at((5, -6, 5), (0, 0, 0), fov=0.8),
        objects=[block((-3, -3, -0.1), (3, 3, 0), "floor"), *blocks],
        lights=[PointLight(name=f"{i}", position=tuple(place), intensity=(30 / count,) * 3) for i, place in enumerate(places.tolist())],
    )


def picture(scene, seed):
    """(radiance, seconds of all threads)."""
    start = time.process_time()
    image = render_image(scene, dataclasses.replace(SETTINGS, seed=seed))
    return image.passes["Combined"][..., :3].astype(float), time.process_time() - start


def choice_cost(scene):
    """Nanoseconds for one choice, at places that are spread over the floor."""
    world = Plan.of(scene, SETTINGS, Requirements.of(scene, SETTINGS)).world
    rng = np.random.default_rng(2)
    p = np.concatenate((rng.uniform(-3, 3, (2, LANES)), np.zeros((1, LANES))))
    p, u2 = world.frame.points(p).astype(np.float32), rng.random((2, LANES), np.float32)
    best = np.inf
    for _ in range(5):
        start = time.thread_time()
        world.lights.choice.choose(p, u2.copy())
        best = min(best, time.thread_time() - start)
    return best / LANES * 1e9


def main():
    result = {}
    for count in COUNTS:
        scene = hall(count)
        (a, first), (b, second) = picture(scene, 1), picture(scene, 2)
        result[f"seconds_{count}"] = min(first, second)
        # Relative to the mean, from two pictures with noise of their own.
        result[f"error_{count}"] = float(np.sqrt(((a - b) ** 2).mean() / 2) / a.mean())
        result[f"choice_{count}"] = choice_cost(scene)
    print(json.dumps(result), flush=True)


if __name__ == "__main__":
    main()
    os._exit(0)
