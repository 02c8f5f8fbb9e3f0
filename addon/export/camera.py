"""Blender's camera as the engine's."""

import numpy as np

from ...engine import PerspectiveCamera, SceneError


def export_camera(camera, render, width, height, findings, matrix=None, shift_x=None):
    """The engine's camera for the camera object `camera` (evaluated) and a full frame of `width` x `height` px.

    `matrix` and `shift_x` replace the camera's own where Blender knows better (stereo views). Raises SceneError where
    there is no camera or its type is not supported.
    """
    if camera is None:
        raise SceneError(f"scene '{render.id_data.name}' has no camera: add one, and make it the active camera")
    if camera.type != "CAMERA":
        raise SceneError(f"{camera.type.lower()} object '{camera.name}' is the active camera: only camera objects are supported")
    data = camera.data
    if data.type != "PERSP":
        raise SceneError(f"camera '{camera.name}' has type {data.type}, only PERSP (perspective) is supported: change its lens type")
    if data.dof.use_dof:
        findings.note("depth of field is not rendered, everything is sharp", f"camera '{camera.name}'")
    return PerspectiveCamera(
        name=camera.name,
        world_from_camera=without_scale(np.array(camera.matrix_world if matrix is None else matrix, np.float64)),
        window=window(
            width * render.pixel_aspect_x,
            height * render.pixel_aspect_y,
            data.lens,
            data.sensor_width,
            data.sensor_height,
            data.sensor_fit,
            data.shift_x if shift_x is None else shift_x,
            data.shift_y,
        ),
    )


def window(width, height, lens, sensor_width, sensor_height, sensor_fit, shift_x, shift_y):
    """(left, right, bottom, top) of what is seen at distance 1.

    width, height of the frame in units of the pixel aspect; lens and sensor in millimetres; shifts in units of the
    side that the sensor is fitted to. AUTO fits the longer side, always to the sensor's width.
    """
    is_horizontal = width >= height if sensor_fit == "AUTO" else sensor_fit == "HORIZONTAL"
    half = 0.5 * (sensor_height if sensor_fit == "VERTICAL" else sensor_width) / lens
    half_x, half_y = (half, half * height / width) if is_horizontal else (half * width / height, half)
    x, y = 2 * half * shift_x, 2 * half * shift_y
    return x - half_x, x + half_x, y - half_y, y + half_y


def without_scale(matrix):
    """(4, 4) with axes of unit length: a camera's scale does not change its picture."""
    lengths = np.linalg.norm(matrix[:3, :3], axis=0)
    result = matrix.copy()
    result[:3, :3] /= np.where(lengths > 0, lengths, 1)
    return result
