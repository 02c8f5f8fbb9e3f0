"""Shadows that soften with distance: a fence under a large square lamp, by distributed ray tracing."""

import common
from mathutils import Matrix

POSTS = 7


def build():
    """The scene."""
    scene = common.new_scene("Soft shadow", 480, 320, samples=16, max_depth=2)
    scene.glanz.integrator = "distributed"
    scene.glanz.branches = 16
    common.add(scene, "Floor", common.quad("Floor", (-9, -9, 0), (18, 0, 0), (0, 18, 0), common.diffuse("Sand", (0.62, 0.55, 0.44))))
    paint = common.diffuse("Paint", (0.15, 0.3, 0.5))
    for number in range(POSTS):
        height = 0.35 + 0.2 * number
        post = common.box(f"Post {number}", (0.16, 0.16, height), paint)
        common.add(scene, f"Post {number}", post, Matrix.Translation((0.55 * (number - 0.5 * (POSTS - 1)), 0.4, 0.0)))
    ball = common.sphere("Ball", 0.35, common.diffuse("Coral", (0.75, 0.25, 0.18)))
    common.add(scene, "Ball", ball, Matrix.Translation((-0.9, -1.0, 0.95)))
    common.light(scene, "Lamp", "AREA", (-2.2, 3.4, 4.2), (0.0, -0.3, 0.3), 420.0, shape="SQUARE", size=1.2, color=(1.0, 0.92, 0.8))
    scene.world = common.world((0.5, 0.65, 1.0), 0.12)
    common.camera(scene, (0.9, -5.8, 3.1), (0.0, -0.4, 0.4), lens=44.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
