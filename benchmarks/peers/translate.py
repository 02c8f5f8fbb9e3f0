"""A Glanz scene as a dictionary for Mitsuba 3: meshes, materials, lights, the camera.

Only what both mean alike is translated; everything else raises `Untranslatable`, naming the object. A variant of Mitsuba has to be set
before. What glows shines from its front only, where Glanz' shines from both sides: comparing pictures shows where that matters.
"""

import math

import mitsuba as mi
import numpy as np

from glanz.engine import Coordinates, Dielectric, ImageTexture, Lambert, Mirror, PerspectiveCamera, PointLight, is_texture

SAMPLERS = ("multijitter", "independent")
_CAMERA_FRAME = np.diag((-1.0, 1.0, -1.0, 1.0))
"""Mitsuba's cameras look along +z, x to the left."""
_MAP_FRAME = np.array(((0.0, 0.0, 1.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
"""Glanz' environments from Mitsuba's: poles on z from y, the middle of the picture on x from z."""
_EXTENSIONS = {"repeat": "repeat", "extend": "clamp", "mirror": "mirror"}


class Untranslatable(Exception):
    """What the two renderers do not have alike."""


def translate(scene, settings, sides):
    """The dictionary for `mi.load_dict`.

    sides  the longer sides of the pictures that will be asked for [px]: there is a sensor for each side and each of `SAMPLERS`, in this
           order, see `sensor_index`. Raises Untranslatable.
    """
    if settings.pixel_filter != "box" or settings.integrator != "path":
        raise Untranslatable(f"settings: filter {settings.pixel_filter} and integrator {settings.integrator}; only box and path are alike")
    # Mitsuba counts segments from the camera on, Glanz bounces after the first hit.
    result = {"type": "scene", "integrator": {"type": "path", "max_depth": settings.max_depth + 2}}
    for number, (side, sampler) in enumerate((side, sampler) for side in sides for sampler in SAMPLERS):
        result[f"sensor_{number}"] = _sensor(scene.camera, settings, side, sampler)
    bsdfs = {}
    for number, o in enumerate(scene.objects):
        for slot, mesh in enumerate(_meshes(o, bsdfs)):
            result[f"mesh_{number}_{slot}"] = mesh
    for number, light in enumerate(scene.lights):
        result[f"light_{number}"] = _light(light)
    return result | _world(scene.world)


def sensor_index(sides, side, sampler):
    """Which of the scene's sensors it is."""
    return sides.index(side) * len(SAMPLERS) + SAMPLERS.index(sampler)


def frame(settings, side):
    """(width, height) [px] of the picture whose longer side is `side`."""
    longest = max(settings.width, settings.height)
    return round(side * settings.width / longest), round(side * settings.height / longest)


def _sensor(camera, settings, side, sampler):
    left, right, bottom, top = getattr(camera, "window", (0, 0, 0, 0))
    if not isinstance(camera, PerspectiveCamera) or len(camera.motion):
        raise Untranslatable(f"camera '{camera.name}' is no perspective one at rest")
    if not (math.isclose(-left, right, rel_tol=1e-6) and math.isclose(-bottom, top, rel_tol=1e-6)):
        raise Untranslatable(f"camera '{camera.name}' is shifted")
    lens = {}
    if camera.lens.is_open:
        if camera.lens.blades or camera.lens.ratio != 1:
            raise Untranslatable(f"camera '{camera.name}': its aperture is no disk")
        lens = {"aperture_radius": camera.lens.radius, "focus_distance": camera.lens.focus_distance}
    width, height = frame(settings, side)
    return {
        "type": "thinlens" if lens else "perspective",
        "to_world": mi.ScalarTransform4f(camera.world_from_camera @ _CAMERA_FRAME),
        "fov": math.degrees(2 * math.atan(right)),
        "fov_axis": "x",
        "near_clip": max(camera.clip_start, 1e-3),
        "far_clip": min(camera.clip_end, 1e5),
        "film": {
            "type": "hdrfilm",
            "width": width,
            "height": height,
            "pixel_format": "rgb",
            "component_format": "float32",
            "rfilter": {"type": "box"},
        },
        "sampler": {"type": sampler},
        **lens,
    }


def _meshes(o, bsdfs):
    """A Mitsuba mesh for each material of an object; `bsdfs` are those made so far."""
    if o.moves or o.mesh.deforms or o.hidden_from:
        raise Untranslatable(f"object '{o.name}' moves or is hidden")
    indices = o.mesh.material_indices
    slots = indices.clip(0, max(len(o.materials) - 1, 0)) if indices.size else np.zeros(o.mesh.triangles.shape[1], np.int32)
    for slot in np.unique(slots):
        material = o.materials[slot] if o.materials else None
        yield _mesh(o, np.nonzero(slots == slot)[0], material, bsdfs)


def _mesh(o, faces, material, bsdfs):
    corners = o.mesh.triangles.take(faces, axis=1)
    properties = mi.Properties()
    properties["mesh_bsdf"] = _kept_bsdf(material, bsdfs)
    properties["face_normals"] = not o.mesh.is_smooth
    if material is not None and is_texture(material.emission):
        raise Untranslatable(f"material '{material.name}' glows by a texture")
    if material is not None and any(material.emission):
        properties["mesh_emitter"] = mi.load_dict({"type": "area", "radiance": _colour(material.emission)})
    # A vertex of Mitsuba's has one normal and one place on the picture, so corners that differ in them are vertices of their own.
    normals = o.mesh.normal_indices.take(faces, axis=1) if o.mesh.is_smooth else np.zeros_like(corners)
    uvs = o.mesh.uv_indices.take(faces, axis=1) if o.mesh.uv_layers else np.zeros_like(corners)
    key = (corners.astype(np.int64) * (normals.max() + 1) + normals) * (uvs.max() + 1) + uvs
    _, first, index = np.unique(key, return_index=True, return_inverse=True)
    vertex, normal, uv = (a.ravel().take(first) for a in (corners, normals, uvs))
    linear = o.world_from_object[:3, :3]
    made = mi.Mesh(
        o.name,
        first.size,
        corners.shape[1],
        props=properties,
        has_vertex_normals=o.mesh.is_smooth,
        has_vertex_texcoords=bool(o.mesh.uv_layers),
    )
    parameters = mi.traverse(made)
    parameters["vertex_positions"] = _flat(linear @ o.mesh.vertices.take(vertex, axis=1) + o.world_from_object[:3, 3:])
    index = index.reshape(corners.shape)
    if np.linalg.det(linear) < 0:
        index = index[::-1]
    parameters["faces"] = np.ascontiguousarray(index.T, np.uint32).ravel()
    if o.mesh.is_smooth:
        turned = np.linalg.inv(linear).T @ o.mesh.normals.take(normal, axis=1)
        parameters["vertex_normals"] = _flat(turned / np.linalg.norm(turned, axis=0))
    if o.mesh.uv_layers:
        parameters["vertex_texcoords"] = _flat(o.mesh.uvs[0].take(uv, axis=1))
    parameters.update()
    return made


def _flat(rows):
    return np.ascontiguousarray(rows.T, np.float32).ravel()


def _kept_bsdf(material, bsdfs):
    if id(material) not in bsdfs:
        bsdfs[id(material)] = mi.load_dict(_bsdf(material))
    return bsdfs[id(material)]


def _bsdf(material):
    lobes = {type(lobe): lobe for lobe in material.lobes} if material else {}
    plain = not material or (material.alpha == 1.0 and material.medium is None and not material.relief and not any(material.holdout))
    if not plain or len(lobes) != len(material.lobes if material else ()):
        raise Untranslatable(f"material '{material.name}' has more than diffuse, mirror and glass lobes")
    if set(lobes) == {Dielectric}:
        return _glass(lobes[Dielectric], material.name)
    if not set(lobes) <= {Lambert, Mirror}:
        raise Untranslatable(f"material '{material.name}' has the lobes {', '.join(kind.__name__ for kind in lobes)}")
    if Mirror not in lobes:
        return _two_sided(_diffuse(lobes[Lambert].reflectance if lobes else (0.0, 0.0, 0.0), 1.0, material))
    mirror = lobes[Mirror].reflectance
    if Lambert not in lobes:
        return _two_sided(_conductor(mirror, 1.0))
    diffuse = lobes[Lambert].reflectance
    if is_texture(diffuse) or is_texture(mirror) or max(diffuse) + max(mirror) > 1:
        raise Untranslatable(f"material '{material.name}': a mixture of textures, or of more than there is")
    share = min(max(sum(mirror) / (sum(mirror) + sum(diffuse)), max(mirror)), 1 - max(diffuse))
    return _two_sided({"type": "blendbsdf", "weight": share, "a": _diffuse(diffuse, 1 - share, material), "b": _conductor(mirror, share)})


def _two_sided(bsdf):
    return {"type": "twosided", "bsdf": bsdf}


def _diffuse(reflectance, share, material):
    return {"type": "diffuse", "reflectance": _reflectance(reflectance, share, material)}


def _conductor(reflectance, share):
    return {"type": "conductor", "material": "none", "specular_reflectance": _colour(reflectance, 1 / share)}


def _glass(lobe, name):
    if not lobe.is_fresnel or lobe.etendue != 1 or math.isfinite(lobe.abbe):
        raise Untranslatable(f"material '{name}' is glass with more than an index and tints")
    colours = {"specular_reflectance": _colour(lobe.reflectance), "specular_transmittance": _colour(lobe.transmittance)}
    return {"type": "dielectric", "int_ior": lobe.ior, "ext_ior": 1.0, **colours}


def _reflectance(value, share, material):
    if not is_texture(value):
        return _colour(value, 1 / share)
    plain = isinstance(value, ImageTexture) and value.coordinates == Coordinates() and value.projection == "flat" and not value.tiles
    if not plain or value.extension not in _EXTENSIONS or value.is_cubic or value.output != "colour" or share != 1:
        raise Untranslatable(f"material '{material.name}' has a texture that is no plain picture")
    pixels = np.moveaxis(value.bitmap.pixels[:3], 0, 2)
    if pixels.dtype == np.uint8:
        if value.bitmap.is_srgb:
            # Blender interpolates what is encoded, Mitsuba what is decoded.
            raise Untranslatable(f"material '{material.name}' has a picture encoded by sRGB")
        pixels = pixels / np.float32(255)
    return {
        "type": "bitmap",
        "bitmap": mi.Bitmap(np.ascontiguousarray(pixels, np.float32)),
        "raw": True,
        "filter_type": "bilinear" if value.is_smooth else "nearest",
        "wrap_mode": _EXTENSIONS[value.extension],
    }


def _colour(values, factor=1.0):
    return {"type": "rgb", "value": [float(value * factor) for value in values]}


def _light(light):
    if not isinstance(light, PointLight) or light.radius or light.shade or light.hidden_from:
        raise Untranslatable(f"light '{light.name}' is no point without a size")
    return {"type": "point", "position": list(map(float, light.position)), "intensity": _colour(light.intensity)}


def _world(world):
    if is_texture(world.radiance) or world.hidden_from or (world.environment is not None and any(world.radiance)):
        raise Untranslatable(f"world '{world.name}' is neither one colour nor one picture")
    if world.environment is not None:
        return {"world": _environment(world.environment)}
    return {"world": {"type": "constant", "radiance": _colour(world.radiance)}} if any(world.radiance) else {}


def _environment(picture):
    if picture.interpolation != "linear":
        raise Untranslatable(f"environment '{picture.name}' is not interpolated")
    matrix = np.eye(4)
    matrix[:3, :3] = picture.world_from_map @ _MAP_FRAME
    pixels = _from_pole_to_pole(picture.pixels) * np.float32(picture.strength)[:, None, None]
    return {
        "type": "envmap",
        "bitmap": mi.Bitmap(np.ascontiguousarray(np.moveaxis(pixels, 0, 2))),
        "to_world": mi.ScalarTransform4f(matrix),
    }


def _from_pole_to_pole(pixels):
    """(3, 2 H + 1, W) that Mitsuba interpolates as Glanz does (3, H, W): its first and last rows are the poles, not half a row away."""
    rows = np.concatenate((pixels[:, :1], pixels, pixels[:, -1:]), axis=1)
    result = np.empty((3, 2 * pixels.shape[1] + 1, pixels.shape[2]), np.float32)
    result[:, 1::2], result[:, ::2] = pixels, 0.5 * (rows[:, 1:] + rows[:, :-1])
    return result
