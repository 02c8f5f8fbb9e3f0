"""Where on a surface a texture is looked up."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError

SOURCES = ("uv", "generated", "object", "position", "camera")
_IDENTITY = ((1.0, 0.0, 0.0, 0.0), (0.0, 1.0, 0.0, 0.0), (0.0, 0.0, 1.0, 0.0), (0.0, 0.0, 0.0, 1.0))


@dataclass(frozen=True, kw_only=True)
class Coordinates:
    """Points (x, y, z) that vary linearly over each triangle.

    source  "uv": a layer of the mesh, with z = 0; "generated": the mesh's bounding box is the unit cube; "object": object space [m];
            "position": world space [m]; "camera": the frame of the camera, which looks along +z, x to the right, y up [m]
    layer   the uv layer; empty: the mesh's first. A mesh without it is at 0 everywhere
    matrix  texture_from_source (4, 4), affine
    """

    source: str = "uv"
    layer: str = ""
    matrix: tuple = _IDENTITY

    def __post_init__(self):
        matrix = np.asarray(self.matrix, np.float64)
        if matrix.shape != (4, 4):
            raise SceneError(f"texture coordinates: matrix has shape {matrix.shape}, expected (4, 4)")
        # Tuples, so that equal coordinates are equal values.
        object.__setattr__(self, "matrix", tuple(map(tuple, matrix.tolist())))

    @property
    def attribute(self):
        """What the mesh must bring: (source, layer)."""
        return (self.source, self.layer if self.source == "uv" else "")

    def check(self, owner):
        """Raises SceneError, naming `owner`, for an unknown source or a matrix that is not finite."""
        if self.source not in SOURCES:
            raise SceneError(f"{owner}: texture coordinates are '{self.source}', allowed: {', '.join(SOURCES)}")
        if not np.isfinite(self.matrix).all():
            raise SceneError(f"{owner}: the transform of its texture coordinates is not finite")


UV = Coordinates()
GENERATED = Coordinates(source="generated")
