"""Blender's own panels that make sense with Glanz.

Panels list the engines that they are drawn for. Those for 'BLENDER_RENDER' are meant for any engine, but for the ones
named here; of those for EEVEE a few are about the scene itself, not about EEVEE. Names that a version of Blender
lacks are skipped.
"""

import bpy

ENGINE = "GLANZ"

# What Glanz does not render, or shows in a panel of its own.
_EXCLUDED_PREFIXES = (
    "DATA_PT_light",
    "DATA_PT_context_lightprobe",
    "DATA_PT_spot",
    "DATA_PT_distance",
    "MATERIAL_PT_freestyle",
    "NODE_DATA_PT_light",
    "RENDER_PT_freestyle",
    "RENDER_PT_gpencil",
    "RENDER_PT_grease_pencil",
    "RENDER_PT_simplify_greasepencil",
    "TEXTURE_PT_preview",
    "VIEWLAYER_PT_freestyle",
)
# Prefixes above that would also hide panels about animation and the like.
_KEPT = ("DATA_PT_light_animation",)
_OF_EEVEE = (
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_MATERIAL_PT_surface",
    "EEVEE_MATERIAL_PT_volume",
    "EEVEE_WORLD_PT_surface",
    "MATERIAL_PT_preview",
)
_joined = []


def shared_panels():
    """The panel classes of this version of Blender that Glanz joins."""
    return [panel for panel in _subclasses(bpy.types.Panel) if _is_shared(panel.__name__, getattr(panel, "COMPAT_ENGINES", ()))]


def _subclasses(base):
    for panel in base.__subclasses__():
        yield panel
        yield from _subclasses(panel)


def _is_shared(name, engines):
    if name in _OF_EEVEE or name in _KEPT:
        return True
    return "BLENDER_RENDER" in engines and not name.startswith(_EXCLUDED_PREFIXES)


def register():
    for panel in shared_panels():
        panel.COMPAT_ENGINES.add(ENGINE)
        _joined.append(panel)


def unregister():
    while _joined:
        _joined.pop().COMPAT_ENGINES.discard(ENGINE)
