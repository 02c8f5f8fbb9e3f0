"""A cabinet with a light of another kind in each of its eight boxes, over the same three objects."""

import math

import common
from mathutils import Matrix

WIDTH, HEIGHT, DEPTH, BOARD = 1.5, 1.3, 1.3, 0.1
"""Of a box, and the thickness of the boards [m]."""
COLUMNS, ROWS = 4, 2
NAMES = (("sun", "point", "spot", "mesh"), ("square", "rectangle", "disk", "ellipse"))


def corner(column, row):
    """The middle of a box's floor, at the front edge [m]; row 0 is the upper one."""
    x = (column - 0.5 * (COLUMNS - 1)) * (WIDTH + BOARD)
    return x, 0.0, BOARD + (ROWS - 1 - row) * (HEIGHT + BOARD)


def board(scene, name, low, high, material):
    """A box between two corners."""
    size = [b - a for a, b in zip(low, high, strict=True)]
    foot = (0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]), low[2])
    common.add(scene, name, common.box(name, size, material), Matrix.Translation(foot))


def cabinet(scene, wood):
    """Boards around all boxes, side by side and never through each other; the box of the sun has no lid."""
    half = 0.5 * (COLUMNS * (WIDTH + BOARD) + BOARD)
    top = ROWS * (HEIGHT + BOARD) + BOARD
    for column in range(COLUMNS):
        x, _, _ = corner(column, 0)
        for row in range(ROWS + 1):
            if row == 0 and NAMES[row][column] == "sun":
                continue
            z = top - BOARD - row * (HEIGHT + BOARD)
            board(scene, f"Shelf {column} {row}", (x - 0.5 * WIDTH, 0.0, z), (x + 0.5 * WIDTH, DEPTH, z + BOARD), wood)
    for column in range(COLUMNS + 1):
        x = -half + column * (WIDTH + BOARD)
        board(scene, f"Side {column}", (x, 0.0, 0.0), (x + BOARD, DEPTH, top), wood)
    board(scene, "Back", (-half, DEPTH, 0.0), (half, DEPTH + BOARD, top), wood)


def cone(name, radius, height, material, segments=48):
    """A smooth cone that stands on the origin, with a flat bottom."""
    ring = [(radius * math.cos(2 * math.pi * s / segments), radius * math.sin(2 * math.pi * s / segments), 0.0) for s in range(segments)]
    faces = [(s, (s + 1) % segments, segments) for s in range(segments)] + [tuple(reversed(range(segments)))]
    return common.mesh(name, [*ring, (0.0, 0.0, height)], faces, [material], smooth=False)


def torus(name, radius, tube, material, segments=48, sides=12):
    """A smooth ring about the z axis."""
    vertices, faces = [], []
    for s in range(segments):
        phi = 2 * math.pi * s / segments
        for t in range(sides):
            theta = 2 * math.pi * t / sides
            r = radius + tube * math.cos(theta)
            vertices.append((r * math.cos(phi), r * math.sin(phi), tube * math.sin(theta)))
            a, b = s * sides, (s + 1) % segments * sides
            faces.append((a + t, b + t, b + (t + 1) % sides, a + (t + 1) % sides))
    return common.mesh(name, vertices, faces, [material], smooth=True)


def label(scene, text, column, row, material):
    """The light's kind, written on the edge of the board below it."""
    x, _, z = corner(column, row)
    data = common.bpy.data.curves.new(f"Label {text}", "FONT")
    data.body = text
    data.align_x, data.align_y = "CENTER", "CENTER"
    data.size = 0.12
    data.resolution_u = 3
    data.materials.append(material)
    upright = Matrix.Translation((x, -0.004, z - 0.5 * BOARD)) @ Matrix.Rotation(0.5 * math.pi, 4, "X")
    common.add(scene, data.name, data, upright)


def furnish(scene, column, row, meshes):
    """The three objects of each box; their meshes are shared."""
    x, _, z = corner(column, row)
    name = NAMES[row][column]
    for mesh, dx, y in zip(meshes, (-0.36, 0.04, 0.4), (0.72, 0.36, 0.66), strict=True):
        lift = 0.17 if mesh.name == "Ball" else 0.0
        turn = Matrix.Rotation(math.radians(31), 4, "Z")
        common.add(scene, f"{mesh.name} {name}", mesh, Matrix.Translation((x + dx, y, z + lift)) @ turn)


def shine(scene):
    """One light of each kind, named after its box."""

    def place(column, row, dx=0.0, y=0.55, height=1.18):
        x, _, z = corner(column, row)
        return (x + dx, y, z + height), (x + 0.05, 0.6, z)

    def down(column, row, **at):
        position, _ = place(column, row, **at)
        return position, (position[0], position[1] + 1e-4, position[2] - 1.0)

    # From above and a little from behind: into the box without a lid, and into no other.
    common.light(scene, "sun", "SUN", (-3.7, 3.4, 8.0), (-2.5, 1.2, 0.0), 2.7, angle=math.radians(3), color=(1.0, 0.93, 0.8))
    common.light(scene, "point", "POINT", *place(1, 0, dx=-0.25), 13.0, shadow_soft_size=0.05, color=(1.0, 0.86, 0.66))
    common.light(
        scene,
        "spot",
        "SPOT",
        *place(2, 0, dx=-0.45, y=0.12),
        100.0,
        shadow_soft_size=0.02,
        spot_size=math.radians(50),
        spot_blend=0.2,
        color=(0.8, 0.9, 1.0),
    )
    shapes = (
        ("square", "SQUARE", 0.5, 0.5),
        ("rectangle", "RECTANGLE", 1.1, 0.08),
        ("disk", "DISK", 0.5, 0.5),
        ("ellipse", "ELLIPSE", 0.16, 0.7),
    )
    colours = ((1.0, 0.9, 0.76), (0.82, 0.93, 1.0), (1.0, 0.82, 0.7), (0.86, 1.0, 0.86))
    for column, ((name, shape, size, size_y), colour) in enumerate(zip(shapes, colours, strict=True)):
        common.light(scene, name, "AREA", *down(column, 1), 10.0, shape=shape, size=size, size_y=size_y, color=colour)
    x, _, z = corner(3, 0)
    glow = common.emission("Glow", (1.0, 0.55, 0.32), 14.0)
    tilt = Matrix.Rotation(math.radians(64), 4, "X") @ Matrix.Rotation(math.radians(12), 4, "Y")
    common.add(scene, "mesh", torus("Ring", 0.2, 0.028, glow), Matrix.Translation((x - 0.08, 0.72, z + 0.86)) @ tilt)


def build():
    """The scene."""
    scene = common.new_scene("Lights", 1024, 480, samples=128, max_depth=6)
    wood = common.diffuse("Wood", (0.72, 0.70, 0.66))
    ink = common.diffuse("Ink", (0.02, 0.02, 0.025))
    meshes = (
        cone("Cone", 0.16, 0.62, common.diffuse("Blue", (0.09, 0.22, 0.52))),
        common.sphere("Ball", 0.17, common.diffuse("Orange", (0.75, 0.27, 0.06)), segments=48, rings=24),
        common.box("Block", (0.2, 0.2, 0.36), common.diffuse("Teal", (0.08, 0.42, 0.36))),
    )
    cabinet(scene, wood)
    for row in range(ROWS):
        for column in range(COLUMNS):
            furnish(scene, column, row, meshes)
            label(scene, NAMES[row][column], column, row, ink)
    shine(scene)
    # Just enough to read the labels by.
    scene.world = common.world((0.8, 0.88, 1.0), 0.2)
    middle = 0.5 * (ROWS * (HEIGHT + BOARD) + BOARD)
    # Level and shifted, as architects' cameras are: the floors can be seen, and verticals stay vertical.
    distance, rise, lens = 10.0, 2.7, 52.0
    made = common.camera(scene, (0.0, -distance, middle + rise), (0.0, 0.0, middle + rise), lens)
    made.data.shift_y = -rise / distance * lens / made.data.sensor_width
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
