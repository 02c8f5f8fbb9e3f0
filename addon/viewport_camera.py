"""What a 3D view looks at, as the engine's camera.

A view is known by two matrices of Blender's: `view_matrix` places it, `window_matrix` projects. The latter has all in it that
makes up the picture: lens and shift, zoom and offset of camera views, the aspect of the region. What is rendered is a
rectangle of the region: all of it, the border, or the frame of a panoramic camera.

Windows and rectangles are (left, right, bottom, top), fractions of a region are 0 at its left and bottom.
"""

from dataclasses import dataclass

import numpy as np

from ..engine import Lens, OrthographicCamera, PanoramaCamera, PerspectiveCamera
from .export.camera import export_camera, fitted_window, lens_of, window, without_scale

_WHOLE = (0.0, 1.0, 0.0, 1.0)


@dataclass(frozen=True)
class View:
    """What is seen in a rectangle of a region; equal views look the same.

    rectangle  (x, y, width, height) [px] from the region's bottom left
    kind       the class of the engine's camera
    matrix     world_from_camera, (16,), row by row
    shape      how the camera projects: pairs of a field of its and the value
    clip       (start, end) [m]
    lens       the engine's `Lens`
    """

    rectangle: tuple
    kind: type
    matrix: tuple
    shape: tuple
    clip: tuple
    lens: object
    name: str

    def camera(self):
        """The engine's camera."""
        matrix = np.array(self.matrix).reshape(4, 4)
        start, end = self.clip
        return self.kind(name=self.name, world_from_camera=matrix, clip_start=start, clip_end=end, lens=self.lens, **dict(self.shape))


def view_of(region, region_data, space, depsgraph):
    """The `View` of a region of a 3D view `space`; None where nothing of it is to be rendered.

    Raises SceneError for a camera that the engine does not have.
    """
    seen = projected_window(region_data.window_matrix)
    matrix = without_scale(np.linalg.inv(np.array(region_data.view_matrix, np.float64)))
    kind = PerspectiveCamera if region_data.is_perspective else OrthographicCamera
    camera = space.camera.evaluated_get(depsgraph) if region_data.view_perspective == "CAMERA" and space.camera else None
    data = camera.data if camera and camera.type == "CAMERA" else None
    render = depsgraph.scene_eval.render
    frame = fractions_in(camera_window(data, render), seen) if data else None
    if data and data.type == "PANO":
        kind = PanoramaCamera
    rectangle = pixels_of(_rendered(frame, kind, render, space), region.width, region.height)
    if rectangle is None:
        return None
    part = fractions_of(rectangle, region.width, region.height)
    if kind is PanoramaCamera:
        whole = export_camera(camera, render, render.resolution_x, render.resolution_y)
        *longitude, bottom, top = inside((*whole.longitude, *whole.latitude), fractions_in(part, frame))
        shape = ("longitude", tuple(longitude)), ("latitude", (bottom, top))
    else:
        shape = (("window", inside(seen, part)),)
    return View(
        rectangle=rectangle,
        kind=kind,
        matrix=tuple(matrix.ravel().tolist()),
        shape=shape,
        clip=(data.clip_start, data.clip_end) if data else _free_clip(kind, space),
        lens=lens_of(data, matrix) if data else Lens(),
        name=camera.name if camera else "View",
    )


def _rendered(frame, kind, render, space):
    """Which fractions of the region are to be rendered; `frame` are those of the camera's picture, None without a camera."""
    if frame is None:
        border = space.render_border_min_x, space.render_border_max_x, space.render_border_min_y, space.render_border_max_y
        return border if space.use_render_border else _WHOLE
    if render.use_border:
        return inside(frame, (render.border_min_x, render.border_max_x, render.border_min_y, render.border_max_y))
    return frame if kind is PanoramaCamera else _WHOLE


def _free_clip(kind, space):
    # As in Blender: parallel views show as much of what is behind as of what is in front.
    return (-0.5 * space.clip_end, 0.5 * space.clip_end) if kind is OrthographicCamera else (space.clip_start, space.clip_end)


def projected_window(window_matrix):
    """The window that a projection matrix shows: at distance 1, or, where it is orthographic, of the plane [m]."""
    m = np.array(window_matrix, np.float64)
    # (m00 x + m02 z + m03) / w, with w = -z or 1, is -1 on the left and 1 on the right; the same for y.
    middle = (m[0, 2], m[1, 2]) if m[3, 2] else (-m[0, 3], -m[1, 3])
    return tuple(float((c + side) / m[i, i]) for i, c in enumerate(middle) for side in (-1, 1))


def camera_window(data, render):
    """The window of a camera's frame as 3D views show it: for a panorama the one that it would have as a perspective camera."""
    size = render.resolution_x * render.pixel_aspect_x, render.resolution_y * render.pixel_aspect_y
    shift = data.shift_x, data.shift_y
    if data.type == "ORTHO":
        return fitted_window(*size, 0.5 * data.ortho_scale, data.sensor_fit, *shift)
    return window(*size, data.lens, data.sensor_width, data.sensor_height, data.sensor_fit, *shift)


def inside(outer, fractions):
    """The rectangle that is these `fractions` of `outer`."""
    (a, b, c, d), (left, right, bottom, top) = fractions, outer
    x, y = right - left, top - bottom
    return left + a * x, left + b * x, bottom + c * y, bottom + d * y


def fractions_in(inner, outer):
    """The inverse of `inside`: which fractions of `outer` the rectangle `inner` is."""
    (a, b, c, d), (left, right, bottom, top) = inner, outer
    x, y = right - left, top - bottom
    return (a - left) / x, (b - left) / x, (c - bottom) / y, (d - bottom) / y


def pixels_of(fractions, width, height):
    """(x, y, width, height) of the whole pixels of a region that these fractions of it are; None where there is none."""
    a, b, c, d = fractions
    x0, x1 = (min(max(round(f * width), 0), width) for f in (a, b))
    y0, y1 = (min(max(round(f * height), 0), height) for f in (c, d))
    return (x0, y0, x1 - x0, y1 - y0) if x0 < x1 and y0 < y1 else None


def fractions_of(rectangle, width, height):
    """The inverse of `pixels_of`, for whole pixels."""
    x, y, w, h = rectangle
    return x / width, (x + w) / width, y / height, (y + h) / height
