"""How to render: numbers and names, checked when they are made."""

import math
from bisect import bisect_left
from dataclasses import dataclass
from functools import cached_property
from itertools import accumulate

import numpy as np

from ..errors import SceneError

REPLICATES = 8
"""Where the error is asked for and nothing else: its own error is then a quarter in a pixel, and far less in a picture."""
FIRST = 16
"""Samples of the first replicates where a picture may end after any of them."""
ERROR_MEASURES = ("relative", "lightness")
"""What the error of a picture may be told in, see `measured`."""
PRECISIONS = {"fast": np.float32, "exact": np.float64}
"""What rays and light are computed in. Embree finds triangles in float32 in any case, see `world.measured`."""
OF_ERROR = ("Standard Error", "Confidence")
"""Passes that ask for the error."""


@dataclass(frozen=True, kw_only=True)
class Settings:
    """How a scene is rendered. Raises SceneError naming the setting and its value.

    width, height  full frame [px]
    border         (x0, y0, x1, y1) [px], top left to bottom right, right and bottom excluded; empty: the whole frame
    integrator     name of an integrator
    samples        paths per pixel
    sample_range   (first, end) of the samples that are rendered, the end excluded; empty: all. The mean of parts, by their samples,
                   is the whole
    replicates     sets that the samples of a pixel are divided into, each with random numbers of its own: what their means differ by
                   tells the error, see `wavefront.replicates`, and noise grows as they do not complement each other. 1: no error is
                   known; 0: REPLICATES of them where passes or an error target ask for the error, else 1
    error_target   the standard error of the picture at which rendering ends before all samples are in; 0: none
    error_measure  what that is an error of: "relative", radiance relative to its mean; or "lightness", see `measured`
    adaptive_sampling  whether an error target is reached with more samples where they lower the error more, see `allotment`: at most
                   `samples` in a pixel. Else with as many everywhere
    time_limit     the time [s] after which it ends, though not before every pixel has a sample; 0: none
    max_depth      bounces: 0 is direct light only (Cycles' `max_bounces`, the lecture's recursion depth)
    max_transparent  transparent surfaces that light passes between two bounces; the next one absorbs what it should let pass
    branches       rays that distributed ray tracing splits into at the first hit; a quarter of them at each further one
    min_contribution  what a ray must count at least to be followed in Whitted's and distributed ray tracing, in [0, 1]: epsilon_r
    light_falloff  whether the illumination model of 'whitted_phong' lets light fall off with distance
    clamp_direct   the brightest channel [W m^-2 sr^-1] that light may have which is seen itself, or sent on by one surface; brighter
                   light is scaled down, and the picture too dark by what is told at the end. 0: none is
    clamp_indirect  the same for light that more surfaces have sent on
    seed           any integer; equal seeds give equal noise
    sampler        name of a sampler
    pixel_filter   name of a pixel filter
    filter_width   full width of the pixel filter [px]; the box is always one pixel wide
    adaptive_threshold  how much colours [0, 1] must differ for a pixel to be divided, see `wavefront.adaptive`; 0: none is
    adaptive_levels     how often it may be, in four each time; `samples` is then that of each part
    filter_textures  whether textures are averaged over what a ray stands for; else they are looked up at points, and alias
    film_transparent whether the camera does not see the world: alpha is the share of a pixel that something covers
    precision      "fast": float32; or "exact": float64, with hits measured again on the triangles found. See `PRECISIONS`
    passes         names of passes, see the registry
    tile_size      side of the square tiles [px]; 0: the whole frame; does not change the picture
    motion_steps   shapes that a mesh which deforms while the shutter is open takes; each costs its memory once more
    threads        worker threads; 0: one per processor; does not change the picture
    """

    width: int = 512
    height: int = 512
    border: tuple = ()
    integrator: str = "path"
    samples: int = 64
    sample_range: tuple = ()
    replicates: int = 0
    error_target: float = 0.0
    error_measure: str = "relative"
    adaptive_sampling: bool = True
    time_limit: float = 0.0
    max_depth: int = 8
    max_transparent: int = 64
    branches: int = 16
    min_contribution: float = 0.0
    light_falloff: bool = True
    clamp_direct: float = 0.0
    clamp_indirect: float = 0.0
    seed: int = 0
    sampler: str = "sobol"
    pixel_filter: str = "blackman_harris"
    filter_width: float = 1.5
    adaptive_threshold: float = 0.0
    adaptive_levels: int = 3
    filter_textures: bool = True
    film_transparent: bool = False
    precision: str = "fast"
    passes: tuple = ("Combined",)
    tile_size: int = 64
    threads: int = 0
    motion_steps: int = 8

    def __post_init__(self):
        for name, lowest, highest in (
            ("width", 1, 65536),
            ("height", 1, 65536),
            ("samples", 1, 2**24),
            ("replicates", 0, 2**12),
            ("max_depth", 0, 2**16),
            ("max_transparent", 0, 1024),
            ("branches", 1, 2**12),
            ("adaptive_levels", 1, 6),
            ("tile_size", 0, 65536),
            ("threads", 0, 1024),
            ("motion_steps", 1, 1024),
        ):
            value = getattr(self, name)
            if isinstance(value, bool) or not isinstance(value, int) or not lowest <= value <= highest:
                raise SceneError(f"setting {name} is {value!r}, allowed: whole numbers from {lowest} to {highest}")
        if isinstance(self.seed, bool) or not isinstance(self.seed, int):
            raise SceneError(f"setting seed is {self.seed!r}, allowed: whole numbers")
        for name in ("adaptive_sampling", "light_falloff", "filter_textures", "film_transparent"):
            if not isinstance(getattr(self, name), bool):
                raise SceneError(f"setting {name} is {getattr(self, name)!r}, allowed: True or False")
        if not (isinstance(self.min_contribution, (int, float)) and 0.0 <= self.min_contribution <= 1.0):
            raise SceneError(f"setting min_contribution is {self.min_contribution!r}, allowed: 0 to 1")
        if not (isinstance(self.filter_width, (int, float)) and math.isfinite(self.filter_width) and 0.0 < self.filter_width <= 10.0):
            raise SceneError(f"setting filter_width is {self.filter_width!r} px, allowed: above 0 up to 10")
        if not (isinstance(self.error_target, (int, float)) and 0.0 <= self.error_target < math.inf):
            raise SceneError(f"setting error_target is {self.error_target!r}, allowed: from 0, which is none")
        for name in ("clamp_direct", "clamp_indirect"):
            value = getattr(self, name)
            if isinstance(value, bool) or not (isinstance(value, (int, float)) and 0.0 <= value < math.inf):
                raise SceneError(f"setting {name} is {value!r} W m^-2 sr^-1, allowed: from 0, which is none")
        if self.error_measure not in ERROR_MEASURES:
            raise SceneError(f"setting error_measure is {self.error_measure!r}, allowed: {', '.join(ERROR_MEASURES)}")
        if self.precision not in tuple(PRECISIONS):
            raise SceneError(f"setting precision is {self.precision!r}, allowed: {', '.join(PRECISIONS)}")
        if not (isinstance(self.time_limit, (int, float)) and 0.0 <= self.time_limit < math.inf):
            raise SceneError(f"setting time_limit is {self.time_limit!r} s, allowed: from 0, which is none")
        if not (isinstance(self.adaptive_threshold, (int, float)) and 0.0 <= self.adaptive_threshold <= 1.0):
            raise SceneError(f"setting adaptive_threshold is {self.adaptive_threshold!r}, allowed: from 0 to 1")
        if self.adaptive_threshold and (self.error_target or self.time_limit):
            raise SceneError("error_target and time_limit need an adaptive_threshold of 0: divided pixels have an end of their own")
        object.__setattr__(self, "passes", tuple(self.passes))
        object.__setattr__(self, "border", tuple(self.border))
        object.__setattr__(self, "sample_range", tuple(self.sample_range))
        self._check_border()
        self._check_sample_range()

    def _check_border(self):
        if not self.border:
            return
        if len(self.border) == 4 and all(isinstance(edge, int) for edge in self.border):
            x0, y0, x1, y1 = self.border
            if 0 <= x0 < x1 <= self.width and 0 <= y0 < y1 <= self.height:
                return
        raise SceneError(f"setting border is {self.border!r}, allowed: (x0, y0, x1, y1) inside {self.width}x{self.height} px and not empty")

    def _check_sample_range(self):
        if not self.sample_range:
            return
        if self.adaptive_threshold:
            raise SceneError(f"setting sample_range is {self.sample_range!r}, but with an adaptive_threshold all samples decide together")
        if len(self.sample_range) == 2 and all(isinstance(n, int) and not isinstance(n, bool) for n in self.sample_range):
            first, end = self.sample_range
            if 0 <= first < end <= self.samples:
                return
        raise SceneError(f"setting sample_range is {self.sample_range!r}, allowed: (first, end) of {self.samples} samples and not empty")

    @property
    def real(self):
        """The dtype of rays and light."""
        return PRECISIONS[self.precision]

    @property
    def rendered_samples(self):
        """(first, end) of the samples that are rendered: a part of them, or all."""
        return self.sample_range or (0, self.samples)

    @property
    def is_measured(self):
        """Whether the error of the picture becomes known."""
        return len(self.replicate_sizes) > 1

    @cached_property
    def replicate_sizes(self):
        """Samples of each replicate, which are spread over each dimension together; the last one may have less than others.

        Where an error target may end the picture any time there are REPLICATES of FIRST samples, then half as many of twice the
        size, and so on: each is a fifth to an eighth of all so far, so that little evenness is lost.
        """
        if self.error_target and not self.replicates:
            return _cut([FIRST] * (REPLICATES // 2) + [FIRST << level for level in range(24) for _ in range(REPLICATES // 2)], self.samples)
        is_asked = self.replicates or any(key in OF_ERROR for key in self.passes)
        size = -(-self.samples // (self.replicates or REPLICATES)) if is_asked else self.samples
        return _cut([size] * -(-self.samples // size), self.samples)

    @property
    def region(self):
        """(x0, y0, x1, y1) [px] of what is rendered: the border, or the whole frame."""
        return self.border or (0, 0, self.width, self.height)


def _cut(sizes, whole):
    """Of `sizes` as many as are a `whole`, the last one cut."""
    ends = list(accumulate(sizes))
    last = bisect_left(ends, whole)
    return (*sizes[:last], sizes[last] - (ends[last] - whole))
