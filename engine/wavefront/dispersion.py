"""Indices of refraction that depend on the wavelength.

A path is white until it meets a boundary that takes light apart. There it gets one wavelength, by a number that the samples
of a pixel share out among them, and the weights that this wavelength has in the three channels; from then on it
is of one colour. (At the camera already, scenes with one prism would be noisy everywhere.) What is reflected has a wavelength
too, since its share depends on it: so what is reflected and what passes add up to white, in the mean exactly.
Integrators that follow every ray follow one for each channel instead.
"""

import dataclasses

import numpy as np

from ..dimensions import Dimension
from ..maths.spectrum import CHANNELS, place, sample_wavelength

_CHANNEL_PLACES = place(CHANNELS)


def white(plan, rays):
    """The first column `wavelength` (N,) [nm] of what camera rays carry: 0, they are white."""
    return np.zeros(rays.slot.size, rays.d.dtype)


def one_wavelength(plan, rays, is_dispersive):
    """Places in the spectrum (N,) of `rays`, of which those that are white and meet what `is_dispersive` (N,) get a wavelength."""
    lanes = np.nonzero(is_dispersive & (rays.carried.wavelength == 0))[0]
    if lanes.size:
        # One dimension for the whole path: all samples of a pixel share out the spectrum, whichever bounce it is.
        u1 = plan.numbers.one(dataclasses.replace(rays, depth=0), Dimension.WAVELENGTH).take(lanes)
        chosen, weight = sample_wavelength(u1)
        # Other rays from the same surface share the column.
        rays.carried.wavelength = rays.carried.wavelength.copy()
        rays.carried.wavelength[lanes] = chosen
        rays.beta[:, lanes] *= weight
    return np.where(rays.carried.wavelength > 0, place(rays.carried.wavelength), np.float32(0))


def three_wavelengths(plan, rays, is_dispersive):
    """Places in the spectrum (3, 1), one for each channel."""
    return _CHANNEL_PLACES


def indices(places):
    """The stage that gives boundaries their indices of refraction, over those of what is around their bodies.

    `places` says where in the spectrum the rays are.
    """

    def find_indices(plan, rays, surface, reflection):
        ior, spread = plan.around(plan, rays, surface)
        is_dispersive = np.broadcast_to(spread != 0, rays.slot.shape)
        for lobe in reflection.specular:
            if hasattr(lobe.k, "ior"):
                is_dispersive = is_dispersive | (lobe.k.spread != 0)
        at = places(plan, rays, is_dispersive)
        around = ior + spread * at
        return reflection.with_indices(lambda k: (k.ior + k.spread * at) / around, rays.slot.size)

    return find_indices
