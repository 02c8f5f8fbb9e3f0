"""The two shapes of a point light with a radius r and radiant intensity I, seen from a point p at distance d.

facing disk  a disk of radius r through the centre that always faces p: radiance I / (pi r^2), irradiance I / (d^2 + r^2)
ball         a sphere of radius r with radiance I / (pi r^2), irradiance I / d^2; sampled by its cone of directions

Both pass into the plain point, pdf = inf and E = I / d^2, as r -> 0, so a radius of 0 needs no case of its own;
where all have none there is nothing to sample.
"""

import numpy as np

from ..constants import PI
from ..errors import SceneError
from .frames import to_world
from .light_frames import around
from .vectors import dot, length, normalize
from .warps import CENTRE, square_to_cone, square_to_cone_pdf, square_to_disk

MIDDLE = CENTRE
"""Numbers with which `sample` returns the direction to the middle."""


def row(frame, light):
    """The columns of a bulb in render space: position, radius, intensity and soft (1: facing disk, 0: ball)."""
    return {
        "position": tuple(frame.points(np.array(light.position, np.float64)[:, None])[:, 0]),
        "radius": light.radius * frame.scale,
        "intensity": tuple(c * frame.scale**2 for c in light.intensity),
        "soft": float(light.soft_falloff),
    }


def check(light):
    """Raises SceneError for a radius that no bulb has."""
    if not light.radius >= 0:
        raise SceneError(f"light '{light.name}': radius is {light.radius} m, allowed: from 0 on")


def weight(frame, light):
    """See `interfaces.Light.weight`."""
    placed = row(frame, light)
    return {
        "centre": placed["position"],
        "power": placed["intensity"],
        "nearness": 1.0,
        "radius2": placed["radius"] ** 2,
        "axis": (0.0, 0.0, 0.0),
        "cos_edge": -1.0,
    }


def power(light):
    """Radiant flux 4 pi I [W], (r, g, b)."""
    return tuple(4 * PI * c for c in light.intensity)


def sample(k, p, u2):
    """See `interfaces.Light.sample`."""
    to_centre = k.position - p
    if not k.radius.any():
        return _to_points(k, to_centre)
    disk = _sample_disk(k, to_centre, u2)
    if k.soft.all():
        return disk
    ball = _sample_ball(k, to_centre, u2)
    soft = k.soft > 0
    return tuple(np.where(soft, a, b) for a, b in zip(disk, ball))


def hit(k, o, d):
    """See `interfaces.Light.hit`."""
    to_centre = k.position - o
    disk = _hit_disk(k, to_centre, d)
    if k.soft.all():
        return disk
    ball = _hit_ball(k, to_centre, d)
    soft = k.soft > 0
    return tuple(np.where(soft, a, b) for a, b in zip(disk, ball))


def seen(k, p, d, distance):
    """See `interfaces.Light.seen`: a disk faces the ray, a ball shows its surface; around both is a map of all directions."""
    place = np.where(k.radius > 0, p + d * distance, k.position)
    n = np.where(k.soft > 0, -d, normalize(place - k.position))
    # Who is without a size has no side but that from which it is seen.
    n = np.where(k.radius > 0, n, -d)
    return place, n, around(k, n)


def _to_points(k, to_centre):
    distance2 = dot(to_centre, to_centre)
    distance = np.sqrt(distance2)
    to_centre /= _positive(distance)
    return to_centre, distance, k.intensity * (1 / _positive(distance2)), np.full_like(distance, np.inf)


def _sample_disk(k, to_centre, u2):
    centre_distance = length(to_centre)
    axis = to_centre / _positive(centre_distance)
    x, y = square_to_disk(u2) * k.radius
    to_light = to_world(axis, np.stack((x, y, centre_distance)))
    distance2 = dot(to_light, to_light)
    distance = np.sqrt(distance2)
    # dA_projected / d^2 per sample: I / (pi r^2) * pi r^2 cos / d^2, the area gone.
    cos = centre_distance / _positive(distance)
    E = k.intensity * (cos / _positive(distance2))
    return to_light / _positive(distance), distance, E, _disk_pdf(k.radius, cos, distance2)


def _hit_disk(k, to_centre, d):
    # The disk faces the ray's origin, which is all that this ray knows of it.
    centre_distance = length(to_centre)
    cos = dot(to_centre, d) / _positive(centre_distance)
    t = centre_distance / np.where(cos > 0, cos, 1)
    # The distance of the centre from where the ray meets the disk by a vector, not by t^2 - distance^2, which cancels.
    off_centre = t * d - to_centre
    meets = (cos > 0) & (dot(off_centre, off_centre) < k.radius * k.radius)
    L = k.intensity / (PI * _positive(k.radius * k.radius))
    return np.where(meets, t, np.inf), L, _disk_pdf(k.radius, cos, t * t)


def _disk_pdf(radius, cos, distance2):
    with np.errstate(divide="ignore", invalid="ignore"):
        return distance2 / (PI * radius * radius * np.maximum(cos, 0))


def _sample_ball(k, to_centre, u2):
    centre_distance2 = dot(to_centre, to_centre)
    one_minus_cos = _ball_cone(k.radius, centre_distance2)
    wi = to_world(normalize(to_centre), square_to_cone(u2, one_minus_cos))
    inside = centre_distance2 <= k.radius * k.radius
    # E = L / pdf = I / (pi r^2) * 2 pi (1 - cos), with (1 - cos) / r^2 taken to its limit for small r.
    share = _cone_over_r2(k.radius, centre_distance2, one_minus_cos)
    E = k.intensity * (2 * share)
    along = dot(to_centre, wi)
    half_chord = np.sqrt(np.maximum(along * along - centre_distance2 + k.radius * k.radius, 0))
    distance = np.where(inside, along + half_chord, along - half_chord)
    return wi, np.maximum(distance, 0), E, square_to_cone_pdf(one_minus_cos)


def _hit_ball(k, to_centre, d):
    centre_distance2 = dot(to_centre, to_centre)
    along = dot(to_centre, d)
    # The distance of the centre from the ray by a vector, not by d^2 - along^2, which cancels.
    off_axis = to_centre - along * d
    half_chord2 = k.radius * k.radius - dot(off_axis, off_axis)
    half_chord = np.sqrt(np.maximum(half_chord2, 0))
    inside = centre_distance2 <= k.radius * k.radius
    t = np.where(inside, along + half_chord, along - half_chord)
    L = k.intensity / (PI * _positive(k.radius * k.radius))
    return np.where((half_chord2 > 0) & (t > 0), t, np.inf), L, square_to_cone_pdf(_ball_cone(k.radius, centre_distance2))


def _ball_cone(radius, centre_distance2):
    """1 - cos of the half-angle under which the ball is seen; 2, all directions, from inside."""
    sin2 = radius * radius / _positive(centre_distance2)
    outside = sin2 < 1
    sin2 = np.where(outside, sin2, 0)
    return np.where(outside, sin2 / (1 + np.sqrt(1 - sin2)), 2)


def _cone_over_r2(radius, centre_distance2, one_minus_cos):
    # (1 - cos) / r^2 = 1 / (d^2 (1 + cos)): no radius left to divide by.
    outside = one_minus_cos < 2
    far = 1 / (_positive(centre_distance2) * np.where(outside, 2 - one_minus_cos, 1))
    return np.where(outside, far, 2 / _positive(radius * radius))


def _positive(x):
    # Where x is 0 the result is unused.
    return np.maximum(x, np.finfo(x.dtype).tiny)
