"""What a scene asks for, and which of its parts asks: a pure function of scene and settings."""

import math
from dataclasses import dataclass

from . import needs
from .interfaces import has_detail, is_straight, lets_shadow_rays_pass
from .registry import BSDFS, CAMERAS, FILTERS, INTEGRATORS, LIGHTS, PASSES, SAMPLERS
from .scene.bodies import inside_of, sharing_space
from .scene.graphs import is_texture, with_inner
from .scene.textured import averaged, material_textures, may_emit, may_hold_out, may_reflect


@dataclass(frozen=True)
class Requirements:
    """`needs`: {need: names of the objects, materials, lights or settings that ask for it}, in a fixed order.

    `in` asks whether something is needed; `str()` is a table for people, `as_dict()` for machines.
    """

    needs: dict

    @classmethod
    def of(cls, scene, settings):
        """The requirements of `scene` rendered with `settings`."""
        found = {}

        def ask(need, name):
            found.setdefault(need, {})[name] = True

        integrator = INTEGRATORS[settings.integrator]
        ask(needs.of_plugin("integrator", integrator), "settings")
        ask(needs.of_plugin("sampler", SAMPLERS[settings.sampler]), "settings")
        ask(needs.of_plugin("filter", FILTERS[settings.pixel_filter]), "settings")
        has_shadows = integrator.samples_lights or any(getattr(PASSES[key], "sends_shadow_rays", False) for key in settings.passes)
        for key in settings.passes:
            ask(needs.of_plugin("pass", PASSES[key]), "settings")
            if getattr(PASSES[key], "is_split", False):
                ask(needs.SPLIT_LIGHT, "settings")
        if settings.film_transparent:
            ask(needs.TRANSPARENT_FILM, "settings")
        if settings.adaptive_threshold:
            ask(needs.ADAPTIVE, "settings")
        for need in _needs_of(scene.camera):
            ask(need, scene.camera.name)
        inside = {o: inside_of(o) for o in scene.objects}
        for o in sharing_space([o for o in scene.objects if inside[o]]):
            ask(needs.NESTED_MEDIA, o.name)
        for material in dict.fromkeys(material for materials in inside.values() for material in materials):
            if material.medium is not None and any(material.medium.absorption):
                ask(needs.ABSORPTION, material.name)
            if any(getattr(lobe, "spread", 0) and may_reflect(lobe) for lobe in map(averaged, material.lobes)):
                ask(needs.DISPERSION, material.name)
        for o in scene.objects:
            if not o.mesh.triangles.shape[1]:
                continue
            ask(needs.GEOMETRY, o.name)
            if o.hidden_from:
                ask(needs.RAY_VISIBILITY, o.name)
            if not o.is_still:
                ask(needs.OBJECT_MOTION, o.name)
            if o.mesh.is_smooth:
                ask(needs.SMOOTH_NORMALS, o.name)
            for material in o.materials:
                if is_texture(material.alpha) or material.alpha < 1:
                    ask(needs.TRANSPARENCY, material.name)
                    if has_shadows:
                        ask(needs.TINTED_SHADOWS, material.name)
                for lobe in material.lobes:
                    if not may_reflect(lobe):
                        continue
                    ask(needs.of_plugin("bsdf", type(lobe)), material.name)
                    if is_straight(lobe) and not integrator.tints_glass:
                        ask(needs.TRANSPARENCY, material.name)
                    if has_shadows and lets_shadow_rays_pass(lobe, integrator.tints_glass):
                        ask(needs.TINTED_SHADOWS, material.name)
                if may_emit(material):
                    ask(needs.EMISSIVE_MESHES, o.name)
                if may_hold_out(material):
                    ask(needs.HOLDOUTS, material.name)
                if material.relief:
                    ask(needs.RELIEF, material.name)
                for texture in material_textures(material):
                    ask(needs.TEXTURES, material.name)
                    parts = with_inner(texture)
                    # Heights are compared as far apart as a ray is wide.
                    if any(getattr(part, "asks_for_width", settings.filter_textures and has_detail(part)) for part in parts):
                        ask(needs.FOOTPRINTS, material.name)
                    if any(getattr(part, "asks_for_past", False) for part in parts):
                        ask(needs.LIGHT_PATHS, material.name)
        shining = [light for light in scene.lights if any(light.power())]
        for light in shining:
            ask(needs.of_plugin("light", type(light)), light.name)
            if light.hidden_from:
                ask(needs.RAY_VISIBILITY, light.name)
            if light.shade is not None:
                ask(needs.TEXTURES, light.name)
            if light.has_extent():
                ask(needs.LIGHT_HITS, light.name)
        world = scene.world
        if world.hidden_from and (world.may_vary or any(world.radiance)):
            ask(needs.RAY_VISIBILITY, world.name)
        if not is_texture(world.radiance) and any(world.radiance):
            ask(needs.BACKGROUND, world.name)
        if world.may_vary:
            ask(needs.ENVIRONMENT, world.name)
        emitters = tuple(found.get(needs.EMISSIVE_MESHES, ()))
        sources = (*(light.name for light in shining), *found.get(needs.ENVIRONMENT, ()), *emitters)
        if len(sources) > 1 or emitters:
            for name in sources:
                ask(needs.LIGHT_CHOICE, name)
        return cls({need: tuple(names) for need, names in found.items()})

    def seen_from(self, camera):
        """The same with another camera."""
        own = {needs.LENS, needs.CLIP_RANGE, needs.CAMERA_MOTION, *(needs.of_plugin("camera", p) for p in CAMERAS.values())}
        rest = {need: names for need, names in self.needs.items() if need not in own}
        return Requirements(rest | dict.fromkeys(_needs_of(camera), (camera.name,)))

    @classmethod
    def everything(cls, scene, settings):
        """As if every feature were asked for: what an engine does that does not look first. For tests and benchmarks."""
        asked = dict(cls.of(scene, settings).needs)
        plugins = [("bsdf", p) for p in BSDFS.values()] + [("light", p) for p in LIGHTS.values()]
        # What settings forbid nobody can ask for.
        allowed = {needs.FOOTPRINTS: settings.filter_textures, needs.TRANSPARENT_FILM: settings.film_transparent}
        features = [need for need in needs.MEANING if allowed.get(need, True)]
        every = [*features, *(needs.of_plugin(kind, p) for kind, p in plugins)]
        return cls({**asked, **{need: asked.get(need, ("everything",)) for need in every}})

    def __contains__(self, need):
        return need in self.needs

    def plugins(self, kind):
        """The plug-in classes of `kind` ("bsdf", "light", ...) that are needed, in the order of their registry."""
        registry = {"bsdf": BSDFS, "light": LIGHTS, "pass": PASSES, "camera": CAMERAS}[kind]
        return tuple(plugin for plugin in registry.values() if needs.of_plugin(kind, plugin) in self)

    def as_dict(self):
        """{need: [names]}, ready for JSON."""
        return {need: list(names) for need, names in self.needs.items()}

    def in_words(self):
        """{feature, a text for people: [names]} of all but what settings ask for, which can be seen there."""
        return {_described(need): list(names) for need, names in self.needs.items() if set(names) != {"settings"}}

    def __str__(self):
        width = max(map(len, self.needs), default=0)
        return "\n".join(f"{need:<{width}}  {_shortened(names)}" for need, names in self.needs.items())


def _needs_of(camera):
    """What a camera asks for, all by itself."""
    return (
        needs.of_plugin("camera", type(camera)),
        *((needs.LENS,) if camera.lens.is_open else ()),
        *((needs.CLIP_RANGE,) if camera.clip_start != 0 or camera.clip_end < math.inf else ()),
        *((needs.CAMERA_MOTION,) if len(camera.motion) else ()),
    )


def _described(need):
    """Such as "Textures: parameters of materials that vary over a surface", or "Light: Point"."""
    if need in needs.MEANING:
        return f"{need.capitalize()}: {needs.MEANING[need]}"
    kind, _, key = need.partition(" ")
    registry = {"bsdf": BSDFS, "light": LIGHTS, "pass": PASSES, "camera": CAMERAS}[kind]
    return f"{'Reflection' if kind == 'bsdf' else kind.capitalize()}: {registry[key].label}"


def _shortened(names, most=4):
    rest = len(names) - most
    return ", ".join(names[:most]) + (f" and {rest} more" if rest > 0 else "")
