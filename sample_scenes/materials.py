"""Twelve materials from nodes: wood, brick, tiles, brushed metal, car paint, dirty glass, leaves, skin, fabric, marble, water, neon."""

import math

import common
import numpy as np
from mathutils import Matrix
from nets import Net

SIDE = 96
"""Pixels of the picture of a leaf."""


def wood():
    net = Net("Wood")
    grain = net.coordinates(scale=(1.0, 1.0, 0.25), rotation=(0.0, 0.5, 0.0))
    bent = net("TexNoise", "Color", Vector=grain, Scale=1.5, Detail=2.0)
    where = net.vector("ADD", grain, net.vector("MULTIPLY", bent, (0.4, 0.4, 0.4)))
    rings = net("TexWave", "Fac", wave_type="RINGS", rings_direction="Z", Vector=where, Scale=4.0, Distortion=1.0, Detail=2.0)
    pores = net("TexNoise", "Fac", Vector=net.coordinates(scale=(14.0, 14.0, 0.8)), Scale=3.0, Detail=4.0)
    colour = net.ramp(rings, (0.0, (0.11, 0.045, 0.018)), (0.55, (0.32, 0.15, 0.06)), (1.0, (0.45, 0.25, 0.11)))
    colour = net.mix(0.35, colour, net.ramp(pores, (0.35, (0.1, 0.05, 0.03)), (0.65, (1.0, 1.0, 1.0))), "MULTIPLY")
    relief = net.bump(pores, 0.25, 0.02)
    return net.done(net.principled(Base_Color=colour, Roughness=net.math("MULTIPLY_ADD", rings, 0.2, 0.3), Normal=relief))


def brick():
    net = Net("Brick")
    where = net.coordinates("UV", scale=(6.0, 3.0, 1.0))
    pattern = {"Vector": where, "Scale": 1.6, "Mortar_Size": 0.03, "Mortar_Smooth": 0.1, "Bias": -0.1}
    colour = net("TexBrick", "Color", Color1=(0.42, 0.1, 0.05), Color2=(0.25, 0.06, 0.035), Mortar=(0.45, 0.42, 0.38), **pattern)
    grit = net("TexNoise", "Fac", Vector=where, Scale=9.0, Detail=5.0)
    colour = net.mix(0.5, colour, net.ramp(grit, (0.3, (0.45, 0.42, 0.4)), (0.7, (1.0, 1.0, 1.0))), "MULTIPLY")
    mortar = net("TexBrick", "Fac", **pattern)
    height = net.math("SUBTRACT", net.math("MULTIPLY", grit, 0.3), mortar)
    return net.done(net.principled(Base_Color=colour, Roughness=0.85, Normal=net.bump(height, 1.0, 0.03)))


def tiles():
    net = Net("Tiles")
    where = net.coordinates("UV", scale=(12.0, 6.0, 1.0))
    joint = net("TexBrick", "Fac", offset=0.0, Vector=where, Scale=1.0, Mortar_Size=0.03, Brick_Width=1.0, Row_Height=1.0)
    number = net("TexWhiteNoise", "Value", noise_dimensions="3D", Vector=net.vector("FLOOR", where))
    colour = net.ramp(number, (0.0, (0.02, 0.12, 0.2)), (0.4, (0.03, 0.3, 0.36)), (0.8, (0.55, 0.7, 0.68)), interpolation="CONSTANT")
    colour = net.mix(joint, colour, (0.55, 0.53, 0.48))
    roughness = net.math("MULTIPLY_ADD", joint, 0.7, 0.08)
    height = net.math("SUBTRACT", 1.0, joint)
    return net.done(net.principled(Base_Color=colour, Roughness=roughness, Normal=net.bump(height, 0.6, 0.015)))


def brushed_metal():
    net = Net("Brushed Metal")
    streaks = net("TexNoise", "Fac", Vector=net.coordinates(scale=(1.0, 1.0, 45.0)), Scale=2.5, Detail=4.0)
    roughness = net("MapRange", "Result", Value=streaks, To_Min=0.18, To_Max=0.42)
    colour = net.mix(streaks, (0.62, 0.58, 0.53), (0.82, 0.78, 0.72))
    return net.done(net.principled(Base_Color=colour, Metallic=1.0, Roughness=roughness, Normal=net.bump(streaks, 0.12, 0.02)))


def car_paint():
    net = Net("Car Paint")
    facing = net("LayerWeight", "Facing", Blend=0.35)
    colour = net.mix(facing, (0.5, 0.01, 0.02), (0.04, 0.0, 0.03))
    flakes = net("TexVoronoi", "Color", Vector=net.coordinates(), Scale=160.0)
    sparkle = net.math("GREATER_THAN", net("RGBToBW", Color=flakes), 0.72)
    colour = net.mix(net.math("MULTIPLY", sparkle, 0.25), colour, (0.9, 0.5, 0.45))
    return net.done(net.principled(Base_Color=colour, Metallic=0.6, Roughness=0.35, Coat_Weight=1.0, Coat_Roughness=0.02))


def dirty_glass():
    net = Net("Dirty Glass")
    dirt = net("TexNoise", "Fac", Vector=net.coordinates(), Scale=2.2, Detail=8.0, Roughness=0.65)
    where = net("MapRange", "Result", interpolation_type="SMOOTHSTEP", Value=dirt, From_Min=0.45, From_Max=0.62, To_Max=0.9)
    glass = net("BsdfGlass", Color=(0.93, 0.98, 0.96), Roughness=0.0, IOR=1.5)
    dust = net("BsdfDiffuse", Color=(0.36, 0.27, 0.16))
    return net.done(net.shaders(where, glass, dust))


def leaf_picture():
    """A leaf on nothing: linear (SIDE, SIDE, 4), row 0 at the bottom."""
    y, x = np.mgrid[0:SIDE, 0:SIDE] / (SIDE - 1) * 2 - 1
    half = 0.55 * np.sqrt(np.clip(1 - ((y - 0.05) / 0.85) ** 2, 0, 1)) * (1 - 0.35 * y)
    inside = np.abs(x) < half
    veins = np.abs(np.sin(9 * (y - 0.7 * np.abs(x)))) ** 12 + (np.abs(x) < 0.03)
    green = np.array((0.09, 0.3, 0.03)) * (0.75 + 0.25 * np.cos(5 * x))[..., None]
    colour = green + np.clip(veins, 0, 1)[..., None] * np.array((0.16, 0.2, 0.06))
    return np.dstack((colour, inside.astype(float)))


def leaves():
    net = Net("Leaves")
    picture = net("TexImage", "Color", Vector=net("TexCoord", "UV")).node
    picture.image = common.picture("Leaf", SIDE, SIDE, leaf_picture().ravel(), has_alpha=True)
    front = net.principled(Base_Color=picture.outputs["Color"], Roughness=0.45)
    through = net("BsdfTranslucent", Color=net("Gamma", Color=picture.outputs["Color"], Gamma=0.8))
    leaf = net.shaders(0.35, front, through)
    return net.done(net.shaders(picture.outputs["Alpha"], net("BsdfTransparent"), leaf))


def skin():
    net = Net("Skin")
    where = net.coordinates()
    blotches = net("TexNoise", "Fac", Vector=where, Scale=3.0, Detail=6.0)
    colour = net.ramp(blotches, (0.3, (0.5, 0.22, 0.15)), (0.5, (0.63, 0.34, 0.24)), (0.75, (0.7, 0.42, 0.32)))
    pores = net("TexVoronoi", "Distance", Vector=where, Scale=55.0)
    values = {"Base_Color": colour, "Roughness": 0.45, "Subsurface_Weight": 0.15, "Subsurface_Scale": 0.01}
    return net.done(net.principled(Normal=net.bump(pores, 0.25, 0.01), **values))


def fabric():
    net = Net("Fabric")
    where = net.coordinates("UV", scale=(1.0, 0.5, 1.0))
    threads = {"wave_type": "BANDS", "wave_profile": "SIN", "Vector": where, "Scale": 30.0}
    warp = net("TexWave", "Fac", bands_direction="X", **threads)
    weft = net("TexWave", "Fac", bands_direction="Y", **threads)
    over = net("TexChecker", "Fac", Vector=where, Scale=95.0)
    weave = net("Mix", "Result_Float", data_type="FLOAT", Factor_Float=over, A_Float=warp, B_Float=weft)
    stripes = net.math("PINGPONG", net("SeparateXYZ", "X", Vector=where), 0.0625)
    colour = net.ramp(stripes, (0.0, (0.05, 0.08, 0.25)), (0.03, (0.5, 0.42, 0.3)), (0.045, (0.12, 0.02, 0.03)), interpolation="CONSTANT")
    colour = net("HueSaturation", Color=colour, Value=net.math("MULTIPLY_ADD", weave, 0.6, 0.7))
    return net.done(net.principled(Base_Color=colour, Roughness=0.9, Sheen_Weight=0.4, Normal=net.bump(weave, 0.5, 0.01)))


def marble():
    net = Net("Marble")
    where = net.coordinates()
    noise = net("TexNoise", "Color", Vector=where, Scale=1.8, Detail=9.0, Roughness=0.62)
    bent = net.vector("ADD", where, net.vector("SUBTRACT", noise, (0.5, 0.5, 0.5)))
    cells = net("TexVoronoi", "Distance", feature="DISTANCE_TO_EDGE", Vector=bent, Scale=2.0)
    cloud = net("TexNoise", "Fac", Vector=bent, Scale=2.5, Detail=6.0)
    stone = net.ramp(cloud, (0.3, (0.62, 0.6, 0.58)), (0.6, (0.85, 0.84, 0.82)))
    vein = net.ramp(cells, (0.0, (0.08, 0.09, 0.1)), (0.06, (0.6, 0.6, 0.6)), (0.2, (1.0, 1.0, 1.0)))
    return net.done(net.principled(Base_Color=net.mix(0.85, stone, vein, "MULTIPLY"), Roughness=0.12))


def water():
    net = Net("Water")
    waves = net("TexNoise", "Fac", Vector=net.coordinates(), Scale=3.5, Detail=3.0)
    relief = net.bump(waves, 0.35, 0.1)
    return net.done(net.principled(Base_Color=(0.8, 0.95, 1.0), Roughness=0.0, IOR=1.33, Transmission_Weight=1.0, Normal=relief))


def neon():
    net = Net("Neon")
    along = net("SeparateXYZ", "X", Vector=net.coordinates("UV", scale=(1.0, 1.0, 1.0)))
    colour = net.ramp(along, (0.0, (1.0, 0.1, 0.35)), (0.5, (0.2, 0.4, 1.0)), (1.0, (1.0, 0.1, 0.35)))
    rim = net("Fresnel", IOR=1.45)
    strength = net.math("MULTIPLY_ADD", net.math("SUBTRACT", 1.0, rim), 1.6, 0.3)
    return net.done(net("Emission", Color=colour, Strength=strength))


def ball(name, material):
    """A smooth ball with longitude and latitude as UVs."""
    return common.wrapped(common.sphere(name, 0.5, material, segments=40, rings=20), start=0.5)


def spray(name, material):
    """Leaves on cards around a stem."""
    vertices, faces, uvs = [], [], []
    for i in range(11):
        turn = Matrix.Rotation(2.4 * i, 4, "Z") @ Matrix.Translation((0.0, 0.0, -0.35 + 0.07 * i))
        turn = turn @ Matrix.Rotation(-0.7 - 0.05 * i, 4, "X")
        corners = [(-0.2, 0.0, 0.0), (0.2, 0.0, 0.0), (0.2, 0.0, 0.42), (-0.2, 0.0, 0.42)]
        faces.append(tuple(range(len(vertices), len(vertices) + 4)))
        vertices += [tuple(turn @ common.Vector(c)) for c in corners]
        uvs += [0, 0, 1, 0, 1, 1, 0, 1]
    made = common.mesh(name, vertices, faces, [material])
    made.uv_layers.new(name="UVMap").uv.foreach_set("vector", uvs)
    return made


def tube(name, material, around=64, across=12):
    """A bent glass tube: a ring of radius 0.38 m, 0.06 m thick."""
    places = [(2 * math.pi * i / around, 2 * math.pi * j / across) for i in range(around) for j in range(across)]
    rings = [(0.38 + 0.06 * math.cos(b), a, b) for a, b in places]
    vertices = [(r * math.cos(a), 0.06 * math.sin(b), r * math.sin(a)) for r, a, b in rings]
    cells = [(i, j) for i in range(around) for j in range(across)]
    faces = [tuple((i + di) % around * across + (j + dj) % across for di, dj in ((0, 0), (0, 1), (1, 1), (1, 0))) for i, j in cells]
    made = common.mesh(name, vertices, faces, [material], smooth=True)
    uvs = [n for i, j in cells for di, dj in ((0, 0), (0, 1), (1, 1), (1, 0)) for n in ((i + di) / around, (j + dj) / across)]
    made.uv_layers.new(name="UVMap").uv.foreach_set("vector", uvs)
    return made


MATERIALS = (wood, brick, tiles, brushed_metal, car_paint, dirty_glass, leaves, skin, fabric, marble, water, neon)
SHAPES = {leaves: spray, neon: tube}


def build():
    """The scene: four balls in each of three rows before a wall."""
    scene = common.new_scene("Materials", 560, 420, samples=128, max_depth=8)
    scene.glanz.sampler = "sobol"
    for number, make in enumerate(MATERIALS):
        material = make()
        row, column = divmod(number, 4)
        shape = SHAPES.get(make, ball)(material.name, material)
        place = Matrix.Translation((1.2 * (column - 1.5), 0.0, 1.2 * (2 - row) + 0.55)) @ Matrix.Rotation(-0.35, 4, "Z")
        common.add(scene, material.name, shape, place)
    wall, floor = common.diffuse("Wall", (0.33, 0.34, 0.36)), common.diffuse("Floor", (0.25, 0.24, 0.23))
    common.add(scene, "Wall", common.quad("Wall", (-8, 1.0, -1), (16, 0, 0), (0, 0, 9), wall))
    common.add(scene, "Floor", common.quad("Floor", (-8, -8, -0.05), (16, 0, 0), (0, 9, 0), floor))
    common.light(scene, "Key", "AREA", (-3.2, -4.2, 5.2), (0, 0, 1.6), 400.0, shape="SQUARE", size=3.0)
    common.light(scene, "Rim", "AREA", (3.6, -1.2, 4.4), (0, 0, 1.6), 120.0, shape="SQUARE", size=2.0)
    scene.world = common.world((0.75, 0.85, 1.0), 0.35)
    common.camera(scene, (0.0, -9.5, 2.0), (0.0, 0.0, 1.72), lens=66.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
