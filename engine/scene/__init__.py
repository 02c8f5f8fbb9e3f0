"""Immutable scene values: what a user hands to the renderer."""

from .bitmap import Bitmap
from .coordinates import Coordinates
from .environment import EnvironmentMap
from .lens import Lens
from .medium import Medium
from .mist import Mist
from .settings import Settings
from .shade import Shade
from .values import Material, Mesh, MeshAttribute, Object, Scene, World

__all__ = [
    "Bitmap",
    "Coordinates",
    "EnvironmentMap",
    "Lens",
    "Material",
    "Medium",
    "Mesh",
    "MeshAttribute",
    "Mist",
    "Object",
    "Scene",
    "Settings",
    "Shade",
    "World",
]
