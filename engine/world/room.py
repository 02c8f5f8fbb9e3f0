"""What a world takes of memory, told before it is compiled."""

from ..memory import require
from ..scene.graphs import is_texture

BYTES_PER_TRIANGLE = 350
"""All of a world in which there is one vertex for two triangles, with Embree's tree, at the most; measured, rounded up."""
BYTES_PER_LAMP = 600
"""Of each triangle that glows, beyond that."""
BYTES_PER_VERTEX = 60
"""Of each vertex beyond one for two triangles."""


def require_room(scene, motion_steps):
    """Raises MemoryShortage, naming the scene and the object with most triangles, where its triangles would not fit.

    motion_steps  shapes of meshes that deform, 0: none
    """
    counts, needed = [], 0
    for o in scene.objects:
        triangles, vertices = o.mesh.triangles.shape[1], o.mesh.vertices.shape[1]
        shapes = max(motion_steps, 1) if o.mesh.deforms else 1
        counts.append(shapes * triangles)
        if triangles:
            of_each = BYTES_PER_TRIANGLE + BYTES_PER_LAMP * any(is_texture(m.emission) or any(m.emission) for m in o.materials)
            needed += shapes * (of_each * triangles + BYTES_PER_VERTEX * max(vertices - triangles // 2, 0))
    if needed:
        most, name = max(zip(counts, (o.name for o in scene.objects)))
        what = f"scene '{scene.name}': its {sum(counts)} triangles, most of them {most} of object '{name}',"
        require(needed, what, "simplify or leave out objects")
