"""Cells."""

from dataclasses import dataclass

import numpy as np

from ..errors import SceneError
from ..maths.voronoi import FEATURES, METRICS, Shape, fractal_cells, fractal_edges, sphere_radius
from ..scene.coordinates import GENERATED
from ..scene.placing import numbers, octaves, placed, shared_key
from . import registry

_FEATURES = (*FEATURES, "distance to edge", "n sphere radius")
_OUTPUTS = ("distance", "color", "position", "w", "radius")


@registry.add
@dataclass(frozen=True, eq=False)
class VoronoiTexture:
    """Blender's cells around random points, in one to four dimensions.

    scale, w       how fine all is; the fourth coordinate, or the only one
    detail         octaves beyond the first, 0 to 15; a fraction fades the last one in
    roughness      how strong each octave is, compared to the one before, 0 to 1
    lacunarity     how fine, likewise
    smoothness     how far cells blend, 0 to 1: of the feature "smooth f1"
    exponent       of the metric "minkowski"
    randomness     how far points stray from a regular lattice, 0 to 1
    feature        "f1", "f2": of the nearest and second nearest point; "smooth f1"; "distance to edge"; "n sphere radius"
    metric         "euclidean", "manhattan", "chebychev", "minkowski"
    output         "distance", "color", "position", "w", "radius"; the radius is that of spheres that meet no others
    is_normalized  distances and colours are divided by the most that they can be
    is_integer     the points are those of Blender 5.0 and newer
    """

    key = "voronoi"
    label = "Voronoi"
    is_pure = False

    coordinates: object = GENERATED
    scale: object = 1.0
    w: object = 0.0
    detail: object = 0.0
    roughness: object = 0.5
    lacunarity: object = 2.0
    smoothness: object = 1.0
    exponent: object = 0.5
    randomness: object = 1.0
    feature: str = "f1"
    metric: str = "euclidean"
    output: str = "distance"
    dimensions: int = 3
    is_normalized: bool = False
    is_integer: bool = True

    def check(self, owner):
        for name, allowed in (("feature", _FEATURES), ("metric", METRICS), ("output", _OUTPUTS), ("dimensions", (1, 2, 3, 4))):
            value = getattr(self, name)
            if value not in allowed:
                raise SceneError(f"{owner}: Voronoi {name} is '{value}', allowed: {', '.join(map(str, allowed))}")

    def eval(self, at):
        found = at.once(shared_key(self, but="output"), lambda: self._outputs(at))
        return found.get(self.output, np.zeros((3 if self.output in ("color", "position") else 1, 1), np.float32))

    def _outputs(self, at):
        p, _ = placed(at, self.coordinates, self.scale, self.w, self.dimensions)
        detail, roughness, lacunarity, smoothness, exponent, randomness = numbers(
            at, self.detail, self.roughness, self.lacunarity, self.smoothness, self.exponent, self.randomness
        )
        smoothness = np.clip(smoothness / 2, 0, np.float32(0.5))
        feature = "f1" if self.feature == "smooth f1" and self.smoothness == 0 else self.feature
        shape = Shape(np.clip(randomness, 0, 1), self.metric, exponent, smoothness, self.is_integer)
        if feature == "n sphere radius":
            return {"radius": sphere_radius(p, shape)[None]}
        scales = octaves(detail), np.clip(roughness, 0, 1), lacunarity, self.is_normalized
        if feature == "distance to edge":
            return {"distance": fractal_edges(p, shape, *scales)[None]}
        distance, colour, position = fractal_cells(p, feature, shape, *scales)
        (scale,) = numbers(at, self.scale)
        position = np.divide(position, scale, out=np.zeros_like(position), where=np.broadcast_to(scale != 0, position.shape))
        found = {"distance": distance[None], "color": colour}
        if self.dimensions > 1:
            rows = np.zeros((3, position.shape[1]), np.float32)
            rows[: min(self.dimensions, 3)] = position[:3]
            found["position"] = rows
        if self.dimensions in (1, 4):
            found["w"] = position[-1:]
        return found
