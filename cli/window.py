"""How a camera's view changes with the shape of the frame."""

import dataclasses

from ..engine import SceneError


def fitted(scene, old, new):
    """`scene` for a frame of `new` instead of `old` (width, height) [px].

    As with Blender's sensor fit Auto, the longer side keeps its field of view, and pixels keep their shape and the
    middle of the picture its place. Raises SceneError for a camera whose view cannot be changed so.
    """
    if old[0] * new[1] == new[0] * old[1] or scene.camera is None:
        return scene
    if not hasattr(scene.camera, "window"):
        raise SceneError(f"camera '{scene.camera.name}' cannot change its shape from {old[0]}x{old[1]} to {new[0]}x{new[1]} px")
    left, right, bottom, top = scene.camera.window
    width, height = right - left, top - bottom
    pixel_shape = (width / old[0]) / (height / old[1])
    longest = max(width, height)
    new_width, new_height = new[0] * pixel_shape, float(new[1])
    scale = longest / max(new_width, new_height)
    x, y, half_width, half_height = 0.5 * (left + right), 0.5 * (bottom + top), 0.5 * new_width * scale, 0.5 * new_height * scale
    window = (x - half_width, x + half_width, y - half_height, y + half_height)
    return dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, window=window))
