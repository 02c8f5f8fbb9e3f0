"""Materials as tables of lobes: every surface point reflects by the sum of its material's lobes."""

from dataclasses import dataclass, replace

import numpy as np

from ..arrays import Columns, columns, gather
from ..constants import INV_PI
from ..interfaces import is_straight
from ..maths.frames import to_world
from ..maths.vectors import dot
from ..maths.warps import square_to_uniform_hemisphere
from ..scene.textured import averaged, is_number, luminance, textures_of
from .texturing import clean

_FAINT = 2.0**-10
"""Radiance that a texture counts with where it is found black: it may still glow in places."""


@dataclass(frozen=True, slots=True)
class Lobe:
    """One lobe of every material: a BSDF plug-in and its parameters, a row per material (black where it has none)."""

    bsdf: type
    k: Columns


@dataclass(frozen=True, slots=True)
class Textured:
    """A column of one lobe's table that a texture fills in; `is_number`: with its luminance; cut off to `limits`, if any."""

    lobe: int
    column: str
    is_number: bool
    texture: object
    limits: tuple

    def value(self, at):
        """What stands in the column at `Points`."""
        value = clean(at.value(self.texture))
        if self.is_number:
            value = luminance(value)
        return np.clip(value, *self.limits) if self.limits else value


@dataclass(frozen=True, slots=True)
class Materials:
    """All materials of a world.

    lobes       one `Lobe` for each BSDF and for each further lobe of the same BSDF that some material has; specular ones last
    thresholds  (lobes - 1, M) float32: a material samples the lobe whose interval of [0, 1) holds u1
    shares      (lobes, M) float32: the probability of each lobe, in proportion to its albedo
    emission    (3, M) [W m^-2 sr^-1]
    shine       (3, M), the same, but 1 where a texture gives it
    ambient     (3, M), k_a
    kind        `Reflection`, or `TwoSided` where a lobe with a width transmits
    textured    {row: the `Textured` columns of that material; none, if but what passes straight on is textured}
    straight    {row: the transmittances of that material's lobes that light passes straight on, if it has textured ones}
    glowing     {row: the texture that is the emission of that material}
    relief      {row: the reliefs of that material}
    index       (M,) float32, `Material.index`
    names       of the materials, a tuple
    aovs        {name: {row: value}} of `Material.aovs`
    wanted      {attribute of meshes: rows of the materials whose textures are looked up there}
    Where there is a texture, the tables hold its average.
    """

    lobes: tuple
    thresholds: np.ndarray
    shares: np.ndarray
    emission: np.ndarray
    shine: np.ndarray
    ambient: np.ndarray
    kind: type
    textured: dict
    straight: dict
    glowing: dict
    relief: dict
    index: np.ndarray
    names: tuple
    aovs: dict
    wanted: dict

    @classmethod
    def of(cls, materials, bsdfs, without=(), real=np.float32):
        """Compile `materials`; `bsdfs` are the plug-ins to make room for, wanted or not, `without` parameters nobody asks for.

        Parameters and colours are of the dtype `real`; probabilities are float32, as the numbers are that choose by them.
        """
        bsdfs = sorted(bsdfs, key=lambda bsdf: bsdf.is_specular)
        slots = [(bsdf, i) for bsdf in bsdfs for i in range(max(1, max(_count(m, bsdf) for m in materials)))]
        lobes, albedos, textured = [], np.zeros((len(slots), len(materials)), np.float32), {}
        for slot, (bsdf, i) in enumerate(slots):
            chosen = [next(iter([lobe for lobe in m.lobes if type(lobe) is bsdf][i:]), bsdf.black()) for m in materials]
            for row, lobe in enumerate(chosen):
                for name, texture in textures_of(lobe).items():
                    limits = getattr(bsdf, "limits", {}).get(name, ())
                    textured.setdefault(row, []).append(Textured(slot, name, is_number(lobe, name), texture, limits))
            chosen = [averaged(lobe) for lobe in chosen]
            rows = [{name: value for name, value in lobe.row().items() if name not in without} for lobe in chosen]
            lobes.append(Lobe(bsdf, columns(rows, real)))
            albedos[slot] = luminance(bsdf.albedo(lobes[-1].k))
        for row, material in enumerate(materials):
            passed = [lobe for lobe in material.lobes if _is_passed(lobe, bsdfs)]
            if len(passed) < len(material.lobes) and any(map(textures_of, passed)):
                # Where more passes, less is left for the others, constant as they may be.
                textured.setdefault(row, [])
        shares = _shares(albedos)
        emission, ambient = (_colours((getattr(averaged(m), name) for m in materials), real) for name in ("emission", "ambient"))
        kind = TwoSided if any(bsdf.transmits and not bsdf.is_specular for bsdf in bsdfs) else Reflection
        glowing = {row: textures_of(m)["emission"] for row, m in enumerate(materials) if "emission" in textures_of(m)}
        unseen = [row for row in glowing if not emission[:, row].any()]
        emission[:, unseen] = _FAINT
        relief = {row: m.relief for row, m in enumerate(materials) if m.relief}
        index = np.array([m.index for m in materials], np.float32)
        names = tuple(m.name for m in materials)
        wanted, aovs = {}, {}
        for row, material in enumerate(materials):
            for attribute in material.attributes:
                wanted.setdefault(attribute, set()).add(row)
            for name, value in material.aovs:
                aovs.setdefault(name, {})[row] = value
        straight = {row: [lobe.transmittance for lobe in materials[row].lobes if _is_passed(lobe, bsdfs)] for row in textured}
        shine = emission.copy()
        shine[:, list(glowing)] = 1
        per_row = textured, straight, glowing, relief, index, names, aovs
        return cls(tuple(lobes), thresholds_of(shares), shares, emission, shine, ambient, kind, *per_row, wanted)

    @property
    def rough_lobes(self):
        """How many lobes have a width, and so can be reached by shadow rays."""
        return sum(not lobe.bsdf.is_specular for lobe in self.lobes)

    def at(self, surface):
        """The `Reflection` of a `Surface`."""
        lobes = self.lobes
        # One row broadcasts over all lanes.
        if self.emission.shape[1] > 1:
            lobes = [Lobe(lobe.bsdf, lobe.k.take(surface.material)) for lobe in lobes]
        thresholds, shares = self.thresholds, self.shares
        if len(lobes) > 1 and self.emission.shape[1] > 1:
            thresholds, shares = (gather(a, surface.material) for a in (thresholds, shares))
        return self.kind(tuple(lobes[: self.rough_lobes]), tuple(lobes[self.rough_lobes :]), thresholds, shares)


def _colours(colours, real):
    return np.array([*colours], real).T.reshape(3, -1)


def _shares(albedos):
    """Probabilities (L, M) float32 in proportion to albedos (L, M) float32; all the same where they are 0."""
    total = albedos.sum(axis=0, dtype=np.float32)
    return np.where(total > 0, albedos / np.where(total > 0, total, 1), np.float32(1 / max(len(albedos), 1)))


def thresholds_of(shares):
    """Where the intervals of [0, 1) that belong to shares (L, M) end, but for the last one: (L - 1, M) float32."""
    return np.cumsum(shares[:-1], axis=0, dtype=np.float64).astype(np.float32)


def _is_passed(lobe, bsdfs):
    """Whether light passes `lobe` on its way, so that there is no room for it among `bsdfs`."""
    return is_straight(lobe) and type(lobe) not in bsdfs


def _count(material, bsdf):
    return sum(type(lobe) is bsdf for lobe in material.lobes)


@dataclass(frozen=True, slots=True, eq=False)
class Reflection:
    """The lobes of N surface points, added up.

    rough       lobes with a width: together a BSDF, of which `eval` is the sum and `pdf` the density of `sample`
    specular    lobes without: what they do is known only by doing it
    thresholds, shares as in `Materials`, a column for each point or one for all
    """

    rough: tuple
    specular: tuple
    thresholds: np.ndarray
    shares: np.ndarray

    def eval(self, n, wo, wi):
        """f [sr^-1], (3, N), and pdf [sr^-1], (N,), of wi, by the rough lobes."""
        if len(self.shares) == len(self.rough) == 1:
            (only,) = self.rough
            f, pdf = _eval_and_pdf(only.bsdf, only.k, n, wo, wi)
            return self._on_its_side(only, f, n, wi), pdf
        f, pdf = 0, 0
        for lobe, share in zip(self.rough, self.shares):
            value, density = _eval_and_pdf(lobe.bsdf, lobe.k, n, wo, wi)
            f = f + self._on_its_side(lobe, value, n, wi)
            pdf = pdf + density * share
        return f, pdf

    def illuminate(self, n, wo, wi):
        """The terms of the lecture's illumination model, (3, N), by the rough lobes."""
        return self._added("illuminate", n, wo, wi)

    def cosine(self, surface, wi):
        """|cos| (N,) of wi to the shading normals of `surface` where light from wi counts, 0 elsewhere.

        Below the geometric surface there is nothing to reflect into, and light from there would leak through it.
        """
        cos = dot(surface.ns, wi)
        return cos * ((cos > 0) & (dot(surface.n, wi) > 0))

    def scatter(self, surface, u1, u2, uniformly=False):
        """One direction on from each point of `surface`: wi (3, N), weight = f |cos| / pdf (3, N), and pdf (N,).

        u1 (N,) chooses the lobe (None where there is but one), u2 (2, N) the direction; `uniformly` over the hemisphere (the
        sphere, if lobes transmit) instead of as the rough lobes have it. The pdf of a specular lobe is inf: nothing else
        can find what it finds.
        The weight is 0, or not a number, where nothing goes on.
        """
        if self.rough:
            wi = self._sample_uniformly(surface.ns, u2) if uniformly else self._sample_rough(surface.ns, surface.wo, u1, u2)
            f, pdf = self.eval(surface.ns, surface.wo, wi)
            if uniformly:
                pdf = np.full_like(wi[0], self._uniform_pdf) * self._rough_share()
            # Paths that end here still count.
            weight = f * (self.cosine(surface, wi) / pdf)
        else:
            wi, weight, pdf = np.zeros_like(surface.wo), np.zeros_like(surface.wo), np.zeros_like(surface.wo[0])
        for i, lobe in enumerate(self.specular, start=len(self.rough)):
            lanes = self._chosen(i, u1, u2)
            ((wi[:, lanes], turned),) = _at_surface(_single(lobe.bsdf.scatter, u2[0]), lobe.k, surface, lanes)
            weight[:, lanes] = turned / (np.broadcast_to(self.shares[i], pdf.shape).take(lanes) if u1 is not None else 1)
            pdf[lanes] = np.inf
        return wi, weight, pdf

    def branches(self, surface):
        """Every direction into which the specular lobes send light, one after the other: wi (3, N), weight (3, N).

        The weight is 0 where nothing goes there.
        """
        lanes = np.arange(surface.wo.shape[1])
        for lobe in self.specular:
            yield from _at_surface(_all(lobe.bsdf.branches), lobe.k, surface, lanes)

    def with_lobes(self, lobes, shares):
        """The same with other parameters `lobes`, rough ones first, and the probabilities `shares` (L, N) in proportion."""
        shares, rough = _shares(shares), len(self.rough)
        return type(self)(tuple(lobes[:rough]), tuple(lobes[rough:]), thresholds_of(shares), shares)

    def with_indices(self, find, n):
        """The same with the indices of refraction `find`(k), (N,) or (3, N), or (3, 1) for all n lanes, in lobes that have one."""
        return replace(self, specular=tuple(_with_index(lobe, find, n) if hasattr(lobe.k, "ior") else lobe for lobe in self.specular))

    def of_direction(self, surface, wi):
        """The same, whose `chosen_lobe` among the rough ones is by how much each sends on of light from wi (3, N).

        For directions that no lobe was chosen for. To choose a specular lobe takes the same numbers as before.
        """
        count = len(self.rough)
        if count < 2:
            return self
        n, wo = surface.ns, surface.wo
        values = [np.broadcast_to(replace(self, rough=(lobe,)).value(n, wo, wi), wi.shape).sum(axis=0) for lobe in self.rough]
        thresholds = np.cumsum(values, axis=0)
        thresholds *= np.divide(self._rough_share(), thresholds[-1], out=np.zeros_like(wi[0]), where=thresholds[-1] > 0)
        last = np.broadcast_to(self.thresholds[count - 1 :], (len(self.thresholds) - count + 1, wi.shape[1]))
        return replace(self, thresholds=np.concatenate((thresholds[:-1], last)))

    def without_specular(self):
        """The rough lobes alone."""
        if not self.specular:
            return self
        return replace(self, specular=()).with_lobes(self.rough, self.shares[: len(self.rough)])

    def chosen_lobe(self, count, u1):
        """Which lobe, rough ones first, `scatter` takes for the numbers u1 (count,): (count,) intp; None: there is but one."""
        return np.zeros(count, np.intp) if u1 is None else (u1 >= self.thresholds).sum(axis=0)

    def by_kind(self):
        """The reflection by diffuse, by glossy, and by all other lobes, which transmit; the shares are still those of all."""
        kinds = [[], [], []]
        for lobe in self.rough:
            kinds[0 if lobe.bsdf.is_diffuse else 2 if lobe.bsdf.transmits else 1].append(lobe)
        return tuple(replace(self, rough=tuple(lobes), specular=()) for lobes in kinds)

    def value(self, n, wo, wi):
        """f [sr^-1], (3, N) or what broadcasts to it, of wi, by the rough lobes."""
        return self._added("eval", n, wo, wi)

    def _added(self, term, n, wo, wi):
        found = ((lobe, getattr(lobe.bsdf, term)(lobe.k, n, wo, wi)) for lobe in self.rough)
        return sum(self._on_its_side(lobe, value, n, wi) for lobe, value in found)

    def _on_its_side(self, lobe, value, n, wi):
        """The `value` (3, N) of a lobe where it counts, 0 elsewhere."""
        return value

    def _sample_rough(self, n, wo, u1, u2):
        if not len(self.thresholds):
            (only,) = self.rough
            return only.bsdf.sample(only.k, n, wo, u2)
        wi = np.zeros_like(wo)
        for i, lobe in enumerate(self.rough):
            lanes = self._chosen(i, u1, u2)
            wi[:, lanes] = lobe.bsdf.sample(lobe.k.pick(lanes), gather(n, lanes), gather(wo, lanes), gather(u2, lanes))
        return wi

    _uniform_pdf = 0.5 * INV_PI

    @staticmethod
    def _sample_uniformly(n, u2):
        return to_world(n, square_to_uniform_hemisphere(u2))

    def _rough_share(self):
        """The probability with which one of the rough lobes is chosen."""
        return self.shares[: len(self.rough)].sum(axis=0, dtype=np.float32) if self.specular else np.float32(1)

    def _chosen(self, i, u1, u2):
        """The lanes whose u1 falls to lobe i."""
        n = u2.shape[1]
        if u1 is None:
            return np.arange(n)
        is_chosen = np.ones(n, bool) if i == 0 else u1 >= self.thresholds[i - 1]
        if i < len(self.thresholds):
            is_chosen = is_chosen & (u1 < self.thresholds[i])
        return np.nonzero(is_chosen)[0]


class TwoSided(Reflection):
    """Lobes of which some transmit: each counts on its own side, and between shading and geometric normal none does."""

    __slots__ = ()
    _uniform_pdf = 0.25 * INV_PI

    def cosine(self, surface, wi):
        """See `Reflection.cosine`; light counts on both sides, if both normals agree which one it is."""
        cos = dot(surface.ns, wi)
        return np.abs(cos) * (cos * dot(surface.n, wi) > 0)

    def _on_its_side(self, lobe, value, n, wi):
        return value * ((dot(n, wi) < 0) == lobe.bsdf.transmits)

    @staticmethod
    def _sample_uniformly(n, u2):
        # Half of the numbers for each side.
        twice = 2 * u2[0]
        is_behind = twice >= 1
        w = to_world(n, square_to_uniform_hemisphere(np.stack((twice - is_behind, u2[1]))))
        return np.where(is_behind, -w, w)


def _eval_and_pdf(bsdf, k, n, wo, wi):
    """`Bsdf.eval` and `Bsdf.pdf` at once."""
    both = getattr(bsdf, "eval_and_pdf", None)
    return both(k, n, wo, wi) if both else (bsdf.eval(k, n, wo, wi), bsdf.pdf(k, n, wo, wi))


def _with_index(lobe, find, n):
    k = Columns(**{name: np.broadcast_to(column, (*column.shape[:-1], n)) for name, column in vars(lobe.k).items()})
    ior = find(lobe.k)
    k.ior = np.broadcast_to(ior, (*ior.shape[:-1], n))
    return replace(lobe, k=k)


def _all(branches):
    """A lobe's `branches`, which need no number."""
    return lambda k, n, wo, is_front, lanes: branches(k, n, wo, is_front)


def _single(scatter, u1):
    """A lobe's `scatter` as if it were its `branches`: the one direction that u1 (N,) chooses."""
    return lambda k, n, wo, is_front, lanes: (scatter(k, n, wo, is_front, gather(u1, lanes)),)


def _at_surface(branches, k, surface, lanes):
    """The branches (wi, weight) of a specular lobe, `k` a row for each point of `surface` or one for all, at its points `lanes`."""
    n, ns, wo = (gather(a, lanes) for a in (surface.n, surface.ns, surface.wo))
    is_front = gather(surface.is_front, lanes)
    for i, (wi, weight) in enumerate(branches(k.pick(lanes), ns, wo, is_front, lanes)):
        # Where the shading normal is turned away, or would send reflected light through the surface or refracted light
        # back, the geometric one decides: specular light has no other way to go, and would be lost.
        astray = np.nonzero((dot(ns, wo) <= 0) | ((dot(n, wi) > 0) != (dot(ns, wi) > 0)))[0]
        if astray.size:
            weight = np.array(np.broadcast_to(weight, wi.shape))
            there = lanes.take(astray)
            turned = branches(k.pick(there), n.take(astray, axis=1), wo.take(astray, axis=1), is_front.take(astray), there)
            wi[:, astray], weight[:, astray] = turned[i]
        yield wi, weight
