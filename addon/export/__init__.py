"""From Blender's evaluated scene to the engine's values: reads, and edits nothing of the user's."""

from .findings import Findings
from .kept import Kept
from .scene import export_contents, export_scene, export_still, export_views
from .stamps import stamp_of

__all__ = ["Findings", "Kept", "export_contents", "export_scene", "export_still", "export_views", "stamp_of"]
