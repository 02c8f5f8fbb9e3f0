"""From Blender's evaluated scene to the engine's values: reads, and edits nothing of the user's."""

from .scene import export_scene, export_views

__all__ = ["export_scene", "export_views"]
