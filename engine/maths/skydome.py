"""Hosek and Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance": the sky above a ground that reflects.

Its coefficients are the authors' XYZ data set, in skydome.csv beside this file: see LICENSES/BSD-3-Clause.txt.
"""

from functools import lru_cache
from math import comb
from pathlib import Path

import numpy as np

from .observer import FROM_XYZ
from .vectors import dot

_HORIZON = 0.5 * np.pi - 0.001
"""Nothing lies lower; what is below looks like it."""
_SCALE = 2 * np.pi / 683
"""Radiance per unit of the data set, as Blender has it."""
_FINEST = np.finfo(np.float32).eps
"""The least difference of numbers about 1."""
_TURBIDITIES = 10
_BINOMIALS = np.array([comb(5, k) for k in range(6)])


def hosek_wilkie(d, towards, turbidity, albedo):
    """Radiance (3, N), linear Rec. 709, of the sky along d (3, N) without the sun, which is `towards` (3,), or on the horizon below it.

    turbidity  1 to 10
    albedo     of the ground, 0 to 1
    """
    elevation = np.arcsin(min(max(towards[2], 0.0), 1.0))
    coefficients = _coefficients(elevation, turbidity, albedo).astype(np.float32)
    azimuth = np.arctan2(towards[0], towards[1])
    sun = np.cos(elevation) * np.sin(azimuth), np.cos(elevation) * np.cos(azimuth), np.sin(elevation)
    theta = np.minimum(np.arccos(np.clip(d[2], -1, 1)), np.float32(_HORIZON))
    gamma = np.arccos(np.clip(dot(d, np.array(sun, np.float32)[:, None]), -1, 1))
    xyz = [_radiance(k, np.cos(theta), gamma) for k in coefficients]
    return np.stack([np.maximum(sum(np.float32(_SCALE * share) * part for share, part in zip(row, xyz)), 0) for row in FROM_XYZ])


def _radiance(k, cos_theta, gamma):
    """Equations 8 and 9, times the average radiance."""
    A, B, C, D, E, F, G, I, H, mean = k  # noqa: E741
    cos_gamma = np.cos(gamma)
    square = cos_gamma * cos_gamma
    # 1 + H^2 - 2 H cos(gamma), but never below 0.
    half = np.sin(np.float32(0.5) * gamma)
    wide = np.maximum((1 - H) * (1 - H) + 4 * H * half * half, _FINEST)
    halo = (1 + square) / (wide * np.sqrt(wide))
    return (1 + A * np.exp(B / (cos_theta + np.float32(0.01)))) * (
        C + D * np.exp(E * gamma) + F * square + G * halo + I * np.sqrt(cos_theta)
    ) * mean  # fmt: skip


def _coefficients(elevation, turbidity, albedo):
    """Those of X, Y and Z (3, 10): Bezier curves of the sun's elevation [rad] (equation 11), else linear between data."""
    t = np.cbrt(elevation / (0.5 * np.pi))
    place = min(max(turbidity, 1.0), _TURBIDITIES) - 1
    low = min(int(place), _TURBIDITIES - 2)
    shares = np.zeros((2, _TURBIDITIES))
    shares[:, low], shares[:, low + 1] = 1 + low - place, place - low
    shares *= np.array([1 - albedo, albedo])[:, None]
    powers = np.arange(6)
    return np.einsum("catpk,at,p->ck", _data(), shares, _BINOMIALS * t**powers * (1 - t) ** (5 - powers))


@lru_cache(maxsize=1)
def _data():
    """(3, 2, 10, 6, 10): X, Y, Z by albedo, turbidity, control point and coefficient."""
    table = np.loadtxt(Path(__file__).with_name("skydome.csv"), delimiter=",", encoding="utf-8")
    return table.reshape(3, 2, _TURBIDITIES, 6, 10)
