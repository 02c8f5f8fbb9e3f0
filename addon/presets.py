"""Sets of settings for common purposes, in the header of the Sampling panel: Glanz's own, and those that users add.

Glanz's own are a table, which says what each costs. Those of users are Blender's presets: Python files in their folder
scripts/presets/glanz that Blender executes, so that none ever comes out of a .blend file.
"""

from dataclasses import dataclass

import bpy
from bl_operators.presets import AddPresetBase
from bl_ui.utils import PresetPanel
from bpy.props import EnumProperty

from . import backend


@dataclass(frozen=True)
class Over:
    """How many times that of another preset something is: the median over sample scenes, and the least and the most of them."""

    median: float
    least: float
    most: float

    def inverse(self):
        """How many times this the other's is."""
        return Over(1 / self.median, 1 / self.most, 1 / self.least)

    def of(self, whole):
        """As words: "1/7 of WHOLE (1/8 to 1/6)", "2.9 times WHOLE (2.3 to 5)"."""
        times = "of" if self.median < 1 else "times"
        return f"{_ratio(self.median)} {times} {whole} ({_ratio(self.least)} to {_ratio(self.most)})"


def _ratio(value):
    """As people say it, to 5 %: 1/7, 0.7, 2.9, 11."""
    parts = round(1 / value)
    if parts > 1 and abs(parts * value - 1) < 0.05:
        return f"1/{parts}"
    return f"{value:.2g}"


TIME = {
    "PREVIEW": Over(1 / 9, 1 / 11, 0.18),
    "FINAL": Over(7.8, 4.5, 9.5),
    "WHITTED": Over(1 / 12, 0.019, 0.7),
    "DISTRIBUTED": Over(1.1, 1 / 12, 2.6),
}
"""Of presets, relative to Balanced; this and the following as measured by `python -m benchmarks.presets`, see docs/presets.md."""
ERROR = {
    "PREVIEW": Over(3.3, 2.6, 8.4),
    "FINAL": Over(1 / 3, 0.23, 0.62),
}
"""Noise and bias of few bounces together."""
NOISE = {
    "WHITTED": Over(2, 0.056, 8.7),
    "DISTRIBUTED": Over(4.8, 0.73, 22),
}
"""Of presets whose light is not all that there is: what they leave out is meant, and no error of theirs."""


@dataclass(frozen=True)
class Preset:
    """What `scene.glanz` becomes; `cost` tells users when to take it, and how long it takes for how much error."""

    label: str
    cost: str
    settings: dict


def _settings(**changes):
    """Every preset says all of these, so that it does not matter what was before."""
    defaults = {
        "integrator": "path",
        "max_depth": 8,
        "sampler": "sobol",
        "error_target": 0.0,
        "error_measure": "relative",
        "adaptive_sampling": True,
        "time_limit": 0.0,
        "replicates": 0,
        "adaptive_threshold": 0.0,
        "adaptive_levels": 3,
        "branches": 16,
        "min_contribution": 0.0,
        "light_falloff": True,
        "clamp_direct": 0.0,
        "clamp_indirect": 0.0,
    }
    return defaults | changes


PRESETS = {
    "PREVIEW": Preset(
        "Preview",
        "To see whether light and materials are about right: 16 paths per pixel, up to 4 bounces, so interiors and glass are darker "
        "than they will be. "
        f"Takes {TIME['PREVIEW'].of('the time of Balanced')} for {ERROR['PREVIEW'].of('the error')}, on sample scenes",
        _settings(samples=16, max_depth=4),
    ),
    "BALANCED": Preset(
        "Balanced",
        "For most pictures: 128 paths per pixel, up to 8 bounces; twice the time of the settings that new files have. "
        f"Takes {TIME['PREVIEW'].inverse().of('the time of Preview')} for {ERROR['PREVIEW'].inverse().of('the error')}, "
        "on sample scenes",
        _settings(samples=128),
    ),
    "FINAL": Preset(
        "Final",
        "For what will be looked at closely: 1024 paths per pixel, up to 16 bounces. "
        f"Takes {TIME['FINAL'].of('the time of Balanced')} for {ERROR['FINAL'].of('the error')}, on sample scenes",
        _settings(samples=1024, max_depth=16),
    ),
    "WHITTED": Preset(
        "Lecture: Whitted",
        "Recursive ray tracing as of 1980: hard shadows, mirrors and glass, Phong's illumination model, no light from surface to surface. "
        "Pixels are divided where colours differ, in up to 16 parts. "
        f"Takes {TIME['WHITTED'].of('the time of Balanced')} with {NOISE['WHITTED'].of('the noise')}, on sample scenes",
        _settings(integrator="whitted_phong", samples=1, max_depth=6, min_contribution=0.01, adaptive_threshold=0.1, adaptive_levels=2),
    ),
    "DISTRIBUTED": Preset(
        "Lecture: Distributed",
        "Distributed ray tracing as of 1984: soft shadows, dull mirrors and indirect light by splitting each of 4 rays per pixel in 16; "
        "light of more than 3 bounces is left out. "
        f"Takes {TIME['DISTRIBUTED'].of('the time of Balanced')} with {NOISE['DISTRIBUTED'].of('the noise')}, on sample scenes",
        _settings(integrator="distributed", samples=4, max_depth=3, min_contribution=0.01),
    ),
}


class _NeedsEngine:
    """Without the engine there are no integrators to choose from."""

    @classmethod
    def poll(cls, context):
        return context.engine == "GLANZ" and backend.engine() is not None


class GLANZ_OT_sampling_preset(_NeedsEngine, bpy.types.Operator):
    """Set how Glanz samples this scene"""

    bl_idname = "glanz.sampling_preset"
    bl_label = "Sampling Preset"
    bl_options = frozenset({"REGISTER", "UNDO"})

    preset: EnumProperty(name="Preset", items=[(key, preset.label, preset.cost) for key, preset in PRESETS.items()], default="BALANCED")

    @classmethod
    def description(cls, context, properties):
        """The tooltip of each of its buttons."""
        return PRESETS[properties.preset].cost

    def execute(self, context):
        for name, value in PRESETS[self.preset].settings.items():
            setattr(context.scene.glanz, name, value)
        return {"FINISHED"}


class GLANZ_OT_sampling_preset_add(_NeedsEngine, AddPresetBase, bpy.types.Operator):
    """Add what now is set in Sampling and Light Paths as a preset of yours, or remove one"""

    bl_idname = "glanz.sampling_preset_add"
    bl_label = "Add Sampling Preset"
    preset_menu = "GLANZ_PT_sampling_presets"
    preset_subdir = "glanz"
    preset_defines = ("glanz = bpy.context.scene.glanz",)
    preset_values = tuple(f"glanz.{name}" for name in PRESETS["BALANCED"].settings)

    def execute(self, context):
        """Blender refuses names of other files; those of Glanz's own presets are none of files."""
        own = {self.as_filename(preset.label).lower() for preset in PRESETS.values()}
        if not self.remove_name and self.as_filename(self.name).lower() in own:
            self.report({"WARNING"}, f'Glanz has a preset "{self.name}" of its own: give this one another name')
            return {"CANCELLED"}
        return super().execute(context)


class GLANZ_PT_sampling_presets(PresetPanel, bpy.types.Panel):
    bl_label = "Sampling Presets"
    preset_subdir = "glanz"
    preset_operator = "script.execute_preset"
    preset_add_operator = GLANZ_OT_sampling_preset_add.bl_idname

    def draw(self, context):
        self.layout.emboss = "PULLDOWN_MENU"
        column = self.layout.column(align=True)
        for key, preset in PRESETS.items():
            column.operator(GLANZ_OT_sampling_preset.bl_idname, text=preset.label).preset = key
        self.layout.separator()
        if bpy.utils.preset_paths(self.preset_subdir):
            PresetPanel.draw(self, context)
            return
        # Before the first one Blender would complain of a missing folder.
        row = self.layout.row()
        field = row.row()
        field.emboss = "NORMAL"
        field.prop(context.window_manager, "preset_name", text="")
        row.operator(self.preset_add_operator, text="", icon="ADD").name = context.window_manager.preset_name

    @staticmethod
    def post_cb(context, filepath):
        """Blender executes a preset without a step of its own in its undo."""
        bpy.ops.ed.undo_push(message="Sampling Preset")


_CLASSES = (GLANZ_OT_sampling_preset, GLANZ_OT_sampling_preset_add, GLANZ_PT_sampling_presets)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
