"""What a plug-in must offer. Every function is pure and works on lanes: arrays whose last axis is N.

`k` is always a table of parameters (`arrays.Columns`) with one row per lane; random numbers are arguments.
"""

from typing import Protocol, runtime_checkable

import numpy as np

from .arrays import columns


@runtime_checkable
class Lobe(Protocol):
    """What all BSDFs have in common; `Bsdf` and `SpecularBsdf` say how they scatter.

    A parameter whose default is a number or a tuple of three may be a texture, if `row` hands it on under its own name. What
    textures give is cut off to `limits`, {parameter: (least, most)}, where the class has them, and never below 0.

    is_specular  light leaves in single directions, and shadow rays cannot find it
    transmits    light may pass the surface; a specular BSDF that does has a `transmittance` (r, g, b)

    A specular BSDF that light passes without a change of direction also says `is_straight = True` (see `is_straight`).
    """

    key: str
    label: str
    is_specular: bool
    transmits: bool

    @classmethod
    def black(cls):
        """The lobe that does nothing, for materials without it."""

    def row(self):
        """The parameters as {column: number or 3-tuple}."""

    def check(self, owner):
        """Raises SceneError, naming the material `owner`, for parameters out of range."""

    @staticmethod
    def albedo(k):
        """An upper bound, and the usual share, of light that goes on, (3, M) for the rows of `k`, by which lobes are chosen.

        It is in proportion to the parameters `reflectance` and `transmittance`, those that the lobe has: where parameters
        are textures, these are scaled down at each point until all lobes of a material together reflect at most 1.
        """


@runtime_checkable
class Bsdf(Lobe, Protocol):
    """A lobe with a width, at the shading normal `n` (3, N); `wo`, `wi` (3, N) are unit and leave the surface.

    One that does not transmit is asked for light from the side of `n`, one that does for light from the other side only:
    `eval` says nothing of wi on the side that is not the lobe's, where callers take f as 0. A transmitting lobe is that
    of a thin sheet: on both of its sides is the same medium.

    One whose value and density have most of their work in common also has eval_and_pdf(k, n, wo, wi), both to the bit.

    is_reciprocal  f is the same with wo and wi exchanged
    is_diffuse     what it scatters is called diffuse, not glossy, where textures ask
    """

    is_reciprocal: bool
    is_diffuse: bool

    @staticmethod
    def eval(k, n, wo, wi):
        """BSDF value f [sr^-1], (3, N), or (3, 1) where it is the same for all lanes."""

    @staticmethod
    def illuminate(k, n, wo, wi):
        """The lobe's term of the lecture's illumination model, k_d (n . l) or k_s (r_l . v)^n, (3, N); not physical."""

    @staticmethod
    def sample(k, n, wo, u2):
        """Directions wi (3, N), unit, distributed as `pdf`; they may fall on the other side of the horizon, where f is 0."""

    @staticmethod
    def pdf(k, n, wo, wi):
        """Density of `sample` over solid angle [sr^-1], (N,)."""


@runtime_checkable
class SpecularBsdf(Lobe, Protocol):
    """A lobe without width: a mirror, a smooth boundary. `n` (3, N) is on the side of `wo`."""

    @staticmethod
    def scatter(k, n, wo, is_front, u1):
        """Directions wi (3, N), and weight = f |cos| / probability (3, N); `is_front` (N,) says on which side wo is."""

    @staticmethod
    def branches(k, n, wo, is_front):
        """All directions that light comes from, a tuple of (wi (3, N), weight (3, N)): what `scatter` does on average.

        The weight, (3, 1) where it is the same for all lanes, is 0 where there is no such direction: beyond the critical
        angle nothing is refracted. A table `k` whose `ior` is (3, N), an index for each channel, gets a refracted
        direction for each; the first has all the light where they are the same.
        """


def albedo_of(lobe):
    """`Lobe.albedo` of a BSDF value without textures: three numbers."""
    return tuple(type(lobe).albedo(columns([lobe.row()], np.float64))[:, 0].tolist())


def is_straight(bsdf):
    """Whether light passes `bsdf` (class or value) straight on: shadow rays, too, and light is found beyond as if it came direct."""
    return getattr(bsdf, "is_straight", False)


def lets_shadow_rays_pass(bsdf, tints_glass):
    """Whether `bsdf` (class or value) weakens shadow rays by its transmittance instead of blocking them, see `Integrator.tints_glass`."""
    return is_straight(bsdf) or (tints_glass and bsdf.is_specular and bsdf.transmits)


@runtime_checkable
class Texture(Protocol):
    """A value that varies over surfaces: a pattern, a picture, what is computed from others, what is known of a point.

    It may stand for any parameter of a lobe, and for the emission of a material. Where it does, what is below 0 or no number
    counts as 0, and a parameter that is a number takes the luminance of a colour. Textures are what they are: two with
    the same fields are two. Fields annotated `object` are inputs: a number, three numbers, or a texture.

    A texture also says, where it is so: `is_pure = False`, it is no function of its inputs alone (see `is_pure`), and then
    `asks_for_cosine = True`, but of these and of how it is looked at (see `asks_for_cosine`); and `has_detail = True`, it is
    averaged over footprints, so that rays have to carry them (see `has_detail`). One that has `coordinates` and, seen as a
    sky, disks much brighter than around, has a method `spots`() that yields (unit vector, radius [rad]) of each.
    """

    key: str
    label: str

    def check(self, owner):
        """Raises SceneError, naming `owner`, such as "material 'Wood'", for options out of range."""

    def eval(self, at):
        """The value at points: float32 (3, N) for a colour or vector, (1, N) for a number; one column where it is the same for all.

        `at` (see `world.texturing.TexturePoints`) has `at.value(x)`, the value of an input; `at.look_up(where)`, the points
        (3, N) that an input or `Coordinates` stands for, and None or the half-axes of footprints, two (3, N), to average
        over; `at.once(key, function)`, what several textures share.
        """


def is_pure(texture):
    """Whether a texture is a function of its inputs alone, and so a constant where they are."""
    return getattr(texture, "is_pure", True)


def asks_for_cosine(texture):
    """Whether a texture asks no more of a point than the cosine of the ray to the shading normal, and which side is met."""
    return getattr(texture, "asks_for_cosine", False)


def has_detail(texture):
    """Whether a texture is averaged over footprints."""
    return getattr(texture, "has_detail", False)


@runtime_checkable
class Light(Protocol):
    """A light object that is no mesh; it gives light and casts no shadow.

    `is_visible` (bool) is a field of every light value: camera rays see it. Scattered rays do unless they are of a kind that it is
    `hidden_from`, another field, a tuple of names of `scene.visibility.RAY_KINDS`. So is `shade`, a `Shade` or None.
    A light that can be thought of as a point also has middle(k): the numbers u2, (2, M) or (2, 1), with which `sample`
    finds its middle.
    """

    key: str
    label: str

    def row(self, frame):
        """The parameters in render space (see world.frame), as {column: number or 3-tuple}."""

    def power(self, radius=1.0):
        """Radiant flux [W], (r, g, b), or a bound of it, into a scene of `radius` [m]."""

    def check(self):
        """Raises SceneError, naming the light, for parameters out of range."""

    def weight(self, frame):
        """What the light may weigh at a place in render space: power (r, g, b) / (nearness * distance^2 + radius2).

        power is the radiant intensity into the brightest direction, distance is taken from `centre`; a light that is
        the same everywhere has nearness 0 and radius2 1. It shines where the cosine between `axis` and the way from its
        centre is at least `cos_edge`. Returns {centre, power, nearness, radius2, axis, cos_edge}.
        """

    def has_extent(self):
        """Whether rays can meet the light at all."""

    @staticmethod
    def sample(k, p, u2):
        """Towards a point on the light, seen from p (3, N): wi (3, N), distance (N,), E (3, N), pdf (N,).

        E = L / pdf [W m^-2] is what one sample adds to the irradiance of a surface that faces the light. pdf is the
        density over solid angle [sr^-1]; inf for a light without a size, which no scattered ray can meet.
        """

    @staticmethod
    def hit(k, o, d):
        """Where rays meet the light: t (N,), inf for a miss; L (3, N) towards the ray; pdf (N,) of `sample` at o."""

    @staticmethod
    def seen(k, p, d, distance):
        """What textures are told where rays along d (3, N) from p (3, N) meet the light at `distance` (N,).

        The place (3, N), render space; the normal (3, N) there; and texture coordinates uv (2, N). Rows `k` also have the columns
        of `world.shades.place_columns`. A light that `is_distant` (a class attribute) has directions as places.
        """


@runtime_checkable
class Camera(Protocol):
    """Where paths begin; render space is centred on its `position` (3,) [m].

    Every camera value has fields `name`, `world_from_camera` (4, 4), `clip_start` and `clip_end` [m], a `lens`, and `motion`
    (K, 4, 4), see `scene.motion`; what it says of itself is how it is at the middle of the shutter.
    Film positions x, y (N,) [px] are measured from the middle of the frame, y down.
    """

    key: str
    label: str
    position: object

    def row(self, width, height, scale):
        """The parameters for a frame of width x height pixels, in render space of `scale` [m^-1], those of the lens included."""

    def check(self):
        """Raises SceneError, naming the camera, for parameters out of range; the lens and clip range are checked elsewhere."""

    def in_window(self, p):
        """Where x, y (N,) in the full frame points p (3, N) are, from 0 at its left and bottom to 1.

        p is in the camera's frame, but that it looks along +z [m].
        """

    @staticmethod
    def rays(k, x, y):
        """Origins and unit directions (3, N) of a pinhole camera's rays."""

    @staticmethod
    def lens_rays(k, x, y, lens):
        """The same from points `lens` (2, N) of the aperture, right and up, through what is in focus; `rays` where they are 0."""

    @staticmethod
    def depth(k, p):
        """How far points p (3, N) are away, (N,), as passes and the clip range measure it."""

    @staticmethod
    def distance(k, p):
        """How far points p (3, N) are away, (N,), for what fades with distance."""

    @staticmethod
    def ray_per_depth(k, d):
        """Length of rays along d (3, N) per unit of depth, (N,)."""


@runtime_checkable
class Sampler(Protocol):
    """Random numbers as a pure function of pixel, sample and dimension.

    A sampler for which neighbouring pixels matter also has pixel_key(px, py, width, seed): its own keys (P,) uint32 for
    pixels px, py (P,) of a frame that is `width` wide. All others are given hashes (`wavefront.numbers.hashed_pixel`).
    """

    key: str
    label: str

    @staticmethod
    def one(key, sample, dimension, samples):
        """u1 (N,) in [0, 1): key (N,) uint32 of the pixel, sample (N,) uint32 of `samples`, dimension int."""

    @staticmethod
    def two(key, sample, dimension, samples):
        """u2 (2, N) in [0, 1)."""


@runtime_checkable
class Filter(Protocol):
    """A pixel filter, sampled by its own shape so that every sample weighs the same.

    One with negative lobes also has negative_mass (of the integral of |f| below 0, where that of f is 1) and
    negative_offset(u2, width), which samples there as `offset` does where f is positive (`wavefront.signed_filter`).
    """

    key: str
    label: str

    @staticmethod
    def offset(u2, width):
        """Offsets from the pixel's centre [px], (2, N), distributed as the filter of full width `width` [px]."""


@runtime_checkable
class Pass(Protocol):
    """One result of a render: as many channels as `channels` has letters.

    records     what it writes down along the way, (C, slots), which is `background` before:
                "first hit": `values(plan, rays, surface, reflection)` (C, M) where camera rays hit;
                "light": of all light that `wavefront.film.Film.add` is told of its `part(plan, rays, lanes, L, light, bounces)` (C, M);
                "first hit and light": the sum of both, its `background` is 0;
                "": nothing, it is what `gather(film)` (C, slots) makes of the film at the end
    reduction   what a pixel is of its samples: their "mean", the "first" of them, their "sum", or of "ranks": what covers most of it;
                then there are two `rows` of values, a number and how much it counts, see `wavefront.ranks`; or of "replicates": the
                pass says by `of(replicates)` (C, P) what it makes of how much their radiances differ, see `wavefront.replicates`
    divided_by  the pass whose share it is, and by which it is divided at the end; "" for none; its own key: there are twice as many
                `rows` of values as channels, and the first half is divided by the second

    One that looks up what meshes and objects bring has `attributes`, keys as in `world.attributes`; `facts(scene, layer)`
    {str: str}, if there are any, are what files have to say of it. Passes that scenes name are of families, see `Registry`.

    One of first hits whose values are weighed by what surfaces cover (`wavefront.passing.opacity`) says `covers = True`: they are
    added up over all surfaces that camera rays pass straight on, where those that pass are rays of their own.
    One that sends shadow rays of its own says `sends_shadow_rays = True`.
    One that records light and asks by which kinds of lobes it has left the first surface says `is_split = True`, see
    `wavefront.splitting`.
    """

    key: str
    label: str
    channels: str
    records: str
    reduction: str
    divided_by: str


@runtime_checkable
class Integrator(Protocol):
    """What an integrator puts onto the stack of the loop; everything else is the same loop for all of them.

    is_complete     it finds all light, so its pictures are those of path tracing but for the noise
    samples_lights  shadow rays look for lights; else only scattered rays find them
    splits_specular specular lobes have rays of their own, the others are chosen among rough ones
    splits_white    dispersion sends a ray for each channel; else every path has a wavelength
    tints_glass     shadow rays pass specular surfaces that transmit, weakened by their transmittance; and what passes
                    straight on is a ray of its own, as all branches of specular lobes are
    on_surface      the stages (plan, rays, surface, reflection, film) that do it
    to_lights       the points on lights (plan, rays, surface), see `wavefront.direct.to_one_light`, for passes that ask what is in the way
    """

    key: str
    label: str
    is_complete: bool
    samples_lights: bool
    splits_specular: bool
    splits_white: bool
    tints_glass: bool
    on_surface: tuple
    to_lights: object

    @staticmethod
    def scatter(plan, rays, surface, reflection):
        """The batches of rays, any iterable, that go on from where `rays` met `surface`; a generator makes them one by one."""
