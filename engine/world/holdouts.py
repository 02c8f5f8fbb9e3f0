"""Which materials the camera sees as clear and black."""

from dataclasses import dataclass

import numpy as np

from ..scene.graphs import is_texture


@dataclass(frozen=True, slots=True, eq=False)
class Holdouts:
    """A column for each material.

    share     (3, M) float32: the share of light for which nothing is there; 0 where it is a texture
    textured  {row: the texture that it is}
    holds     (M,) bool: whether anything is held out
    """

    share: np.ndarray
    textured: dict
    holds: np.ndarray

    @classmethod
    def of(cls, materials):
        """From `Material` values."""
        textured = {row: material.holdout for row, material in enumerate(materials) if is_texture(material.holdout)}
        share = np.array([(0.0, 0.0, 0.0) if row in textured else material.holdout for row, material in enumerate(materials)], np.float32).T
        holds = share.any(axis=0)
        holds[[*textured]] = True
        return cls(np.ascontiguousarray(share), textured, holds)
