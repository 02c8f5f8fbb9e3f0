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


_KIND = np.array([0, *(3 if bits & 16 else 1 if bits & 1 else 2 for bits in range(1, 32))], np.uint8)
"""The place in `scene.visibility.RAY_KINDS` for all bits of _KINDS; what has passed a surface is of the kind of those, however."""


def kind_of(carried):
    """Of which kind rays are, (N,) places in `RAY_KINDS`."""
    return _KIND.take(carried.scattered)


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


def leave_by_lobes(plan, rays, surface, reflection, scattered):
    """The stage that has scattered rays know by which lobe they have left."""
    chosen, rough = reflection.chosen_lobe(rays.slot.size, plan.choose_lobe(plan, rays)), len(reflection.rough)
    kinds = [_KINDS["diffuse"] if lobe.bsdf.is_diffuse else _KINDS["glossy"] for lobe in reflection.rough]
    kind = np.array([*kinds, _KINDS["glossy"] | _KINDS["singular"]], np.uint8).take(np.minimum(chosen, rough))
    goes_back = (surface.n * scattered.d).sum(axis=0) > 0
    bounces = scattered.carried.bounces.copy()
    is_diffuse = (kind & _KINDS["diffuse"]) > 0
    for row, counts in enumerate((goes_back & is_diffuse, goes_back & ~is_diffuse, ~goes_back)):
        bounces[row] += counts
    scattered.carried.bounces = bounces
    scattered.carried.scattered = kind | np.where(goes_back, np.uint8(_KINDS["reflection"]), np.uint8(_KINDS["transmission"]))


def count_passed(plan, rays, surface):
    """The stage that counts the surfaces that rays pass straight on."""
    bounces = rays.carried.bounces.copy()
    bounces[_COUNTS.index("transparent depth")] += 1
    rays.carried.bounces = bounces
