"""The settings of Glanz that a .blend file stores: `scene.glanz`, and `view_layer.glanz`."""

import zlib
from functools import cache

import bpy
from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, PointerProperty, StringProperty

from . import backend


def stored_number(key):
    """The number under which files remember a choice: of its own, so that more plug-ins do not change old files."""
    return zlib.crc32(key.encode()) & 0x7FFFFFFF


def renew(settings, context):
    """An `update` for settings of data-blocks: Blender evaluates them anew also where a script sets them, which else nobody tells."""
    settings.id_data.update_tag()


@cache
def enum_items(registry_name):
    """Items for a choice among the plug-ins of an engine registry; kept, for Blender does not own their strings."""
    engine = backend.engine()
    registry = getattr(engine, registry_name) if engine else {}
    return [(key, plugin.label, _first_line(plugin), "NONE", stored_number(key)) for key, plugin in registry.items()]


def _first_line(plugin):
    # Blender ends tooltips with a full stop of its own.
    return plugin.__doc__.strip().splitlines()[0].rstrip(".")


class GlanzSceneSettings(bpy.types.PropertyGroup):
    """How Glanz renders this scene; names, units and meaning are those of the engine's `Settings`."""

    integrator: EnumProperty(
        name="Integrator",
        description="How light is followed through the scene: which effects there are, and what they cost in time and noise",
        # A function, so that registering Glanz does not load the engine; its default is the stored number.
        items=lambda self, context: enum_items("INTEGRATORS"),
        default=stored_number("path"),
    )
    samples: IntProperty(
        name="Samples",
        description="Paths per pixel. Render time grows in proportion; noise halves with four times as many",
        default=64,
        min=1,
        soft_max=4096,
        max=2**24,
    )
    viewport_samples: IntProperty(
        name="Viewport Samples",
        description=(
            "Paths per pixel in rendered 3D views, after which they rest; 0 goes on until something changes. "
            "The first picture comes as soon with any number; time grows in proportion, noise halves with four times as many"
        ),
        default=32,
        min=0,
        soft_max=1024,
        max=2**16,
    )
    max_depth: IntProperty(
        name="Max Depth",
        description=(
            "Bounces after which light is no longer followed; 0 is direct light only. "
            "Too few make interiors too dark; more cost time only where light gets that far"
        ),
        default=8,
        min=0,
        soft_max=64,
        max=2**16,
    )
    max_transparent: IntProperty(
        name="Max Transparent",
        description=(
            "Transparent surfaces that light passes between two bounces; the next one absorbs what it should let pass. "
            "Too few make leaves and veils that stand behind each other too dark; more cost time only where there are as many"
        ),
        default=64,
        min=0,
        soft_max=256,
        max=1024,
    )
    branches: IntProperty(
        name="Branches",
        description=(
            "Distributed ray tracing: rays that every ray splits into at the first hit, a quarter of them at each further one. "
            "Noise halves with four times as many; time grows in proportion"
        ),
        default=16,
        min=1,
        soft_max=256,
        max=2**12,
    )
    min_contribution: FloatProperty(
        name="Min Contribution",
        description=(
            "Whitted's and distributed ray tracing: what a ray must count at least in its pixel to be followed, from 0 to 1. "
            "0 follows all up to the greatest depth; 0.01 takes less time and loses at most a hundredth of the light at a mirror or glass"
        ),
        default=0.0,
        min=0.0,
        max=1.0,
        precision=4,
    )
    light_falloff: BoolProperty(
        name="Light Falloff",
        description=(
            "Phong illumination: light falls off with the square of the distance, as in nature. "
            "Off: every light is as bright everywhere as it is at a distance of one metre. Costs no time"
        ),
        default=True,
    )
    clamp_direct: FloatProperty(
        name="Clamp Direct",
        description=(
            "Radiance in W/(m\u00b2 sr) that light may have at most which is seen itself or sent on by one surface: brighter light is "
            "scaled down to it. Fewer bright specks for a picture that is too dark; how much light that takes away is told at the end. "
            "0 is no limit. Costs no time"
        ),
        default=0.0,
        min=0.0,
        soft_max=100.0,
        max=1e30,
    )
    clamp_indirect: FloatProperty(
        name="Clamp Indirect",
        description=(
            "Radiance in W/(m\u00b2 sr) that light may have at most which two surfaces or more have sent on, one path and light at a time: "
            "10 takes most of the bright specks of caustics away, and their light. How much of all light that is, is told at the end. "
            "0 is no limit. Costs no time"
        ),
        default=0.0,
        min=0.0,
        soft_max=100.0,
        max=1e30,
    )
    seed: IntProperty(
        name="Seed",
        description="Another number gives other noise of the same amount in the same time; the same number gives the same picture",
        default=0,
    )
    sampler: EnumProperty(
        name="Sampler",
        description="How random numbers are spread: better spread is less noise in the same time",
        items=lambda self, context: enum_items("SAMPLERS"),
        default=stored_number("sobol"),
    )
    pixel_filter: EnumProperty(
        name="Pixel Filter",
        description="How light around a pixel counts for it: sharpness against jagged edges. Costs no time",
        items=lambda self, context: enum_items("FILTERS"),
        default=stored_number("blackman_harris"),
    )
    filter_width: FloatProperty(
        name="Filter Width",
        description="Full width of the pixel filter, in pixels: wider is softer. The box filter is always one pixel wide. Costs no time",
        default=1.5,
        min=0.01,
        soft_max=4.0,
        max=10.0,
        subtype="PIXEL",
    )
    filter_textures: BoolProperty(
        name="Filter Textures",
        description=(
            "Textures are averaged over the part of the picture that a ray stands for, so that fine patterns do not alias. "
            "It takes twice the time or more where there is hardly anything but textures, else little more. "
            "Off: they are looked up at points, as the lecture's zone plate is; only more samples or a wider pixel filter help then"
        ),
        default=True,
    )
    error_target: FloatProperty(
        name="Error Target",
        description=(
            "Rendering ends where the standard error of the picture, relative to its mean brightness, is this small, with Samples at the "
            "latest: 0.01 is 1 %. 0 is none. Half of it takes up to four times the time. The samples are in a dozen independent sets then, "
            "which for the same noise takes from hardly any more time to, in soft shadows of few samples, more than twice as much. "
            "Keeps all tiles until the end: 0.2 GB of memory for a million pixels"
        ),
        default=0.0,
        min=0.0,
        soft_max=1.0,
        max=1e6,
        precision=4,
        step=1,
    )
    error_measure: EnumProperty(
        name="Measure",
        description="What Error Target is an error of. The error itself costs no time to measure",
        items=(
            (
                "relative",
                "Relative",
                "Of radiance, relative to the mean radiance of the picture: 0.01 is 1 % of it, in dark as in bright parts",
            ),
            (
                "lightness",
                "Lightness",
                "Of what eyes see: CIE lightness as a share of that of white, which is radiance 1. 0.01 is one of 100 steps from black "
                "to white, about the least that is seen side by side. Noise in dark parts counts for more. It does not know the exposure",
            ),
        ),
        default="relative",
    )
    adaptive_sampling: BoolProperty(
        name="Adaptive",
        description=(
            "An error target is reached with more samples where they lower the error more, up to Samples in a pixel, and with fewer "
            "elsewhere. It begins when every pixel has 128 samples. Off: all have as many, which takes more time where noise is uneven"
        ),
        default=True,
    )
    time_limit: FloatProperty(
        name="Time Limit",
        description=(
            "Rendering ends after this time, in seconds from when the scene is ready, though not before every pixel has a sample. "
            "0 is none. The picture has the noise of as many samples as there was time for. "
            "Keeps all tiles until the end: 0.06 GB of memory for a million pixels"
        ),
        default=0.0,
        min=0.0,
        soft_max=3600.0,
        max=1e9,
        subtype="TIME_ABSOLUTE",
        unit="TIME_ABSOLUTE",
    )
    replicates: IntProperty(
        name="Replicates",
        description=(
            "Sets that the samples of a pixel are divided into, each with random numbers of its own. What they differ by tells the error "
            "of the picture, which files state. 1: none is known. 0: 8 where Error Target or a pass asks for it, else 1. "
            "They do not complement each other: for the same noise, 2 take up to twice the time, and 8 from hardly any more to, "
            "in soft shadows of few samples, three to four times as much"
        ),
        default=0,
        min=0,
        soft_max=64,
        max=2**12,
    )
    adaptive_threshold: FloatProperty(
        name="Adaptive Threshold",
        description=(
            "Pixels are divided in four, each part with as many samples as a pixel, where colours differ by more than this: "
            "0.1 is a tenth of white as displays show it. 0 divides none. Less is smoother edges and more time; "
            "noise is divided too unless the samples keep it below"
        ),
        default=0.0,
        min=0.0,
        max=1.0,
        precision=3,
        step=1,
    )
    adaptive_levels: IntProperty(
        name="Adaptive Levels",
        description="How often pixels may be divided: 3 are 8 by 8 parts at most. Each more takes twice the time at edges",
        default=3,
        min=1,
        max=6,
    )
    strict: BoolProperty(
        name="Strict",
        description=(
            "What Glanz would leave out, and images, node groups and libraries that are missing, are errors before rendering, "
            "all in one list. Off: they are warnings, as is always what is rendered approximately. Costs no time"
        ),
        default=False,
    )
    precision: EnumProperty(
        name="Precision",
        description="What rays and light are computed in. Makes no difference to see in most scenes; noise is the same",
        items=(
            ("fast", "Fast", "Single precision: least time and memory. Lengths and light are known to about 1 in 10 million"),
            (
                "exact",
                "Exact",
                "Double precision, and where rays meet triangles is measured again: no self-hits at needle-shaped triangles, and lengths "
                "to 1 in 10 million million. Takes about a third more time, 50 bytes more for each triangle, "
                "and 20 MB for each thread",
            ),
        ),
        default="fast",
    )
    tile_size: IntProperty(
        name="Tile Size",
        description=(
            "Side of the tiles that appear as they finish, in pixels; 0 is the whole frame. "
            "Does not change the picture; very small tiles cost time"
        ),
        default=64,
        min=0,
        soft_max=512,
        max=65536,
        subtype="PIXEL",
    )
    progress: EnumProperty(
        name="Progress",
        description="What is seen while a picture is rendered. Does not change the picture, unless it is cancelled",
        items=(
            ("TILES", "Tiles", "Tile after tile appears with all of its samples: least memory and least time"),
            (
                "FRAME",
                "Whole Frame",
                "The whole picture appears at once, and refines with 1, 2, 4, 8, ... samples; cancelled, it is noisy but whole. "
                "Takes memory for the samples of the whole frame, and a tenth more time. "
                "Where pixels are divided, by Adaptive Threshold, there are tiles all the same",
            ),
        ),
        default="TILES",
    )
    checkpoint: StringProperty(
        name="Checkpoint",
        description=(
            "File in which F12 keeps what it has rendered so far, one for each frame, view layer and eye: after a crash, or after Esc, F12 "
            "goes on from it, to the same picture as in one go, unless something has changed. It is deleted when the picture is done. "
            "Empty: none. Takes memory for the samples of the picture, and a little time"
        ),
        default="",
        subtype="FILE_PATH",
    )
    checkpoint_seconds: FloatProperty(
        name="Every",
        description="About how often a checkpoint is written, in seconds: the time that a crash may cost",
        default=60.0,
        min=1.0,
        soft_max=3600.0,
        max=1e6,
        subtype="TIME_ABSOLUTE",
        unit="TIME_ABSOLUTE",
    )
    motion_steps: IntProperty(
        name="Deformation Steps",
        description=(
            "Shapes that a mesh which deforms takes while the shutter is open; what only moves is blurred without steps. "
            "More are smoother, and each takes the memory of the mesh, and the time to prepare it, once more"
        ),
        default=8,
        min=1,
        soft_max=64,
        max=1024,
    )


class GlanzViewLayerSettings(bpy.types.PropertyGroup):
    """What Glanz is asked for by a view layer, beside what Blender asks."""

    use_pass_standard_error: BoolProperty(
        name="Standard Error",
        description=(
            "Deliver the standard deviation of each pixel about what infinitely many samples would give, in its radiance. "
            "The samples are in 8 independent sets then, if Replicates says nothing else: for the same noise from hardly any more "
            "time to, in soft shadows of few samples, three to four times as much"
        ),
        default=False,
    )
    use_pass_confidence: BoolProperty(
        name="Confidence",
        description=(
            "Deliver half the width of the interval around each pixel that holds the truth in 95 of 100 cases, in its radiance. "
            "Takes the time that Standard Error takes; both together take it once"
        ),
        default=False,
    )
    use_pass_sample_count: BoolProperty(
        name="Sample Count",
        description="Deliver how many samples each pixel took; it differs between pixels with an adaptive threshold only. Costs no time",
        default=False,
    )


def register():
    bpy.utils.register_class(GlanzSceneSettings)
    bpy.utils.register_class(GlanzViewLayerSettings)
    bpy.types.Scene.glanz = PointerProperty(type=GlanzSceneSettings, name="Glanz", description="Settings of the render engine Glanz")
    bpy.types.ViewLayer.glanz = PointerProperty(type=GlanzViewLayerSettings, name="Glanz", description="Passes of the render engine Glanz")


def unregister():
    del bpy.types.ViewLayer.glanz
    del bpy.types.Scene.glanz
    bpy.utils.unregister_class(GlanzViewLayerSettings)
    bpy.utils.unregister_class(GlanzSceneSettings)
