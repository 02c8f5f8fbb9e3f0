"""What motion costs: the Cornell box with a camera, a ball or both balls that move, against the same at rest, in turns."""

import dataclasses
import time
from statistics import median

import numpy as np

from glanz.addon.capture import capture
from glanz.engine import render_image

from . import blender

SIDE, SAMPLES, ROUNDS = 256, 16, 5


def main():
    blender.open_cornell_box(SAMPLES, SIDE, SIDE)
    with blender.quiet():
        scene, settings, _ = capture()
    scenes = {"still": scene, **in_motion(scene)}
    seconds = {name: [] for name in scenes}
    for _ in range(ROUNDS):
        for name, moved in scenes.items():
            start = time.process_time()
            render_image(moved, settings)
            seconds[name].append(time.process_time() - start)
    still = seconds.pop("still")
    blender.finish({name: median(a / b for a, b in zip(times, still)) for name, times in seconds.items()})


def in_motion(scene):
    """{name: the scene with something that moves}."""
    camera = dataclasses.replace(scene.camera, motion=_pushed(scene.camera.world_from_camera))
    # The finest meshes are the balls.
    balls = sorted(scene.objects, key=lambda o: o.mesh.triangles.shape[1])[-2:]

    def with_moving(moving):
        return dataclasses.replace(scene, objects=tuple(moving(o) if o in balls else o for o in scene.objects))

    return {
        "camera": dataclasses.replace(scene, camera=camera),
        "ball": with_moving(lambda o: _slid(o) if o is balls[0] else o),
        "balls": with_moving(_slid),
        "spin": with_moving(_spun),
        "deform": with_moving(_deformed),
    }


def _pushed(matrix, by=0.1):
    keys = np.stack([matrix, matrix])
    keys[1, 0, 3] += by
    return keys


def _slid(o):
    return dataclasses.replace(o, motion=_pushed(o.world_from_object))


def _spun(o):
    turn = np.eye(4)
    turn[:2, :2] = [[0.0, -1.0], [1.0, 0.0]]
    return dataclasses.replace(o, motion=np.stack([o.world_from_object, o.world_from_object @ turn]))


def _deformed(o):
    return dataclasses.replace(o, mesh=dataclasses.replace(o.mesh, shapes=np.stack([o.mesh.vertices, 1.1 * o.mesh.vertices])))


if __name__ == "__main__":
    main()
