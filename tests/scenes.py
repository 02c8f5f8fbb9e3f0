"""Scenes that use every feature at once, to be moved, scaled, cut and shuffled."""

import math

import numpy as np

from glanz.engine import (
    AreaLight,
    EnvironmentMap,
    Lambert,
    Material,
    PerspectiveCamera,
    Phong,
    PointLight,
    SpotLight,
    SunLight,
    Transparent,
    World,
)
from glanz.tests import helpers as h

SHINY = Material(name="shiny", lobes=(Lambert((0.2, 0.3, 0.1)), Phong((0.5, 0.4, 0.6), 20.0)))
SHARP = Material(name="sharp", lobes=(Phong((0.7, 0.7, 0.7), 1e4),))
VEIL = Material(name="veil", lobes=(Transparent((0.6, 0.5, 0.3)), Lambert((0.2, 0.3, 0.3))))
GLOWING = Material(name="glowing", lobes=(Lambert((0.3, 0.3, 0.3)),), emission=(2.0, 1.0, 0.5))
SKY = (np.random.default_rng(1).random((3, 8, 16)) ** 8).astype(np.float32)


def everything(scale=1.0, offset=(0.0, 0.0, 0.0), power=1.0, world=0.1):
    """A floor, a smooth and a flat sphere, a box, something that glows, a veil, one light of each kind, light and a picture around it all.

    All coordinates are multiples of 2^-10, so `offset` by such and `scale` by a power of two are exact; powers that
    belong to lengths (intensities) grow with scale^2, so that the picture stays.
    """
    offset = np.array(offset, float)

    def at(*p):
        return scale * (np.array(p, float) + offset)

    def lattice(mesh):
        vertices = scale * (np.round(mesh.vertices.astype(np.float64) * 1024) / 1024 + offset[:, None])
        return h.Mesh(name=mesh.name, vertices=vertices, triangles=mesh.triangles, normals=mesh.normals, normal_indices=mesh.normal_indices)

    down = h.frame_towards((0.25, 0.5, 1.0))
    objects = [
        h.thing(lattice(h.quad((0, 0, 0), (8, 0, 0), (0, 8, 0), name="floor")), h.lambert((0.7, 0.6, 0.5), "floor")),
        h.thing(lattice(h.icosphere(2, 0.75, (-1.0, 0.25, 0.75), smooth=True, name="smooth")), SHINY),
        h.thing(lattice(h.icosphere(1, 0.5, (1.0, 0.5, 0.5), name="flat")), SHARP),
        h.thing(lattice(h.box((0.25, -1.25, 0), (0.75, -0.75, 0.5))), h.lambert((0.2, 0.5, 0.8), "blue")),
        h.thing(lattice(h.box((-0.75, -1.5, 0.25), (-0.5, -1.25, 0.375), name="glow")), replaced_emission(power)),
        h.thing(lattice(h.quad((0.75, -2.0, 0.75), (1.5, 0.25, 0.5), (0.25, 0.5, 1.25), name="veil")), VEIL),
    ]
    intensity = 20 * power * scale**2
    lights = [
        PointLight(name="point", position=tuple(at(2, 1, 3)), intensity=(intensity,) * 3, radius=0.25 * scale),
        SpotLight(name="spot", world_from_light=h.affine(down, at(0.5, 1.5, 3)), intensity=(intensity,) * 3, angle=1.0),
        SunLight(name="sun", towards=tuple((np.array((0.6, 0.0, 0.8))).tolist()), irradiance=(power,) * 3, angle=0.1),
        AreaLight(name="area", world_from_light=h.affine(scale * down, at(-1, 1.5, 3)), size_x=1.5, size_y=0.5, radiance=(3 * power,) * 3),
    ]
    camera = PerspectiveCamera.look_at(at(3, -4, 2.5), at(0, 0, 0.5), fov=math.radians(35))
    sky = EnvironmentMap(pixels=SKY, world_from_map=h.rotation(1), strength=(0.5 * power,) * 3)
    return h.replaced(h.scene(objects, lights, camera), world=World(radiance=(world * power,) * 3, environment=sky))


def replaced_emission(power):
    """GLOWING, `power` times as bright."""
    return h.replaced(GLOWING, emission=tuple(power * c for c in GLOWING.emission))
