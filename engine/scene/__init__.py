"""Immutable scene values: what a user hands to the renderer."""

from .settings import Settings
from .values import Material, Mesh, Object, Scene, World

__all__ = ["Material", "Mesh", "Object", "Scene", "Settings", "World"]
