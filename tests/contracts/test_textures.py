"""What every texture promises (`interfaces.Texture`), checked for every class in the registry; EXAMPLES adds known ones."""

import dataclasses

import numpy as np
import pytest

from glanz.engine import (
    TEXTURES,
    Attribute,
    Average,
    Bitmap,
    BrickTexture,
    BumpMap,
    CameraData,
    CheckerTexture,
    Coordinates,
    Fresnel,
    GaborTexture,
    Geometry,
    GradientTexture,
    ImageTexture,
    LayerWeight,
    LightPath,
    LinearTexture,
    Luminance,
    MagicTexture,
    NoiseTexture,
    NormalMap,
    ObjectValue,
    SceneError,
    SkyTexture,
    Tangent,
    VectorTransform,
    VoronoiTexture,
    WaveTexture,
    WhiteNoiseTexture,
    Wireframe,
)
from glanz.engine.interfaces import Texture
from glanz.engine.maths.fractals import FRACTALS
from glanz.engine.maths.voronoi import FEATURES
from glanz.engine.scene.coordinates import GENERATED, UV
from glanz.engine.scene.graphs import with_inner
from glanz.engine.scene.points import OnPlane, Probes, average_of
from glanz.engine.scene.textured import folded
from glanz.engine.textures.gradient import _SHAPES
from glanz.engine.textures.sky import MODELS
from glanz.engine.textures.wave import _PROFILES as PROFILES, _SHAPES as SHAPES
from glanz.tests import helpers as h
from glanz.tests.contracts.converters import CONVERTERS, REFUSED, grows_beyond_numbers

PICTURE = Bitmap(name="picture", pixels=np.random.default_rng(1).integers(0, 256, (3, 9, 16)).astype(np.uint8))
BRIGHT = Bitmap(name="bright", pixels=np.random.default_rng(2).random((3, 4, 5), np.float32) * 3)
COVER = Bitmap(name="cover", pixels=np.random.default_rng(3).integers(0, 256, (4, 6, 4)).astype(np.uint8))
IMAGES = [ImageTexture(PICTURE, extension=e, is_smooth=s) for e in ("repeat", "extend", "clip", "mirror") for s in (True, False)]
SLOPE = Average(LinearTexture((LinearTexture((GENERATED,), (0.5,), (0.1, 0.2, 0.3)),), (1.0,), is_clipped=True))
"""A number that varies, from 0 to 1."""
EXAMPLES = {
    "image": [
        *IMAGES,
        ImageTexture(BRIGHT),
        ImageTexture(PICTURE, is_cubic=True),
        ImageTexture(COVER, output="uncut"),
        ImageTexture(COVER, output="alpha", extension="mirror"),
        ImageTexture(PICTURE, projection="sphere"),
        ImageTexture(PICTURE, projection="tube"),
        ImageTexture(PICTURE, GENERATED, projection="box", normal=NoiseTexture(is_coloured=True), blend=0.3),
        ImageTexture(tiles=((1001, PICTURE), (1012, BRIGHT))),
    ],
    "checker": [CheckerTexture((0.9, 0.1, 0.3), (0.0, 0.5, 0.3)), CheckerTexture(scale=2.0, output="fac")],
    "noise": [
        NoiseTexture(is_coloured=True, detail=3.5),
        NoiseTexture(distortion=2.0),
        NoiseTexture(is_normalized=False),
        *(NoiseTexture(kind=kind, offset=0.7, gain=1.5, dimensions=i % 3 + 2) for i, kind in enumerate(FRACTALS)),
        NoiseTexture(dimensions=1, w=SLOPE, is_coloured=True),
        NoiseTexture(scale=SLOPE, detail=SLOPE, roughness=SLOPE, lacunarity=SLOPE, distortion=SLOPE),
    ],
    "voronoi": [
        *(VoronoiTexture(feature=f, output=o, dimensions=3) for f in FEATURES for o in ("distance", "color", "position")),
        VoronoiTexture(feature="f2", metric="minkowski", output="w", dimensions=4, w=SLOPE, is_integer=False),
        VoronoiTexture(feature="distance to edge", detail=1.5, is_normalized=True, dimensions=2),
        VoronoiTexture(feature="n sphere radius", output="radius", is_integer=False),
        VoronoiTexture(feature="smooth f1", smoothness=SLOPE, detail=SLOPE, roughness=SLOPE, randomness=SLOPE, dimensions=2),
        VoronoiTexture(metric="manhattan", dimensions=1, w=SLOPE, output="color"),
    ],
    "white noise": [*(WhiteNoiseTexture(dimensions=d, output=o, w=SLOPE) for d in (1, 2, 3, 4) for o in ("value", "color"))],
    "wave": [
        *(WaveTexture(shape=shape) for shape in SHAPES),
        *(WaveTexture(profile=profile, distortion=SLOPE, detail=SLOPE) for profile in PROFILES),
    ],
    "magic": [MagicTexture(depth=d, distortion=SLOPE, output=o) for d in (0, 4, 10) for o in ("color", "fac")],
    "brick": [BrickTexture(), BrickTexture(mortar_size=SLOPE, width=SLOPE, bias=SLOPE, shift_every=3, squash=0.7, output="fac")],
    "gabor": [
        GaborTexture(frequency=SLOPE, anisotropy=SLOPE),
        *(GaborTexture(dimensions=3, anisotropy=0.5, output=output) for output in ("value", "phase", "intensity")),
    ],
    "gradient": [GradientTexture(shape) for shape in _SHAPES],
    "sky": [SkyTexture(model, has_disk=False, air=0.1, haze=0.1) for model in MODELS],
    "linear": [
        LinearTexture((IMAGES[0], NoiseTexture(is_normalized=False)), ((0.5, -0.25, 1.0), (0.1, 2.0, -1.0)), (0.1, 0.2, 0.3)),
        LinearTexture((ImageTexture(BRIGHT),), ((0.5, 0.5, 0.5),), is_clipped=True),
        LinearTexture((NoiseTexture(), UV), (CheckerTexture(), 0.5), NoiseTexture(is_coloured=True)),
    ],
    "luminance": [Luminance(NoiseTexture(is_coloured=True))],
    "average": [Average(GENERATED)],
    "attribute": [Attribute("a", output) for output in ("colour", "number", "alpha", "opacity")],
    "object value": [ObjectValue("a", output) for output in ("colour", "number", "mean", "alpha")],
    "geometry": [
        Geometry(output) for output in ("normal", "object normal", "true normal", "incoming", "reflection", "parametric", "backfacing")
    ],
    "camera data": [CameraData(output) for output in ("window", "vector", "depth", "distance")],
    "fresnel": [Fresnel(), Fresnel(NoiseTexture(), Geometry("incoming"))],
    "layer weight": [LayerWeight(b, output=output) for b in (0.0, 0.3, NoiseTexture(), 1.0) for output in ("facing", "fresnel")],
    "tangent": [Tangent(direction) for direction in ("x", "y", "z", "uv")],
    "vector transform": [
        VectorTransform(NoiseTexture(is_coloured=True), kind, source, target)
        for kind in ("point", "vector", "normal")
        for source, target in (("world", "object"), ("object", "camera"), ("camera", "world"), ("object", "object"))
    ],
    "wireframe": [Wireframe(0.5), Wireframe(1.0, True)],
    "normal map": [
        NormalMap(NoiseTexture(is_coloured=True), 0.5, space=space)
        for space in ("tangent", "object", "world", "blender object", "blender world")
    ],
    "bump map": [BumpMap(NoiseTexture()), BumpMap(NoiseTexture(), NoiseTexture(), 0.5, Geometry("normal"), True)],
    **CONVERTERS,
}
ALL = [value for key, plugin in TEXTURES.items() for value in EXAMPLES.get(key, [plugin()])]
N = 4096

each = pytest.mark.parametrize("value", ALL, ids=lambda v: v.key)


class Points(OnPlane):
    """Points as textures are handed them: all coordinates are p (3, N), with footprints of half-axes `across` if any."""

    def look_up(self, where):
        return (self.p, self.across) if isinstance(where, Coordinates) else super().look_up(where)

    def beside(self, axis):
        return Points(self.p + self.across[axis], self.across)


def somewhere(seed=1, n=N, scale=8.0):
    return ((np.random.default_rng(seed).random((3, n)) - 0.25) * scale).astype(np.float32)


def colour(value, at):
    """eval, one column for each point."""
    found = value.eval(at)
    return np.broadcast_to(found, (3, at.p.shape[1]))


def square(radius, n=N):
    """Footprints of equal half-axes along x and y."""
    axes = np.zeros((2, 3, n), np.float32)
    axes[0, 0] = axes[1, 1] = radius
    return tuple(axes)


@pytest.mark.parametrize("plugin", TEXTURES.values(), ids=lambda p: p.key)
def test_a_texture_has_all_that_the_interface_asks_for(plugin):
    assert isinstance(plugin(), Texture)
    plugin().check("owner")
    # Graphs share their parts: comparing them field by field would take forever.
    assert plugin() != plugin()


@each
def test_values_are_finite_numbers_or_triples_of_single_precision(value):
    for axes in (None, square(0.01), square(1.0)):
        found = value.eval(Points(somewhere(), axes))
        assert found.dtype == np.float32
        assert found.shape[0] in (1, 3) and found.shape[1] in (1, N)
        assert np.isfinite(found).all()


@each
@pytest.mark.parametrize("size", [0.0, 1e-30, 1e6, 1e9])
def test_values_are_finite_near_and_far(value, size):
    p = somewhere(n=64, scale=2.0) * np.float32(size)
    p[:, :4] = np.float32([0, size, -size, 0.5 * size])
    found = value.eval(Points(p))
    assert np.isfinite(found).all() or (grows_beyond_numbers(value) and not np.isnan(found).any())


@pytest.mark.parametrize("plugin", TEXTURES.values(), ids=lambda p: p.key)
@pytest.mark.parametrize("wild", [0.0, -1.0, 1e30, np.inf, np.nan])
def test_inputs_may_be_any_numbers(plugin, wild):
    """What comes out may be no number, but comes out."""
    for field in dataclasses.fields(plugin):
        if field.type is object and isinstance(field.default, (float, tuple, Coordinates)):
            value = plugin(**{field.name: wild if isinstance(field.default, float) else (wild,) * 3})
            with np.errstate(all="ignore"):
                assert value.eval(Points(somewhere(n=16))).dtype == np.float32


@each
@pytest.mark.parametrize("fed", [SLOPE, LinearTexture((SLOPE,), ((1.0, 0.5, 0.25),))], ids=["number", "triple"])
def test_inputs_may_be_numbers_or_triples_that_vary(value, fed):
    """Sockets of any kind feed sockets of any kind; of three numbers where one is meant, as files may say, it is the first."""
    for field in dataclasses.fields(value):
        if field.type is object:
            found = dataclasses.replace(value, **{field.name: fed}).eval(Points(somewhere(n=64)))
            assert found.dtype == np.float32
            assert found.shape[0] in (1, 3) and found.shape[1] in (1, 64)


@each
def test_the_average_is_what_to_expect(value):
    """Over the unit cube, to 0.05: it is for choosing alone."""
    p = np.random.default_rng(3).random((3, 20_000)).astype(np.float32)
    assert np.abs(colour(value, Points(p)).mean(axis=1) - average_of(value)).max() <= 0.05


def test_the_average_catches_probes_in_one_half_of_the_cube(monkeypatch):
    monkeypatch.setattr(Probes, "attribute", lambda self, key: (0.5 * self.p, *np.eye(3, dtype=np.float32)[:2, :, None]))
    with pytest.raises(AssertionError):
        test_the_average_is_what_to_expect(LinearTexture((GENERATED,), (1.0,)))


def test_what_is_made_of_constants_alone_is_folded():
    assert folded(LinearTexture((), (), (0.5, 0.25, 1.0))) == (0.5, 0.25, 1.0)
    assert folded(Luminance((0.5, 0.5, 0.5))) == pytest.approx(0.5)
    for value in (Average(GENERATED), Luminance(NoiseTexture()), NoiseTexture()):
        assert folded(value) is value


def test_graphs_that_share_their_parts_are_evaluated_in_a_time_that_does_not_double_with_each_of_them():
    value = NoiseTexture()
    for _ in range(64):
        value = LinearTexture((value, value), (0.5, 0.5))
    assert len(with_inner(value)) == 65
    assert h.same_bits(colour(value, Points(somewhere())), colour(NoiseTexture(), Points(somewhere())))


@each
def test_lanes_are_independent(value):
    """One lane alone gives the bits that it gives among others."""
    p, axes = somewhere(n=1003), square(0.2, 1003)
    for across in (None, axes):
        whole = colour(value, Points(p, across))
        for lanes in (slice(0, 1), slice(500, 501), slice(7, 24)):
            part = colour(value, Points(p[:, lanes].copy(), across and tuple(a[:, lanes].copy() for a in across)))
            assert h.same_bits(part, whole[:, lanes].copy())


@each
def test_a_footprint_without_extent_is_a_point(value):
    """Up to rounding, and off the edges between texels or cubes."""
    p = somewhere()
    sharp, averaged = colour(value, Points(p)), colour(value, Points(p, square(0.0)))
    assert (np.abs(sharp - averaged).max(axis=0) <= 1e-5).mean() > 0.999


@each
def test_a_wide_footprint_sees_the_average(value):
    """As wide as many periods: the average, to 1 %; where there are no periods there is nothing to average over."""
    if value.key not in ("image", "checker", "noise") or getattr(value, "distortion", 0):
        return
    if isinstance(value, ImageTexture) and (value.projection != "flat" or value.tiles or value.output == "uncut"):
        return
    if any(getattr(t, "extension", "repeat") in ("extend", "clip") for t in with_inner(value)) or getattr(value, "dimensions", 3) == 1:
        return
    axes = np.full((2, 3, N), 100, np.float32) * np.float32([[[1]], [[0.7]]])
    found = colour(value, Points(somewhere(), tuple(axes)))
    # Octaves that weigh each other have no means of their own.
    tolerance = 0.06 if getattr(value, "kind", "") in ("hybrid multifractal", "ridged multifractal") else 0.01
    assert np.abs(found - whole(value)[:, None]).max() <= tolerance


def whole(value):
    """The mean over many periods, of pictures that of their texels: between them codes are interpolated, not light."""
    if isinstance(value, ImageTexture):
        value = dataclasses.replace(value, is_smooth=False)
    return colour(value, Points(somewhere(n=200_000, scale=64.0))).mean(axis=1)


def test_wide_footprints_catch_a_checker_that_ignores_them(monkeypatch):
    unfiltered = CheckerTexture.eval
    monkeypatch.setattr(CheckerTexture, "eval", lambda self, at: unfiltered(self, Points(at.p)))
    with pytest.raises(AssertionError):
        test_a_wide_footprint_sees_the_average(EXAMPLES["checker"][0])


@pytest.mark.parametrize(
    ("value", "word"),
    [
        (ImageTexture(PICTURE, extension="wrap"), "wrap"),
        (ImageTexture(PICTURE, projection="fold"), "fold"),
        (ImageTexture(PICTURE, output="depth"), "depth"),
        (ImageTexture(PICTURE, blend=1.5), "blend"),
        (ImageTexture(tiles=((1001, 5),)), "tiles"),
        (ImageTexture(Bitmap(name="holes", pixels=np.full((3, 2, 2), np.nan, np.float32))), "holes"),
        (NoiseTexture(kind="pink"), "pink"),
        (NoiseTexture(dimensions=5), "5 dimensions"),
        (VoronoiTexture(feature="f3"), "f3"),
        (VoronoiTexture(metric="taxi"), "taxi"),
        (VoronoiTexture(output="area"), "area"),
        (VoronoiTexture(dimensions=0), "dimensions is '0'"),
        (WhiteNoiseTexture(dimensions=5), "5 dimensions"),
        (WhiteNoiseTexture(output="grey"), "grey"),
        (WaveTexture(shape="bands"), "'bands'"),
        (WaveTexture(profile="square"), "square"),
        (MagicTexture(depth=11), "11"),
        (MagicTexture(output="grey"), "grey"),
        (BrickTexture(shift=float("nan")), "shift is nan"),
        (BrickTexture(squash_every=-1), "squash every -1"),
        (BrickTexture(output="grey"), "grey"),
        (CheckerTexture(output="grey"), "grey"),
        (GaborTexture(dimensions=4), "4 dimensions"),
        (GaborTexture(output="grey"), "grey"),
        (GradientTexture("steep"), "steep"),
        (LinearTexture((IMAGES[0],), ()), "factor"),
        (LinearTexture((IMAGES[0],), ((1, 2),)), "factor"),
        (Attribute("a", "beta"), "beta"),
        (ObjectValue("a", "beta"), "beta"),
        (Geometry("up"), "up"),
        (CameraData("up"), "up"),
        (LayerWeight(output="up"), "up"),
        (LightPath("red"), "red"),
        (Tangent("w"), "w"),
        (VectorTransform(kind="colour"), "colour"),
        (VectorTransform(target="screen"), "screen"),
        (NormalMap(space="screen"), "screen"),
        (BumpMap(width=0.0), "width"),
        *REFUSED,
    ],
)
def test_parameters_out_of_range_are_refused_by_name(value, word):
    with pytest.raises(SceneError, match=word) as error:
        value.check("material 'Wood'")
    assert "'Wood'" in str(error.value)


def test_coordinates_out_of_range_are_refused():
    with pytest.raises(SceneError, match="screen"):
        Coordinates(source="screen").check("material 'Wood'")
    with pytest.raises(SceneError, match="finite"):
        Coordinates(matrix=np.full((4, 4), np.inf)).check("material 'Wood'")
    with pytest.raises(SceneError, match="shape"):
        Coordinates(matrix=np.eye(3))
