"""What stands before a light: a texture that says how much of its light goes where."""

from dataclasses import dataclass, field

import numpy as np

from ..errors import SceneError
from .graphs import is_texture
from .textured import asked_by


@dataclass(frozen=True, kw_only=True, eq=False)
class Shade:
    """A texture by which the radiance of a light is multiplied.

    texture           looked up where rays meet the light. It is asked in the light's own frame: "object" and "generated" coordinates
                      are the place on the light [m]; "uv" runs over an area light, over the cone of a spot, around a point light
                      along its z axis, and over the disk of a sun; the normal of bulbs and suns is against the ray
    world_from_light  (4, 4) the frame, which shines along -z
    values            what textures can ask of the light as of an object, see `Object.values`
    """

    texture: object
    world_from_light: np.ndarray = field(default_factory=lambda: np.eye(4))
    values: tuple = ()

    @property
    def attributes(self):
        """What its texture is looked up at, see `textured.asked_by`."""
        return asked_by([self.texture])

    def check(self, owner):
        """Raises SceneError, naming `owner`, such as "light 'Key'"."""
        if not is_texture(self.texture):
            raise SceneError(f"{owner}: its shade is {self.texture!r}, allowed: a texture")
        matrix = np.asarray(self.world_from_light, np.float64)
        if matrix.shape != (4, 4) or not np.isfinite(matrix).all():
            raise SceneError(f"{owner}: the frame of its shade is not a finite (4, 4) matrix")
        if not all(len(value) == 2 and np.shape(value[1]) == (4,) for value in self.values):
            raise SceneError(f"{owner}: values of its shade are not pairs of a name and four numbers")
