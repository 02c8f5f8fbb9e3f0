"""Blender's side of the engine's render passes: the one table that knows it.

The engine's registry says which passes there are and which channels they have; this table adds what only Blender
asks for. A pass of the engine that has no row here is not offered in Blender.
"""

from dataclasses import dataclass

from . import backend


@dataclass(frozen=True)
class BlenderPass:
    """How Blender knows a pass.

    kind      Blender's channel type
    flag      the property of the view layer that switches it on, by its path; empty: always on
    before_5  its name before Blender 5.0; empty: the same. The engine has the names of today
    """

    kind: str
    flag: str = ""
    before_5: str = ""


TABLE = {
    # Blender makes room for Combined whether it is asked for or not, so it is always rendered, as Cycles does.
    "Combined": BlenderPass("COLOR"),
    "Depth": BlenderPass("VALUE", "use_pass_z"),
    "Normal": BlenderPass("VECTOR", "use_pass_normal"),
    "Position": BlenderPass("VECTOR", "use_pass_position"),
    "Mist": BlenderPass("VALUE", "use_pass_mist"),
    "UV": BlenderPass("VECTOR", "use_pass_uv"),
    "Object Index": BlenderPass("VALUE", "use_pass_object_index", "IndexOB"),
    "Material Index": BlenderPass("VALUE", "use_pass_material_index", "IndexMA"),
    "Vector": BlenderPass("VECTOR", "use_pass_vector"),
    "Diffuse Direct": BlenderPass("COLOR", "use_pass_diffuse_direct", "DiffDir"),
    "Diffuse Indirect": BlenderPass("COLOR", "use_pass_diffuse_indirect", "DiffInd"),
    "Diffuse Color": BlenderPass("COLOR", "use_pass_diffuse_color", "DiffCol"),
    "Glossy Direct": BlenderPass("COLOR", "use_pass_glossy_direct", "GlossDir"),
    "Glossy Indirect": BlenderPass("COLOR", "use_pass_glossy_indirect", "GlossInd"),
    "Glossy Color": BlenderPass("COLOR", "use_pass_glossy_color", "GlossCol"),
    "Transmission Direct": BlenderPass("COLOR", "use_pass_transmission_direct", "TransDir"),
    "Transmission Indirect": BlenderPass("COLOR", "use_pass_transmission_indirect", "TransInd"),
    "Transmission Color": BlenderPass("COLOR", "use_pass_transmission_color", "TransCol"),
    "Emission": BlenderPass("COLOR", "use_pass_emit", "Emit"),
    "Environment": BlenderPass("COLOR", "use_pass_environment", "Env"),
    "Shadow": BlenderPass("COLOR", "use_pass_shadow"),
    "Ambient Occlusion": BlenderPass("COLOR", "use_pass_ambient_occlusion", "AO"),
    # Cycles' own switch, as the compositor's Denoise node is fed alike whichever has rendered.
    "Denoising Albedo": BlenderPass("COLOR", "cycles.denoising_store_passes"),
    "Denoising Normal": BlenderPass("VECTOR", "cycles.denoising_store_passes"),
    "Denoising Depth": BlenderPass("VALUE", "cycles.denoising_store_passes"),
    "Standard Error": BlenderPass("COLOR", "glanz.use_pass_standard_error"),
    "Confidence": BlenderPass("COLOR", "glanz.use_pass_confidence"),
    "Sample Count": BlenderPass("VALUE", "glanz.use_pass_sample_count"),
}


def offered():
    """{key: (pass class of the engine, BlenderPass)} of the table's passes that the engine knows; empty without the engine."""
    engine = backend.engine()
    registry = engine.PASSES if engine else {}
    return {key: (registry[key], row) for key, row in TABLE.items() if key in registry}


def chosen(view_layer, scene):
    """Keys of the passes that are switched on in a `view_layer` of `scene`; Combined always is."""
    of_table = (key for key, (_, row) in offered().items() if not row.flag or getattr(*switch(view_layer, row.flag), False))
    if scene.render.use_motion_blur:
        # As in Cycles: what is blurred is not blurred again.
        of_table = (key for key in of_table if key != "Vector")
    return (*of_table, *(key for family in FAMILIES for key in family(view_layer)))


def _cryptomattes(view_layer):
    levels = range((view_layer.pass_cryptomatte_depth + 1) // 2)
    kinds = [kind for kind in ("Object", "Material", "Asset") if getattr(view_layer, f"use_pass_cryptomatte_{kind.lower()}")]
    return [f"Crypto{kind}{level:02}" for kind in kinds for level in levels]


def _light_groups(view_layer):
    return [f"Combined_{group.name}" for group in view_layer.lightgroups]


def _aovs(view_layer):
    return [f"AOV {aov.type.title()} {aov.name}" for aov in view_layer.aovs if aov.is_valid]


FAMILIES = (_cryptomattes, _aovs, _light_groups)
"""Functions that say which passes of the engine's families are switched on in a view layer."""


def name_of(key):
    """What this version of Blender calls a pass of the engine."""
    # Not above: the command line knows this module where there is no Blender.
    import bpy

    if key.startswith("AOV "):
        return key.split(" ", 2)[2]
    row = TABLE.get(key, BlenderPass("COLOR"))
    return row.before_5 if row.before_5 and bpy.app.version < (5, 0) else key


def switch(view_layer, flag):
    """(owner, name) of the property that is meant by a `flag` of the table; no owner where it is of an add-on that is off."""
    path, _, name = flag.rpartition(".")
    return (getattr(view_layer, path, None) if path else view_layer), name


def switches(view_layer):
    """(owner, name) of all properties that switch passes on, each once."""
    flags = dict.fromkeys(row.flag for _, row in offered().values() if row.flag)
    return [found for found in (switch(view_layer, flag) for flag in flags) if hasattr(*found)]


def attributes(keys):
    """What the passes `keys` of the engine ask of meshes and objects, keys as materials have them."""
    registry = backend.engine().PASSES
    return frozenset(asked for key in keys for asked in getattr(registry[key], "attributes", ()))


def aovs(keys):
    """(kind, name) of each AOV among the passes `keys` of the engine."""
    return frozenset(tuple(key.split(" ", 2)[1:]) for key in keys if key.startswith("AOV "))


def register_passes(engine, scene, view_layer):
    """Tell Blender which passes `view_layer` will get, so that files and the compositor make room for them."""
    for key in chosen(view_layer, scene) if backend.engine() else ():
        plugin = backend.engine().PASSES[key]
        kind = TABLE[key].kind if key in TABLE else "VALUE" if len(plugin.channels) == 1 else "COLOR"
        engine.register_pass(scene, view_layer, name_of(key), len(plugin.channels), plugin.channels, kind)
