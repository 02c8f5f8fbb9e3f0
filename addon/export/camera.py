"""Blender's camera as the engine's."""

import math

import numpy as np

from ...engine import Lens, OrthographicCamera, PanoramaCamera, PerspectiveCamera, SceneError

_SMALLEST_FSTOP = 1e-5
"""As in Cycles: Blender allows 0."""


def export_camera(camera, render, width, height, matrix=None, shift_x=None):
    """The engine's camera for the camera object `camera` (evaluated) and a full frame of `width` x `height` px.

    `matrix` and `shift_x` replace the camera's own where Blender knows better (stereo views). Raises SceneError where
    there is no camera or its type is not supported.
    """
    if camera is None:
        raise SceneError(f"scene '{render.id_data.name}' has no camera: add one, and make it the active camera")
    if camera.type != "CAMERA":
        raise SceneError(f"{camera.type.lower()} object '{camera.name}' is the active camera: only camera objects are supported")
    data = camera.data
    if data.type not in _KINDS:
        known = "perspective, orthographic and panoramic"
        raise SceneError(f"camera '{camera.name}' has type {data.type}, only {known} are supported: change its lens type")
    matrix = without_scale(np.array(camera.matrix_world if matrix is None else matrix, np.float64))
    size = width * render.pixel_aspect_x, height * render.pixel_aspect_y
    shift = data.shift_x if shift_x is None else shift_x, data.shift_y
    kind, view = _KINDS[data.type]
    return kind(
        name=camera.name,
        world_from_camera=matrix,
        clip_start=data.clip_start,
        clip_end=data.clip_end,
        lens=lens_of(data, matrix),
        **view(camera.name, data, size, shift),
    )


def _perspective(name, data, size, shift):
    return {"window": window(*size, data.lens, data.sensor_width, data.sensor_height, data.sensor_fit, *shift)}


def _orthographic(name, data, size, shift):
    return {"window": fitted_window(*size, 0.5 * data.ortho_scale, data.sensor_fit, *shift)}


def _panorama(name, data, size, shift):
    kind = panorama_setting(data, "panorama_type", "EQUIRECTANGULAR")
    if kind != "EQUIRECTANGULAR":
        raise SceneError(f"camera '{name}' has panorama type {kind}, only EQUIRECTANGULAR is supported: change its panorama type")
    view = {}
    for angle, most, share in (("longitude", math.pi, shift[0]), ("latitude", 0.5 * math.pi, shift[1])):
        low, high = panorama_setting(data, f"{angle}_min", -most), panorama_setting(data, f"{angle}_max", most)
        # A shift is a share of the whole frame here, whatever its sides.
        view[angle] = (low + share * (high - low), high + share * (high - low))
    return view


def panorama_setting(data, name, default):
    """A setting of a panoramic camera: Blender's own from 5.0 on, Cycles' before that, else `default`."""
    return getattr(data, name, getattr(getattr(data, "cycles", None), name, default))


_KINDS = {
    "PERSP": (PerspectiveCamera, _perspective),
    "ORTHO": (OrthographicCamera, _orthographic),
    "PANO": (PanoramaCamera, _panorama),
}


def lens_of(data, matrix):
    """The `Lens` of a camera that stands at `matrix`, opened as far as the f-stop says.

    An orthographic camera has no focal length, and takes 1 m for it.
    """
    dof = data.dof
    if not dof.use_dof:
        return Lens()
    focal_length = 1.0 if data.type == "ORTHO" else 1e-3 * data.lens
    return Lens(
        radius=focal_length / (2 * max(dof.aperture_fstop, _SMALLEST_FSTOP)),
        focus_distance=_focus_distance(dof, matrix),
        blades=dof.aperture_blades if dof.aperture_blades >= 3 else 0,
        rotation=dof.aperture_rotation,
        ratio=dof.aperture_ratio,
    )


def _focus_distance(dof, matrix):
    """To the plane of the focus object, or of its bone, along the camera's axis [m]."""
    ob = dof.focus_object
    if ob is None:
        return dof.focus_distance
    target = ob.matrix_world
    bone = ob.pose and dof.focus_subtarget and ob.pose.bones.get(dof.focus_subtarget)
    if bone:
        target = target @ bone.matrix
    return abs(float(matrix[:3, 2] @ (matrix[:3, 3] - np.array(target, np.float64)[:3, 3])))


def window(width, height, lens, sensor_width, sensor_height, sensor_fit, shift_x, shift_y):
    """(left, right, bottom, top) of what a perspective camera sees at distance 1; lens and sensor in millimetres.

    AUTO fits the longer side, always to the sensor's width. For the others see `fitted_window`.
    """
    half = 0.5 * (sensor_height if sensor_fit == "VERTICAL" else sensor_width) / lens
    return fitted_window(width, height, half, sensor_fit, shift_x, shift_y)


def fitted_window(width, height, half, sensor_fit, shift_x, shift_y):
    """(left, right, bottom, top) of a frame with the half-length `half` of the side that the sensor is fitted to.

    width, height of the frame in units of the pixel aspect; shifts in units of that side.
    """
    is_horizontal = width >= height if sensor_fit == "AUTO" else sensor_fit == "HORIZONTAL"
    half_x, half_y = (half, half * height / width) if is_horizontal else (half * width / height, half)
    x, y = 2 * half * shift_x, 2 * half * shift_y
    return x - half_x, x + half_x, y - half_y, y + half_y


def without_scale(matrix):
    """(4, 4) with axes of unit length: a camera's scale does not change its picture."""
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    result = matrix.copy()
    result[:3, :3] /= np.where(lengths > 0, lengths, 1)
    return result
