"""Seven spheres of the same colour, from dull to polished: Phong exponents from 1 to 1000."""

import math

import common
from mathutils import Matrix

EXPONENTS = (1, 3, 10, 30, 100, 300, 1000)
RADIUS, SPACING = 0.5, 1.14
COPPER = (0.93, 0.56, 0.4)


def roughness(exponent):
    """Blender's roughness whose lobe has the exponent n: n + 1 = ln 2 / ln((1 + 3 a) / (1 + a)) with a = roughness^4."""
    q = 2 ** (1 / (exponent + 1))
    return ((q - 1) / (3 - q)) ** 0.25


def backdrop(material, half_width=14.0, front=-8.0, back=3.2, bend=1.6, top=9.0, steps=24):
    """A floor that bends up into a wall, as in a photographer's studio."""
    profile = [(front, 0.0)]
    for step in range(steps + 1):
        angle = 0.5 * math.pi * step / steps
        profile.append((back - bend + bend * math.sin(angle), bend - bend * math.cos(angle)))
    profile.append((back, top))
    vertices = [(x, y, z) for y, z in profile for x in (-half_width, half_width)]
    faces = [(2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2) for i in range(len(profile) - 1)]
    return common.mesh("Backdrop", vertices, faces, [material], smooth=True)


def label(scene, text, x, material):
    """Digits that lean back before a sphere, towards the camera."""
    data = common.bpy.data.curves.new(f"Label {text}", "FONT")
    data.body = text
    data.align_x = "CENTER"
    data.size = 0.3
    data.extrude = 0.004
    data.resolution_u = 4
    data.materials.append(material)
    leaning = Matrix.Translation((x, -1.05, 0.01)) @ Matrix.Rotation(math.radians(35), 4, "X")
    common.add(scene, data.name, data, leaning)


def build():
    """The scene."""
    scene = common.new_scene("Phong exponents", 1024, 320, samples=128, max_depth=6)
    paper = common.diffuse("Paper", (0.15, 0.17, 0.22))
    ink = common.diffuse("Ink", (0.8, 0.8, 0.78))
    common.add(scene, "Backdrop", backdrop(paper))

    # One mesh for all; each object brings the material of its own.
    ball = common.sphere("Ball", RADIUS, None, segments=80, rings=40)
    for place, exponent in enumerate(EXPONENTS):
        x = (place - 0.5 * (len(EXPONENTS) - 1)) * SPACING
        made = common.add(scene, f"Ball n={exponent}", ball, Matrix.Translation((x, 0.0, RADIUS)))
        made.material_slots[0].link = "OBJECT"
        made.material_slots[0].material = common.glossy(f"Copper n={exponent}", COPPER, roughness(exponent))
        label(scene, str(exponent), x, ink)

    common.light(
        scene, "Key", "AREA", (-4.6, -4.2, 5.4), (-0.6, 0.0, 0.3), 900.0, shape="RECTANGLE", size=2.6, size_y=1.7, color=(1.0, 0.94, 0.86)
    )
    common.light(
        scene, "Rim", "AREA", (5.8, 1.4, 3.6), (0.4, 0.0, 0.4), 420.0, shape="RECTANGLE", size=0.7, size_y=3.2, color=(0.68, 0.82, 1.0)
    )
    common.light(scene, "Fill", "AREA", (3.4, -6.4, 2.6), (0.0, 0.0, 0.4), 170.0, shape="DISK", size=1.2)
    scene.world = common.world((0.55, 0.7, 1.0), 0.14)
    common.camera(scene, (0.0, -11.5, 3.3), (0.0, 0.0, 0.34), lens=50.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
