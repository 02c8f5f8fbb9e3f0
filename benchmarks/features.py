"""What each feature costs: the Cornell box with it against the same without, processor time, in turns, medians of five.

A feature changes what paths do (mirrors send them farther, glass through more surfaces), so this is its price in a
scene that uses it, not the time of its code. Scenes that do not use it run none of it (tests/renders/test_costs.py).
Two have other counterparts: "pictures", a Principled material with three of them, the same with constants; and "default",
Blender's default material all over the box, its lobes with constants for the shares that depend on where they are seen from.
"""

import dataclasses
import time
from statistics import median

import bpy
import numpy as np

from glanz.addon.capture import capture
from glanz.engine import (
    Bitmap,
    CheckerTexture,
    Coordinates,
    Dielectric,
    EnvironmentMap,
    ImageTexture,
    Lambert,
    LambertTransmission,
    Lens,
    Material,
    Medium,
    Mirror,
    NoiseTexture,
    Phong,
    PointLight,
    Transparent,
    World,
    render_image,
)
from glanz.engine.scene.textured import averaged, may_emit

from . import blender

SIDE, SAMPLES, ROUNDS = 256, 8, 5
WORN = ("Large sphere", "Small sphere", "Tall box")
"""The objects that wear what is to be measured."""
GENERATED = Coordinates(source="generated", matrix=np.diag((4.0, 4.0, 4.0, 1.0)))


def main():
    blender.open_cornell_box(SAMPLES, SIDE, SIDE)
    with blender.quiet():
        scene, settings, _ = capture()
        principled = {name: (capture()[0], settings) for name in ("principled", "pictures") if wear(name == "pictures")}
    default = {name: (dressed, settings) for name, dressed in all_over(principled["principled"][0]).items()}
    variants = {"plain": (scene, settings), **features(scene, settings), **principled, **default}
    seconds = {name: [] for name in variants}
    for _ in range(ROUNDS):
        for name, (changed, how) in variants.items():
            start = time.process_time()
            render_image(changed, how)
            seconds[name].append(time.process_time() - start)
    against = {"pictures": seconds["principled"], "default": seconds.pop("constant")}
    plain = seconds.pop("plain")
    blender.finish({name: median(a / b for a, b in zip(times, against.get(name, plain))) for name, times in seconds.items()})


def wear(has_pictures):
    """Dress the objects in a Principled material: with constants, or with pictures as its base colour, roughness and normal."""
    material = bpy.data.materials.new("Principled")
    tree = material.node_tree
    if tree is None:
        material.use_nodes = True
        tree = material.node_tree
    shader = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    if has_pictures:
        bend = tree.nodes.new("ShaderNodeNormalMap")
        tree.links.new(bend.outputs["Normal"], shader.inputs["Normal"])
        for socket in (shader.inputs["Base Color"], shader.inputs["Roughness"], bend.inputs["Color"]):
            picture = tree.nodes.new("ShaderNodeTexImage")
            picture.image = bpy.data.images.new("Picture", 1024, 1024)
            picture.image.pixels.foreach_set(np.random.default_rng(1).random(4 * 1024 * 1024, np.float32))
            tree.links.new(picture.outputs["Color"], socket)
    for name in WORN:
        mesh = bpy.data.objects[name].data
        mesh.uv_layers.active or mesh.uv_layers.new(name="UVMap")
        mesh.materials.clear()
        mesh.materials.append(material)
    return True


def all_over(scene):
    """{name: `scene` with the material of the worn objects on all that does not shine}: "default", and its lobes "constant"."""
    (material,) = next(o.materials for o in scene.objects if o.name == WORN[0])
    constant = dataclasses.replace(material, lobes=tuple(averaged(lobe) for lobe in material.lobes))

    def dressed(o, m):
        return o if any(may_emit(own) for own in o.materials) else dataclasses.replace(o, materials=(m,) * len(o.materials))

    return {
        name: dataclasses.replace(scene, objects=tuple(dressed(o, m) for o in scene.objects))
        for name, m in (("default", material), ("constant", constant))
    }


def features(scene, settings):
    """{name: (scene, settings) with a feature more}; the spheres and the tall box wear what is to be measured."""
    replace = dataclasses.replace

    def worn(*lobes, **others):
        material = Material(name="measured", lobes=lobes, **others)
        return replace(scene, objects=tuple(replace(o, materials=(material,)) if o.name in WORN else o for o in scene.objects))

    rng = np.random.default_rng(1)
    bitmap = Bitmap(name="bitmap", pixels=rng.random((3, 256, 256), np.float32))
    sky = EnvironmentMap(pixels=rng.random((3, 64, 128), np.float32))
    lamps = tuple(
        PointLight(name=f"lamp {i}", position=tuple(rng.uniform((-0.9, -0.9, 1.2), (0.9, 0.9, 1.9))), intensity=(0.01,) * 3, radius=0.01)
        for i in range(1000)
    )
    pushed = np.stack([scene.camera.world_from_camera] * 2)
    pushed[1, 0, 3] += 0.05
    with_scene = {
        "phong": worn(Lambert((0.3,) * 3), Phong((0.4,) * 3, 30.0)),
        "mirror": worn(Mirror((0.9,) * 3)),
        "glass": worn(Dielectric(1.5)),
        "absorption": worn(Dielectric(1.5), medium=Medium(absorption=(1.0, 2.0, 3.0))),
        "dispersion": worn(Dielectric(1.5, abbe=30.0)),
        "transparency": worn(Lambert((0.4,) * 3), Transparent((0.5,) * 3)),
        "translucency": worn(Lambert((0.4,) * 3), LambertTransmission((0.4,) * 3)),
        "image": worn(Lambert(ImageTexture(bitmap, GENERATED))),
        "checker": worn(Lambert(CheckerTexture((0.8,) * 3, (0.2,) * 3, GENERATED))),
        "noise": worn(Lambert(NoiseTexture(GENERATED))),
        "environment": replace(scene, world=World(environment=sky)),
        "lamps": replace(scene, lights=lamps),
        "lens": replace(scene, camera=replace(scene.camera, lens=Lens(radius=0.05, focus_distance=3.7))),
        "camera_motion": replace(scene, camera=replace(scene.camera, motion=pushed)),
    }
    with_settings = {
        "whitted": {"integrator": "whitted"},
        "distributed": {"integrator": "distributed", "branches": 8},
        "path_blind": {"integrator": "path_blind"},
        "exact": {"precision": "exact"},
        "adaptive": {"adaptive_threshold": 0.1, "adaptive_levels": 2},
        **{f"sampler_{key}": {"sampler": key} for key in ("sobol", "blue_noise", "multijitter", "random")},
    }
    return {name: (changed, settings) for name, changed in with_scene.items()} | {
        name: (scene, replace(settings, **changes)) for name, changes in with_settings.items()
    }


if __name__ == "__main__":
    main()
