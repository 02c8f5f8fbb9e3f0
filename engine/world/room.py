"""What a world takes of memory, told before it is compiled."""

import numpy as np

from ..memory import require
from ..scene.graphs import is_texture

BYTES_PER_TRIANGLE = 350
"""All of a world in which there is one vertex for two triangles, with Embree's tree, at the most; measured, rounded up."""
BYTES_PER_LAMP = 600
"""Of each triangle that glows, beyond that."""
IN_DOUBLE = {np.float32: (0, 0), np.float64: (52, 100)}
"""By the dtype of rays: of each triangle beyond that, and of each that glows."""
BYTES_PER_VERTEX = 60
"""Of each vertex beyond one for two triangles."""


def bytes_per_triangle(glows, real):
    """Of a triangle that `glows` or not, for rays of the dtype `real`."""
    wider, wider_lamp = IN_DOUBLE[real]
    return BYTES_PER_TRIANGLE + wider + (BYTES_PER_LAMP + wider_lamp) * glows


def require_room(scene, motion_steps, real=np.float32):
    """Raises MemoryShortage, naming the scene and the object with most triangles, where its triangles would not fit.

    motion_steps  shapes of meshes that deform, 0: none
    real          the dtype of rays
    """
    counts, needed = [], 0
    for o in scene.objects:
        triangles, vertices = o.mesh.triangles.shape[1], o.mesh.vertices.shape[1]
        shapes = max(motion_steps, 1) if o.mesh.deforms else 1
        counts.append(shapes * triangles)
        if triangles:
            of_each = bytes_per_triangle(any(is_texture(m.emission) or any(m.emission) for m in o.materials), real)
            needed += shapes * (of_each * triangles + BYTES_PER_VERTEX * max(vertices - triangles // 2, 0))
    if needed:
        most, name = max(zip(counts, (o.name for o in scene.objects)))
        what = f"scene '{scene.name}': its {sum(counts)} triangles, most of them {most} of object '{name}',"
        require(needed, what, "simplify or leave out objects")
