"""What has scattered a path before: carried along where textures ask for it."""

import numpy as np

_KINDS = {"diffuse": 1, "glossy": 2, "singular": 4, "reflection": 8, "transmission": 16}
_COUNTS = ("diffuse depth", "glossy depth", "transmission depth", "transparent depth")


def _none(plan, rays):
    return np.zeros(rays.slot.size, np.uint8)


def _no_bounces(plan, rays):
    return np.zeros((len(_COUNTS), rays.slot.size), np.uint16)


CARRIED = (("scattered", _none), ("bounces", _no_bounces))
"""What the last lobe was, bits of _KINDS (N,); and how often of each of _COUNTS (4, N)."""


def is_past(output):
    """Whether it is something that paths carry along."""
    return output in _KINDS or output in _COUNTS


def past_of(rays, output, is_shadow):
    """What paths have carried along as `LightPath` says it, float32 (1, N); shadow rays are of no other kind."""
    if output in _COUNTS:
        return rays.carried.bounces[_COUNTS.index(output)][None].astype(np.float32)
    if is_shadow:
        return np.zeros((1, 1), np.float32)
    return ((rays.carried.scattered & _KINDS[output]) > 0)[None].astype(np.float32)


def remember_lobes(plan, rays, surface, reflection):
    """The stage that has rays know which numbers choose which lobe, until they leave."""
    # Of one lobe there are none, whatever their number of columns.
    shape = len(reflection.thresholds), rays.slot.size
    rays.carried.thresholds = np.array(np.broadcast_to(reflection.thresholds, shape)) if shape[0] else np.zeros(shape, np.float32)
    return reflection


def leave_by(integrator):
    """The stage that has scattered rays know by which lobe they have left."""

    def leave(plan, rays, surface, scattered):
        lobes, rough = plan.world.materials.lobes, plan.world.materials.rough_lobes
        thresholds = scattered.carried.thresholds
        del scattered.carried.thresholds
        # What shadow rays could find as well has been sampled by rough lobes.
        is_singular = np.isinf(scattered.pdf) if integrator.samples_lights else np.zeros(rays.slot.size, bool)
        chosen = np.zeros(rays.slot.size, np.intp)
        if len(lobes) > 1 and rough:
            u1 = plan.choose_lobe(plan, rays)
            if integrator.splits_specular and rough < len(lobes):
                u1 = u1 * thresholds[rough - 1]
            chosen = (u1 >= thresholds).sum(axis=0)
        kinds = np.array([_KINDS["diffuse"] if lobe.bsdf.is_diffuse else _KINDS["glossy"] for lobe in lobes[:rough]], np.uint8)
        singular = np.uint8(_KINDS["glossy"] | _KINDS["singular"])
        kind = np.concatenate((kinds, np.full(len(lobes) - rough + 1, singular))).take(chosen)
        kind = np.where(is_singular, singular, kind)
        goes_back = (surface.n * scattered.d).sum(axis=0) > 0
        bounces = scattered.carried.bounces.copy()
        is_diffuse = (kind & _KINDS["diffuse"]) > 0
        for row, counts in enumerate((goes_back & is_diffuse, goes_back & ~is_diffuse, ~goes_back)):
            bounces[row] += counts
        scattered.carried.bounces = bounces
        scattered.carried.scattered = kind | np.where(goes_back, np.uint8(_KINDS["reflection"]), np.uint8(_KINDS["transmission"]))

    return leave


def count_passed(plan, rays, surface):
    """The stage that counts the surfaces that rays pass straight on."""
    bounces = rays.carried.bounces.copy()
    bounces[_COUNTS.index("transparent depth")] += 1
    rays.carried.bounces = bounces
