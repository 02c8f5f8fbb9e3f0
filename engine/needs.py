"""The features that a scene may ask for; what nobody asks for is not run."""

from enum import Enum


class Need(Enum):
    """One feature; its value says what it is for."""

    GEOMETRY = "triangles to intersect"
    SMOOTH_NORMALS = "shading normals interpolated across triangles"
    LAMBERT = "ideal diffuse reflection"
    PHONG = "glossy reflection by a Phong lobe"
    LIGHTS = "light objects, sampled by shadow rays"
    EMISSIVE_MESHES = "meshes that emit, sampled by shadow rays"
    LIGHT_CHOICE = "more than one light to choose from"
    LIGHT_HITS = "light objects with a size, met by scattered rays"
    BACKGROUND = "light from the world"
    FILTER = "a pixel filter wider than the pixel"
