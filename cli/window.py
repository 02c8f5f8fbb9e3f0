"""How a camera's view changes with the shape of the frame."""

import dataclasses


def fitted(scene, old, new):
    """`scene` for a frame of `new` instead of `old` (width, height) [px].

    As with Blender's sensor fit Auto, the longer side keeps its field of view, and pixels keep their shape and the
    middle of the picture its place. A camera without a window, as for a panorama, shows the same in a frame of any shape.
    """
    if old[0] * new[1] == new[0] * old[1] or not hasattr(scene.camera, "window"):
        return scene
    left, right, bottom, top = scene.camera.window
    width, height = right - left, top - bottom
    pixel_shape = (width / old[0]) / (height / old[1])
    longest = max(width, height)
    new_width, new_height = new[0] * pixel_shape, float(new[1])
    scale = longest / max(new_width, new_height)
    x, y, half_width, half_height = 0.5 * (left + right), 0.5 * (bottom + top), 0.5 * new_width * scale, 0.5 * new_height * scale
    window = (x - half_width, x + half_width, y - half_height, y + half_height)
    return dataclasses.replace(scene, camera=dataclasses.replace(scene.camera, window=window))
