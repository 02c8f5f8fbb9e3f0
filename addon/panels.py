"""Glanz's own panels in the Properties editor."""

import bpy

from . import backend, passes
from .preferences import paragraph
from .presets import GLANZ_PT_sampling_presets


class GlanzPanel:
    """Shared by all panels: where they are, and that they belong to Glanz.

    about  the member of the context that a panel is about, which is shown only where there is one; empty: none
    """

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "render"
    COMPAT_ENGINES = frozenset({"GLANZ"})
    about = ""

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES and not (cls.about and getattr(context, cls.about) is None)

    def column(self):
        """A column of the layout in Blender's usual style: names left, values right."""
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        return self.layout.column()


class GLANZ_CAMERA_PT_panorama(GlanzPanel, bpy.types.Panel):
    """Blender shows these settings for Cycles only."""

    bl_label = "Panorama"
    bl_context = "data"
    about = "camera"

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.camera.type == "PANO"

    def draw(self, context):
        camera = context.camera
        owner = camera if hasattr(camera, "panorama_type") else getattr(camera, "cycles", None)
        column = self.column()
        if not hasattr(owner, "panorama_type"):
            column.label(text="Without Cycles: the full sphere")
            return
        column.prop(owner, "panorama_type")
        for name in ("latitude_min", "latitude_max", "longitude_min", "longitude_max"):
            column.prop(owner, name)


class GLANZ_RENDER_PT_problem(GlanzPanel, bpy.types.Panel):
    """Shown instead of a traceback where the engine cannot be loaded."""

    bl_label = "Glanz Cannot Render"
    bl_order = 0

    @classmethod
    def poll(cls, context):
        return super().poll(context) and bool(backend.problem())

    def draw(self, context):
        paragraph(self.layout, context, backend.problem())


class GLANZ_RENDER_PT_sampling(GlanzPanel, bpy.types.Panel):
    bl_label = "Sampling"

    def draw_header_preset(self, context):
        GLANZ_PT_sampling_presets.draw_panel_header(self.layout)

    def draw(self, context):
        settings = context.scene.glanz
        column = self.column()
        column.prop(settings, "integrator")
        column.prop(settings, "samples")
        rounds = column.column()
        # Where pixels are divided the end is known.
        rounds.active = settings.adaptive_threshold == 0
        rounds.prop(settings, "error_target")
        target = rounds.column()
        target.active = settings.error_target > 0
        target.prop(settings, "error_measure")
        target.prop(settings, "adaptive_sampling")
        rounds.prop(settings, "time_limit")
        column.prop(settings, "replicates")
        column.prop(settings, "sampler")
        column.prop(settings, "seed")
        column.prop(settings, "adaptive_threshold")
        row = column.row()
        row.active = settings.adaptive_threshold > 0
        row.prop(settings, "adaptive_levels")


class GLANZ_RENDER_PT_viewport(GlanzPanel, bpy.types.Panel):
    """Of rendered 3D views."""

    bl_label = "Viewport"

    def draw(self, context):
        column = self.column()
        column.prop(context.scene.glanz, "viewport_samples", text="Samples")
        column.prop(context.scene.render, "preview_pixel_size")


class GLANZ_RENDER_PT_light_paths(GlanzPanel, bpy.types.Panel):
    bl_label = "Light Paths"

    def draw(self, context):
        settings = context.scene.glanz
        column = self.column()
        column.prop(settings, "max_depth")
        column.prop(settings, "max_transparent")
        for name, integrators in _OF_INTEGRATORS.items():
            if settings.integrator in integrators:
                column.prop(settings, name)
        clamps = self.column()
        clamps.prop(settings, "clamp_direct")
        clamps.prop(settings, "clamp_indirect")


_OF_INTEGRATORS = {
    "branches": ("distributed",),
    "min_contribution": ("whitted", "whitted_phong", "distributed"),
    "light_falloff": ("whitted_phong",),
}
"""Settings that only some integrators know."""


class GLANZ_RENDER_PT_film(GlanzPanel, bpy.types.Panel):
    bl_label = "Film"

    def draw(self, context):
        settings = context.scene.glanz
        column = self.column()
        column.prop(settings, "pixel_filter")
        row = column.row()
        # The box filter has but one width.
        row.active = settings.pixel_filter != "box"
        row.prop(settings, "filter_width")
        column.prop(settings, "filter_textures")
        column.prop(context.scene.render, "film_transparent")


class GLANZ_RENDER_PT_motion_blur(GlanzPanel, bpy.types.Panel):
    """Blender shows its own for Cycles and EEVEE only."""

    bl_label = "Motion Blur"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        render = context.scene.render
        column = self.column()
        column.active = render.use_motion_blur
        owner = render if hasattr(render, "motion_blur_position") else getattr(context.scene, "cycles", None)
        if hasattr(owner, "motion_blur_position"):
            column.prop(owner, "motion_blur_position", text="Position")
        column.prop(render, "motion_blur_shutter", text="Shutter")
        column.prop(context.scene.glanz, "motion_steps")


class GLANZ_OBJECT_PT_motion_blur(GlanzPanel, bpy.types.Panel):
    """What Cycles stores with each object; Blender shows it for Cycles only."""

    bl_label = "Motion Blur"
    bl_context = about = "object"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    @classmethod
    def poll(cls, context):
        is_blurred = super().poll(context) and context.object.type in _BLURRED
        return is_blurred and hasattr(getattr(context.object, "cycles", None), "use_motion_blur")

    def draw_header(self, context):
        self.layout.active = context.scene.render.use_motion_blur
        self.layout.prop(context.object.cycles, "use_motion_blur", text="")

    def draw(self, context):
        own = context.object.cycles
        column = self.column()
        column.active = context.scene.render.use_motion_blur and own.use_motion_blur
        column.prop(own, "motion_steps")
        if context.object.type != "CAMERA":
            column.prop(own, "use_deform_motion")


_BLURRED = frozenset({"MESH", "CURVE", "SURFACE", "FONT", "META", "CAMERA", "EMPTY"})


class GLANZ_OBJECT_PT_ray_visibility(GlanzPanel, bpy.types.Panel):
    """Blender shows these for Cycles only."""

    bl_label = "Ray Visibility"
    bl_context = about = "object"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.object.type in _SEEN

    def draw(self, context):
        column, is_light = self.column(), context.object.type == "LIGHT"
        for kind in ("camera", "diffuse", "glossy", "transmission", *(() if is_light else ("shadow",))):
            column.prop(context.object, f"visible_{kind}", text=kind.title())
        if not is_light:
            column.prop(context.object, "is_holdout")


_SEEN = frozenset({"MESH", "CURVE", "SURFACE", "FONT", "META", "EMPTY", "LIGHT"})


class GLANZ_WORLD_PT_ray_visibility(GlanzPanel, bpy.types.Panel):
    """What Cycles stores with each world; Blender shows it for Cycles only."""

    bl_label = "Ray Visibility"
    bl_context = about = "world"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    @classmethod
    def poll(cls, context):
        return super().poll(context) and hasattr(context.world, "cycles_visibility")

    def draw(self, context):
        column = self.column()
        for kind in ("camera", "diffuse", "glossy", "transmission"):
            column.prop(context.world.cycles_visibility, kind)


class GLANZ_RENDER_PT_performance(GlanzPanel, bpy.types.Panel):
    bl_label = "Performance"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        render = context.scene.render
        column = self.column()
        column.prop(render, "threads_mode")
        row = column.row()
        row.enabled = render.threads_mode == "FIXED"
        row.prop(render, "threads")
        column.prop(context.scene.glanz, "precision")
        column.prop(render, "use_persistent_data", text="Persistent Data")
        column.prop(context.scene.glanz, "progress")
        column.prop(context.scene.glanz, "tile_size")
        column.prop(context.scene.glanz, "checkpoint")
        row = column.row()
        row.active = bool(context.scene.glanz.checkpoint)
        row.prop(context.scene.glanz, "checkpoint_seconds")


class GLANZ_VIEWLAYER_PT_passes(GlanzPanel, bpy.types.Panel):
    bl_label = "Passes"
    bl_context = "view_layer"

    def draw(self, context):
        column = self.column()
        for owner, name in passes.switches(context.view_layer):
            column.prop(owner, name)


class GLANZ_VIEWLAYER_PT_override(GlanzPanel, bpy.types.Panel):
    bl_label = "Override"
    bl_context = "view_layer"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        column = self.column()
        for name in ("material_override", "world_override", "samples"):
            if hasattr(context.view_layer, name):
                column.prop(context.view_layer, name)


class GLANZ_WORLD_PT_preview(GlanzPanel, bpy.types.Panel):
    """Blender has one for Cycles only."""

    bl_label = "Preview"
    bl_context = about = "world"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        self.layout.template_preview(context.world)


class GLANZ_MATERIAL_PT_lecture(GlanzPanel, bpy.types.Panel):
    """The lecture's parameters, in place of the material's nodes."""

    bl_label = "Lecture Material"
    bl_context = about = "material"

    def draw_header(self, context):
        self.layout.prop(context.material.glanz, "use_lecture", text="")

    def draw(self, context):
        settings = context.material.glanz
        column = self.column()
        column.active = settings.use_lecture
        for name in ("k_a", "k_d", "k_s", "exponent", "normalisation", "k_r", "k_t"):
            column.prop(settings, name)
        if any(settings.k_t):
            column.separator()
            column.prop(settings, "is_sheet")
            for name in ("sheet_exponent",) if settings.is_sheet else ("ior", "absorption_colour", "absorption_distance"):
                column.prop(settings, name)
            if not settings.is_sheet:
                column.label(text="Overlap and dispersion: see Medium")


class GLANZ_MATERIAL_PT_medium(GlanzPanel, bpy.types.Panel):
    """What is inside of objects that wear the material, beside the volume of its nodes."""

    bl_label = "Medium"
    bl_context = about = "material"
    bl_options = frozenset({"DEFAULT_CLOSED"})

    def draw(self, context):
        column = self.column()
        for name in ("priority", "abbe"):
            column.prop(context.material.glanz, name)


_CLASSES = (
    GLANZ_CAMERA_PT_panorama,
    GLANZ_RENDER_PT_problem,
    GLANZ_RENDER_PT_sampling,
    GLANZ_RENDER_PT_viewport,
    GLANZ_RENDER_PT_light_paths,
    GLANZ_RENDER_PT_film,
    GLANZ_RENDER_PT_motion_blur,
    GLANZ_OBJECT_PT_motion_blur,
    GLANZ_OBJECT_PT_ray_visibility,
    GLANZ_WORLD_PT_ray_visibility,
    GLANZ_RENDER_PT_performance,
    GLANZ_WORLD_PT_preview,
    GLANZ_MATERIAL_PT_lecture,
    GLANZ_MATERIAL_PT_medium,
    GLANZ_VIEWLAYER_PT_passes,
    GLANZ_VIEWLAYER_PT_override,
)

register, unregister = bpy.utils.register_classes_factory(_CLASSES)
