"""The one place where scenes are checked: what cannot be rendered is named, left out or refused."""

import dataclasses
import math
from functools import cache

import numpy as np

from ..constants import EPS32
from ..errors import SceneError, SceneWarning
from ..interfaces import albedo_of
from ..registry import BSDFS, CAMERAS, FILTERS, INTEGRATORS, LIGHTS, PASSES, SAMPLERS
from .coordinates import Coordinates
from .environment import EnvironmentMap
from .graphs import inputs_of, is_texture, with_inner
from .medium import Medium
from .shade import Shade
from .textured import coordinates_of, material_textures, plain, textures_of
from .visibility import hidden_from


def validate(scene, settings):
    """(scene, warnings): the scene without what cannot be rendered, and a `SceneWarning` for each thing that is not as it says.

    Raises SceneError where no picture is possible: no camera, a camera that is not finite, unknown plug-ins.
    """
    for registry, key in (
        (INTEGRATORS, settings.integrator),
        (SAMPLERS, settings.sampler),
        (FILTERS, settings.pixel_filter),
        *((PASSES, key) for key in settings.passes),
    ):
        if key not in registry:
            raise SceneError(f"unknown {registry.kind} '{key}'; known: {registry.known}")
    if scene.camera is None:
        raise SceneError(f"scene '{scene.name}' has no camera")
    if type(scene.camera) not in CAMERAS.values():
        raise SceneError(f"scene '{scene.name}': {type(scene.camera).__name__} is not a camera")
    check_camera(scene.camera)
    warnings = []
    is_torn = cache(_is_torn)
    objects = tuple(checked for o in scene.objects if (checked := _check_object(o, is_torn, warnings)))
    kept_lights = tuple(light for light in scene.lights if _check_light(light, warnings))
    if not INTEGRATORS[settings.integrator].samples_lights:
        what = f"it has no size, and '{settings.integrator}' sends no rays to lights, so it stays dark"
        warnings += [SceneWarning(what, "light", light.name) for light in kept_lights if not light.has_extent()]
    world = _check_world(scene.world, warnings)
    return dataclasses.replace(scene, objects=objects, lights=kept_lights, world=world), tuple(warnings)


def check_camera(camera):
    """Raises SceneError for a camera that sees nothing: it is not finite, or out of range."""
    if not np.isfinite(camera.world_from_camera).all() or _flattens(camera.world_from_camera):
        raise SceneError(f"camera '{camera.name}': its transform is not finite or flattens space")
    if not np.isfinite(camera.motion).all() or _flattens(camera.motion):
        raise SceneError(f"camera '{camera.name}': its motion is not finite or flattens space")
    # Parallel rays may start behind the camera as well.
    least = getattr(camera, "least_clip_start", 0.0)
    if not (least <= camera.clip_start < camera.clip_end and math.isfinite(camera.clip_start)):
        raise SceneError(
            f"camera '{camera.name}': clip range is {camera.clip_start} to {camera.clip_end}, allowed: {least:g} <= start < end"
        )
    camera.lens.check(camera.name)
    camera.check()


def _flattens(matrices):
    """Whether any of matrices (..., 4, 4) leaves no volume."""
    # Of huge ones the volume is inf.
    with np.errstate(over="ignore", invalid="ignore"):
        return not np.linalg.det(matrices[..., :3, :3]).all()


def torn(o):
    """The warning of an `Object` that loses triangles."""
    return SceneWarning("triangles with a corner that is not finite or too far away are left out", "object", o.name, is_lost=True)


def _is_torn(mesh):
    finite = np.isfinite(mesh.vertices).all(axis=0)
    # Vertices may belong to no triangle.
    return not finite.all() and not finite[mesh.triangles].all()


def _check_object(o, is_torn, warnings):
    if not (np.isfinite(o.world_from_object).all() and np.isfinite(o.motion).all()):
        warnings.append(SceneWarning("the transform is not finite, so it is left out", "object", o.name, is_lost=True))
        return None
    if not np.isfinite(o.mesh.shapes).all():
        what = f"a vertex of mesh '{o.mesh.name}' is not finite while the shutter is open, so it keeps its shape"
        warnings.append(SceneWarning(what, "object", o.name))
        o = dataclasses.replace(o, mesh=o.mesh.at(0.0))
    if is_torn(o.mesh):
        warnings.append(torn(o))
    for material in o.materials:
        _check_material(material)
    return o


def _check_material(material):
    for lobe in material.lobes:
        if type(lobe) not in BSDFS.values():
            raise SceneError(f"material '{material.name}': {type(lobe).__name__} is not a BSDF")
        for name in textures_of(lobe).keys() - plain(lobe).row().keys():
            raise SceneError(f"material '{material.name}': {lobe.key} {name} is a texture, allowed: a constant")
    if not is_texture(material.alpha) and not 0 <= material.alpha <= 1:
        raise SceneError(f"material '{material.name}': alpha is {material.alpha}, allowed: 0 to 1")
    if not math.isfinite(material.index):
        raise SceneError(f"material '{material.name}': index is {material.index}, allowed: finite numbers")
    for aov in material.aovs:
        if len(aov) != 2 or not isinstance(aov[0], str) or not (is_texture(aov[1]) or _is_plain(aov[1])):
            raise SceneError(f"material '{material.name}': its AOV {aov!r} is not a name, and one or three numbers or a texture")
    for relief in material.relief:
        if not is_texture(relief):
            raise SceneError(f"material '{material.name}': its relief {relief!r} is not a texture")
    if is_texture(material.ambient):
        raise SceneError(f"material '{material.name}': ambient is a texture, allowed: three finite numbers from 0 on")
    for texture in material_textures(material):
        _check_texture(texture, f"material '{material.name}'")
    if not is_texture(held := material.holdout) and not (_is_colour(held) and max(held) <= 1):
        raise SceneError(f"material '{material.name}': holdout is {held}, allowed: three numbers from 0 to 1")
    for name in ("emission", "ambient"):
        if not (is_texture(value := getattr(material, name)) or _is_colour(value)):
            raise SceneError(f"material '{material.name}': {name} is {value}, allowed: three finite numbers from 0 on")
    if material.medium is not None:
        if type(material.medium) is not Medium:
            raise SceneError(f"material '{material.name}': {type(material.medium).__name__} is not a medium")
        material.medium.check(material.name)
    total = np.zeros(3)
    for lobe in material.lobes:
        # What textures give is cut off to what is allowed, point by point. First what an albedo is computed from, then itself.
        is_textured, lobe = bool(textures_of(lobe)), plain(lobe)
        lobe.check(material.name)
        if not _is_colour(albedo := albedo_of(lobe)):
            raise SceneError(f"material '{material.name}': {lobe.key} reflectance is {albedo}, allowed: three finite numbers from 0 on")
        total += 0 if is_textured else albedo
    if (total > 1 + 1e-6).any():
        raise SceneError(
            f"material '{material.name}' reflects {tuple(total.round(6).tolist())}, more than it receives: "
            "scale its reflectances to a sum of at most 1"
        )


def _check_texture(texture, owner):
    for part in with_inner(texture):
        part.check(owner)
        for value in inputs_of(part):
            if not (is_texture(value) or isinstance(value, Coordinates)) and np.shape(value) not in ((), (3,)):
                raise SceneError(f"{owner}: an input of its {part.label} is {value!r}, allowed: one or three numbers")
    for coordinates in coordinates_of(texture):
        coordinates.check(owner)


def _check_light(light, warnings):
    if type(light) not in LIGHTS.values():
        raise SceneError(f"{type(light).__name__} is not a light")
    numbers = [getattr(light, f.name) for f in dataclasses.fields(light) if f.name not in ("name", "shade", "group", "hidden_from")]
    if not all(np.isfinite(np.asarray(value, np.float64)).all() for value in numbers):
        warnings.append(SceneWarning("one of its values is not finite, so it is left out", "light", light.name, is_lost=True))
        return False
    hidden_from(light.hidden_from, f"light '{light.name}'")
    if light.shade is not None:
        _check_shade(light.shade, light.name, warnings)
    # First what power() computes with.
    light.check()
    power = light.power()
    if not np.isfinite(power).all():
        warnings.append(SceneWarning("its power is more than any number, so it is left out", "light", light.name, is_lost=True))
        return False
    if min(power) < 0:
        warnings.append(SceneWarning("it would take light away, so it is left out", "light", light.name, is_lost=True))
        return False
    return True


def _check_shade(shade, name, warnings):
    owner = f"light '{name}'"
    if type(shade) is not Shade:
        raise SceneError(f"{owner}: its shade is {shade!r}, allowed: a Shade")
    shade.check(owner)
    _check_texture(shade.texture, owner)
    if any(getattr(part, "counts_bounces", False) for part in with_inner(shade.texture)):
        what = "how often a path was scattered is not known where it meets the light, it counts as on the first bounce"
        warnings.append(SceneWarning(what, "light", name))


def _check_world(world, warnings):
    world.mist.check(f"world '{world.name}'")
    if not world.occlusion_distance >= 0:
        raise SceneError(f"world '{world.name}': occlusion_distance is {world.occlusion_distance} m, allowed: from 0 on")
    environment = world.environment
    if environment is not None and type(environment) is not EnvironmentMap:
        raise SceneError(f"world '{world.name}': {type(environment).__name__} is not an EnvironmentMap")
    if is_texture(world.radiance):
        if environment is not None:
            raise SceneError(f"world '{world.name}': its radiance is a texture, so it has no environment beside it")
        _check_texture(world.radiance, f"world '{world.name}'")
        return world
    colours = {"radiance": world.radiance} | ({"strength of the environment": environment.strength} if environment else {})
    for name, colour in colours.items():
        if not _is_colour(colour):
            raise SceneError(f"world '{world.name}': {name} is {colour}, allowed: three finite numbers from 0 on")
    if environment is None:
        return world
    matrix = environment.world_from_map
    # As far as float32 can hold a rotation. (Not "> ...": NaN is refused too.)
    if not (np.abs(matrix.T @ matrix - np.eye(3)) < 64 * EPS32).all():
        raise SceneError(f"world '{world.name}': its environment is turned by {matrix.tolist()}, allowed: orthogonal matrices")
    pixels = environment.pixels
    if 0 <= pixels.min() <= pixels.max() < math.inf:
        return world
    bad = ~((pixels >= 0) & (pixels < math.inf))
    count = np.count_nonzero(bad.any(axis=0))
    warnings.append(SceneWarning(f"{count} pixels of its picture are not finite or below 0 and count as black", "world", world.name))
    return dataclasses.replace(world, environment=dataclasses.replace(environment, pixels=np.where(bad, np.float32(0), pixels)))


def _is_colour(values):
    return len(values) == 3 and all(math.isfinite(c) and c >= 0 for c in values)


def _is_plain(value):
    """Whether it is one number, or three."""
    return np.shape(value) in ((), (3,)) and np.asarray(value).dtype.kind in "iuf"
