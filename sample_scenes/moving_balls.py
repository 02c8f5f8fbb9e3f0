"""Balls that move while the shutter is open: one bounces, one rolls past, one flies in a circle, one stands still, a wheel spins."""

import math

import common

FRAMES = 12
STILL, ROLLING, BOUNCING, CIRCLING = (
    ("Still", (0.2, 0.35, 0.7)),
    ("Rolling", (0.8, 0.3, 0.15)),
    ("Bouncing", (0.85, 0.65, 0.15)),
    ("Circling", (0.2, 0.6, 0.3)),
)


def tiles(light, dark, half=10):
    """A floor of squares of 1 m."""
    side = 2 * half + 1
    vertices = [(x - half, y - half, 0.0) for y in range(side) for x in range(side)]
    faces = [(r * side + c, r * side + c + 1, (r + 1) * side + c + 1, (r + 1) * side + c) for r in range(2 * half) for c in range(2 * half)]
    return common.mesh("Floor", vertices, faces, [light, dark], material_indices=[sum(divmod(f, 2 * half)) % 2 for f in range(len(faces))])


def wheel(material, spokes=6, radius=0.55, width=0.035):
    """Spokes about the y axis."""
    vertices, faces = [], []
    for number in range(spokes):
        a = 2 * math.pi * number / spokes
        along, across = (math.cos(a), math.sin(a)), (-math.sin(a) * width, math.cos(a) * width)
        first = len(vertices)
        for distance in (0.06, radius):
            for side in (-1, 1):
                vertices.append((distance * along[0] + side * across[0], 0.0, distance * along[1] + side * across[1]))
        faces.append((first, first + 2, first + 3, first + 1))
    return common.mesh("Wheel", vertices, faces, [material])


def ball(scene, name, colour):
    """A ball of radius 0.4 m of its own colour."""
    return common.add(scene, name, common.sphere(name, 0.4, common.diffuse(name, colour), segments=32, rings=16))


def animate(ob, place, turn=lambda t: 0.0):
    """Keys on every frame: `place`(t) [m] and `turn`(t) [rad] about y; t in frames from the middle one."""
    for frame in range(FRAMES + 1):
        t = frame - FRAMES // 2
        ob.location, ob.rotation_euler = place(t), (0.0, turn(t), 0.0)
        ob.keyframe_insert("location", frame=frame)
        ob.keyframe_insert("rotation_euler", frame=frame)


def build():
    """The scene, at its middle frame."""
    scene = common.new_scene("Moving balls", 512, 320, samples=256, max_depth=4)
    scene.glanz.sampler = "sobol"
    common.add(scene, "Floor", tiles(common.diffuse("Ivory", (0.6, 0.57, 0.5)), common.diffuse("Slate", (0.12, 0.13, 0.16))))
    ball(scene, *STILL).location = (-2.1, 0.4, 0.4)
    animate(ball(scene, *ROLLING), lambda t: (-0.7 + 0.3 * t, -0.7, 0.4))
    animate(ball(scene, *BOUNCING), lambda t: (0.35, 1.0, 0.4 + abs(0.5 * t + 1.2)))
    animate(ball(scene, *CIRCLING), lambda t: (1.2 + 0.8 * math.cos(0.7 * t), 0.9 + 0.8 * math.sin(0.7 * t), 0.4))
    rim = common.add(scene, "Wheel", wheel(common.diffuse("Brass", (0.7, 0.5, 0.2))))
    animate(rim, lambda t: (2.3, -0.6, 0.6), lambda t: 0.9 * t)
    common.light(scene, "Lamp", "AREA", (-3.0, -3.5, 5.5), (0.2, 0.2, 0.3), 620.0, shape="DISK", size=1.0)
    scene.world = common.world((0.55, 0.7, 1.0), 0.25)
    common.camera(scene, (0.3, -6.0, 2.6), (0.15, 0.2, 0.55), lens=42.0)
    scene.frame_start, scene.frame_end = 0, FRAMES
    scene.render.use_motion_blur = True
    scene.render.motion_blur_shutter = 0.8
    scene.frame_set(FRAMES // 2)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
