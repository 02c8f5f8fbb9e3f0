"""From what a scene needs to what is run: tuples of stages, empty for what is absent."""

from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from . import needs
from .arrays import Columns, columns
from .constants import EPS32
from .interfaces import is_straight
from .maths.vectors import length
from .measured import MEASURED_BY
from .registry import FILTERS, INTEGRATORS, PASSES, SAMPLERS
from .requirements import Requirements
from .scene.settings import Settings
from .scene.validate import check_camera
from .scene.values import Scene
from .wavefront import dispersion, light_path, media
from .wavefront.adaptive import AdaptiveTile
from .wavefront.camera_rays import bladed_aperture, round_aperture, seen_from, start_at, through_the_lens, through_the_pinhole
from .wavefront.clamping import ClampedFilm
from .wavefront.clear_film import STRAIGHT, hidden, stay_clear, stay_straight, straight_at_first
from .wavefront.clip import clip_row, start_in_range, to_the_end_of_range
from .wavefront.cones import (
    CARRIED,
    aim_cones,
    edges_at_rest,
    edges_at_time,
    footprints_of_cones,
    landing_with_cones,
    leave_with_cones,
    no_footprints,
    start_cones_in_range,
)
from .wavefront.continuation import SQUEEZE, squeeze, unsqueezed
from .wavefront.direct import (
    all_lobes,
    any_side,
    no_side,
    remember_side,
    shaded_side,
    shadow_rays_in_front,
    shadow_rays_on_either_side,
    to_no_light,
    unsplit,
)
from .wavefront.emission import add_emission, even_shine, textured_shine
from .wavefront.escape import add_background, add_environment, add_light_hits, add_light_hits_beyond
from .wavefront.film import Film
from .wavefront.holdouts import hold_out
from .wavefront.loop import few_wait, none_wait
from .wavefront.motion import (
    TIME,
    add_moving_emission,
    closest_at_time,
    follow_camera,
    interact_at_time,
    occluded_at_time,
    seen_from_camera,
    start_time,
    to_the_end_of_moving_range,
)
from .wavefront.numbers import Layout, Numbers, layout, one_of_the_lobes, only_lobe
from .wavefront.passing import record_beyond, travel_through, unblocked_through
from .wavefront.relief import bend_normals
from .wavefront.sights import closest_in_sight, closest_to_shadows, lit_by, lit_lobes, occluded_to_shadows, stay_of_kind
from .wavefront.splitting import not_split, split_by_lobes, split_light
from .wavefront.texturing import fill_in_textures
from .wavefront.tiles import EvenTile
from .wavefront.visibility import all_of_it, all_the_way, closest, interact_at_rest, occluded, seen_at_rest, travel, unblocked
from .world.compile import CompiledWorld, compile_world
from .world.interaction import START_ULPS, flat_normals, leave_in_front, leave_on_either_side, smooth_normals
from .world.materials import TwoSided
from .world.passing import Passing
from .world.poses import Path, Poses


@dataclass(frozen=True, slots=True, eq=False)
class Plan:
    """Everything that stays the same while a picture is rendered.

    place              where the camera is in render space, (3,): mostly in its middle
    replicates         which samples are spread together
    numbers            the random numbers of those of the first size, see `numbers.spread_at`
    carry              what paths carry along: (name, first column (plan, rays)) of each
    aim                origins and directions (plan, rays, x, y) of camera rays
    camera_poses       where the camera is over the time that the shutter is open, see `world.poses`; None: it stands still
    on_camera_rays     stages (plan, rays) before camera rays are traced
    closest, occluded  what lies along rays (plan, carried, o, d, limit), see `wavefront.visibility`
    reach              how far (plan, rays) rays go
    travel             the hits (plan, rays, film) of a batch, see `wavefront.visibility`
    lit_side           the normals (surface) on the side that a choice of lights is for; None: any
    shadow_rays        the shadow rays (plan, rays, surface, reflection, wi, distance) to points on lights
    to_lights          points on lights (plan, rays, surface), see `wavefront.direct.to_one_light`
    lit_lobes          light (plan, surface, reflection, wi, L, light) by the lobes that lights are not hidden from
    split_light        the rays (plan, rays, surface, reflection, wi) with what passes ask of light that they reflect
    closest_to_shadows `closest` of shadow rays
    unblocked          the shadow rays (plan, rays, o, d, limit, candidate) that arrive
    left               the share of light (plan, rays, t) that is left after a way t
    around             index of refraction and its spread of what is around the bodies (plan, rays, surface) that rays met
    seen_from_camera   points (plan, rays, p) of render space as `camera` and `camera_k` describe them
    on_rays            stages (plan, rays, hits, film) for every batch: light met along the way
    on_rays_beyond     the same beyond a surface that rays have passed, see `wavefront.passing`
    on_passing         stages (plan, rays, surface) that renew what rays carry when they pass a surface straight on
    shine              the emission (plan, rays, hits, lanes, L) of what rays met, see `wavefront.emission`
    footprints, edges  what rays stand for on triangles (plan, rays, prim, wo, t, lanes), and their edges, see `wavefront.cones`
    interact           the surface (plan, rays, hits) that a batch met
    adjust_surface     stages (plan, rays, surface) -> surface: what changes its normals
    reflect            the reflection (surface) of its materials, see `Materials.at`
    adjust_reflection  stages (plan, rays, surface, reflection) -> reflection: what changes its lobes
    on_surface         stages (plan, rays, surface, reflection, film) at every surface: direct light
    on_leaving         stages (plan, rays, surface, reflection, scattered) that renew what scattered rays carry
    first_hits         the passes that record where camera rays hit
    tile               how the pixels of a tile are sampled, see `wavefront.tiles`
    film               what gathers so many pixels (pixels, passes, replicates), see `wavefront.film`
    wait               what becomes of few rays (waiting, rays), see `wavefront.loop`
    passes             those that are gathered: what the settings ask for, what that is divided by, what tells the error
    last_depth         the depth of the last rays that are traced
    The other functions are choices that cost nothing where there is nothing to choose.
    """

    scene: Scene
    settings: Settings
    requirements: Requirements
    world: CompiledWorld
    place: np.ndarray
    replicates: Layout
    numbers: Numbers
    filter: type
    camera: type
    camera_k: Columns
    camera_poses: object
    carry: tuple
    aim: object
    aperture: object
    on_camera_rays: tuple
    closest: object
    occluded: object
    closest_to_shadows: object
    reach: object
    travel: object
    lit_side: object
    shadow_rays: object
    to_lights: object
    lit_lobes: object
    split_light: object
    unblocked: object
    left: object
    around: object
    seen_from_camera: object
    on_rays: tuple
    on_rays_beyond: tuple
    on_passing: tuple
    shine: object
    footprints: object
    edges: object
    interact: object
    adjust_surface: tuple
    reflect: object
    adjust_reflection: tuple
    on_surface: tuple
    on_leaving: tuple
    first_hits: tuple
    passes: tuple
    tile: type
    film: object
    scatter: object
    wait: object
    shading_normals: object
    choose_lobe: object
    leave: object
    last_depth: int

    @classmethod
    def of(cls, scene, settings, requirements, world=None, before=None):
        """Compile `scene` and keep what `requirements` ask for.

        world   what comes of compiling it, where that is known
        before  the `CompiledWorld` of the scene as it was, see `compile_world`
        """
        smooth = needs.SMOOTH_NORMALS in requirements
        integrator = INTEGRATORS[settings.integrator]
        absorbs, is_nested = needs.ABSORPTION in requirements, needs.NESTED_MEDIA in requirements
        is_sighted, has_holdouts = needs.RAY_VISIBILITY in requirements, needs.HOLDOUTS in requirements
        has_media, disperses = absorbs or is_nested, needs.DISPERSION in requirements
        has_wavelength = disperses and not integrator.splits_white
        has_choice, has_environment = needs.LIGHT_CHOICE in requirements, needs.ENVIRONMENT in requirements
        steps = settings.motion_steps if needs.OBJECT_MOTION in requirements else 0
        passes = needs.TRANSPARENCY in requirements
        tints = needs.TINTED_SHADOWS in requirements
        passing_of = partial(Passing.of, tints_glass=integrator.tints_glass, real=settings.real) if passes or tints else None
        # What rays pass on their way is no lobe for them to choose where they end.
        are_passed = passes and not integrator.tints_glass
        bsdfs = tuple(bsdf for bsdf in requirements.plugins("bsdf") if not (are_passed and is_straight(bsdf)))
        # Those that others are divided by, too.
        wanted = [PASSES[key] for key in (*settings.passes, *(MEASURED_BY if settings.is_measured else ()))]
        gathered = tuple(dict.fromkeys((*wanted, *(PASSES[p.divided_by] for p in wanted if p.divided_by))))
        asked = [key for p in gathered for key in getattr(p, "attributes", ())]
        world = world or compile_world(
            scene,
            bsdfs,
            smooth,
            has_choice,
            integrator.samples_lights,
            has_media,
            has_environment,
            steps,
            passing_of,
            disperses,
            is_sighted,
            has_holdouts,
            before,
            asked,
            settings.real,
        )
        can_reflect = bool(world.materials.lobes)
        is_clear = settings.film_transparent
        shown_world = (add_environment,) if world.lights.environment else (add_background,) if needs.BACKGROUND in requirements else ()
        # Where what passes straight on is a ray of its own it does not count as one from the camera.
        splits_straight = integrator.tints_glass and any(map(is_straight, bsdfs))
        covering = tuple(p for p in gathered if getattr(p, "covers", False)) if splits_straight else ()
        minds_straight = splits_straight and bool(is_clear or has_holdouts or covering)
        on_rays = (
            *((media.add_light_hits_in_media if absorbs else add_light_hits,) if needs.LIGHT_HITS in requirements else ()),
            *((media.absorb,) if absorbs else ()),
            *((stay_clear,) if is_clear else ()),
            *(map(hidden, shown_world) if is_clear else shown_world),
            *((hold_out,) if has_holdouts else ()),
            *((add_emission,) if needs.EMISSIVE_MESHES in requirements and world.emitters.still else ()),
            *((add_moving_emission,) if needs.EMISSIVE_MESHES in requirements and world.emitters.moving else ()),
        )
        hides_lights = is_sighted and world.sights.hides_lights

        def lit(stage):
            return lit_by(stage) if hides_lights and stage not in (media.absorb, media.absorb_beyond, stay_clear, hold_out) else stage

        around = media.around if is_nested else media.vacuum
        adjust_reflection = (media.relative_indices,) if is_nested else ()
        if disperses:
            places = dispersion.one_wavelength if has_wavelength else dispersion.three_wavelengths
            adjust_reflection = (dispersion.indices(places),)
        can_sample = integrator.samples_lights and world.materials.rough_lobes and not world.lights.is_empty
        minds_side = bool(can_sample and world.lights.choice.minds_side and world.materials.kind is not TwoSided)
        is_clipped = needs.CLIP_RANGE in requirements
        follows = needs.CAMERA_MOTION in requirements
        nearest, blocked = (closest_at_time, occluded_at_time) if world.movers else (closest, occluded)
        nearest_to_shadows = nearest
        if is_sighted:
            nearest, nearest_to_shadows, blocked = closest_in_sight, closest_to_shadows, occluded_to_shadows
        has_cones, has_past = needs.FOOTPRINTS in requirements, is_sighted or needs.LIGHT_PATHS in requirements
        aim = through_the_lens if needs.LENS in requirements else through_the_pinhole
        interact = interact_at_time if world.movers else interact_at_rest
        camera = scene.camera
        scale = world.frame.scale
        place = world.frame.points(camera.position[:, None])[:, 0]
        row = camera.row(settings.width, settings.height, scale) | (clip_row(camera, scale) if is_clipped else {})
        splits = needs.SPLIT_LIGHT in requirements
        limits = settings.clamp_direct, settings.clamp_indirect
        # Where each channel has an index of its own nothing is chosen at random.
        squeezes = not integrator.splits_specular and any(hasattr(lobe.k, "ior") for lobe in world.materials.lobes if lobe.bsdf.is_specular)
        return cls(
            scene=scene,
            settings=settings,
            requirements=requirements,
            world=world,
            place=place,
            replicates=layout(settings.replicate_sizes),
            numbers=Numbers(SAMPLERS[settings.sampler], settings.replicate_sizes[0], settings.real),
            filter=FILTERS[settings.pixel_filter],
            camera=type(camera),
            camera_k=columns([row], settings.real),
            camera_poses=Poses.of((Path.of_camera(scene.camera, world.frame),)) if follows else None,
            carry=(
                *(((TIME, start_time),) if follows or world.movers else ()),
                *((("inside", media.in_no_body),) if has_media else ()),
                *((("wavelength", dispersion.white),) if has_wavelength else ()),
                *(CARRIED if has_cones else ()),
                *((("facing", no_side),) if minds_side else ()),
                *(light_path.CARRIED if has_past else ()),
                *((("split", not_split),) if splits else ()),
                *(((STRAIGHT, straight_at_first),) if minds_straight else ()),
                *(((SQUEEZE, unsqueezed),) if squeezes else ()),
            ),
            aim=aim_cones(aim) if has_cones else aim,
            aperture=bladed_aperture if camera.lens.blades else round_aperture,
            # What comes before the camera moves is said of a camera at rest.
            on_camera_rays=(
                *((start_in_range,) if is_clipped else ()),
                *((start_cones_in_range,) if is_clipped and has_cones else ()),
                *((follow_camera,) if follows else (start_at(place),) if place.any() else ()),
                *((media.start_inside(nearest),) if has_media else ()),
            ),
            closest=media.through_media(nearest) if is_nested else nearest,
            occluded=media.occluded_in_media(blocked, media.through_media(nearest_to_shadows)) if is_nested else blocked,
            closest_to_shadows=media.through_media(nearest_to_shadows) if is_nested else nearest_to_shadows,
            reach=(to_the_end_of_moving_range if follows else to_the_end_of_range) if is_clipped else all_the_way,
            travel=travel_through if passes else travel,
            lit_side=shaded_side if minds_side else any_side,
            shadow_rays=shadow_rays_on_either_side if world.materials.kind is TwoSided else shadow_rays_in_front,
            to_lights=to_no_light if world.lights.is_empty else integrator.to_lights,
            lit_lobes=lit_lobes if hides_lights else all_lobes,
            split_light=split_light if splits else unsplit,
            unblocked=unblocked_through if tints else media.absorbed(unblocked) if absorbs else unblocked,
            left=media.left_by_media if absorbs else all_of_it,
            around=around,
            seen_from_camera=seen_from_camera if follows else seen_from(place) if place.any() else seen_at_rest,
            on_rays=tuple(map(lit, on_rays)),
            on_rays_beyond=tuple(lit(_BEYOND.get(stage, stage)) for stage in on_rays),
            on_passing=(*((media.pass_boundary,) if has_media else ()), *((light_path.count_passed,) if has_past else ())),
            shine=textured_shine if world.materials.glowing else even_shine,
            footprints=footprints_of_cones if has_cones else no_footprints,
            edges=edges_at_time if world.movers else edges_at_rest,
            interact=landing_with_cones(interact) if has_cones else interact,
            adjust_surface=(bend_normals,) if needs.RELIEF in requirements and world.materials.relief else (),
            reflect=(world.by_cosine or world.materials).at,
            adjust_reflection=(
                *((fill_in_textures,) if world.materials.textured else ()),
                *adjust_reflection,
            ),
            on_surface=(
                *(integrator.on_surface if can_sample else ()),
                *((record_beyond(covering),) if covering else ()),
            ),
            on_leaving=(
                *((media.change_media,) if has_media else ()),
                *((leave_with_cones,) if has_cones else ()),
                *((remember_side,) if minds_side else ()),
                *((light_path.leave_by_lobes,) if has_past else ()),
                *((stay_of_kind,) if is_sighted and splits_straight else ()),
                *((split_by_lobes,) if splits else ()),
                *((stay_straight,) if minds_straight else ()),
                *((squeeze,) if squeezes else ()),
            ),
            first_hits=tuple(p for p in gathered if p.records.startswith("first hit")),
            passes=gathered,
            tile=AdaptiveTile if needs.ADAPTIVE in requirements else EvenTile,
            film=partial(ClampedFilm, real=settings.real, limits=limits) if any(limits) else partial(Film, real=settings.real),
            scatter=integrator.scatter,
            wait=none_wait if integrator.splits_specular else few_wait,
            shading_normals=smooth_normals if smooth else flat_normals,
            choose_lobe=one_of_the_lobes if len(world.materials.lobes) > 1 else only_lobe,
            leave=leave_on_either_side if any(lobe.bsdf.transmits for lobe in world.materials.lobes) else leave_in_front,
            # After the last bounce scattered rays share the search for direct light with shadow rays, where they can find any.
            last_depth=settings.max_depth + bool({*on_rays} - {media.absorb, stay_clear, hold_out} and integrator.is_complete)
            if can_reflect
            else 0,
        )

    def seen_from(self, camera, settings):
        """The plan for another `camera`, or settings that differ in what concerns the film alone: nothing is compiled again.

        Render space stays where it is, so what a camera looks at closely and far from its middle is not exact: see `is_exact`.
        Raises SceneError where the camera cannot be used.
        """
        check_camera(camera)
        scene = replace(self.scene, camera=camera)
        return Plan.of(scene, settings, self.requirements.seen_from(camera), world=self.world.seen_from(camera))

    def is_exact(self):
        """Whether what the camera sees is rounded to well below a pixel, wherever the middle of render space is.

        Looked at along a grid of rays. What counts is how far rays start off surfaces, which is in proportion to that rounding.
        """
        if not self.place.any():
            return True
        settings = self.settings
        x, y = (((np.arange(_GRID) + 0.5) / _GRID - 0.5) * side for side in (settings.width, settings.height))
        x, y = (side.ravel().astype(settings.real) for side in np.meshgrid(x, y))
        (o, d), beside = self.camera.rays(self.camera_k, x, y), self.camera.rays(self.camera_k, x + 1, y)
        d = np.ascontiguousarray(d, settings.real)
        hits = self.world.accel.closest((o + self.place[:, None]).astype(settings.real), d)
        met = np.nonzero(hits.prim >= 0)[0]
        o, d, across, along = (a.take(met, axis=1) for a in (o, d, *beside))
        t = hits.t.take(met)
        pixel = length(across + t * along - o - t * d)
        offset = START_ULPS * EPS32 * np.abs(o + t * d + self.place[:, None]).max(axis=0)
        return np.count_nonzero(offset * _PER_PIXEL > pixel) * _GRID <= met.size


_GRID = 16
"""Rows and columns of rays that `Plan.is_exact` looks along; a row may be inexact."""
_PER_PIXEL = 4
"""Rays may start so many times less than a pixel off surfaces."""
_BEYOND = {
    add_light_hits: add_light_hits_beyond,
    media.add_light_hits_in_media: media.add_light_hits_in_media_beyond,
    media.absorb: media.absorb_beyond,
}
"""The stages that have to know where a ray has passed a surface last."""
