"""What every BSDF promises (`interfaces.Bsdf`), checked for every class in the registry.

A new BSDF is checked with its default parameters without asking; EXAMPLES adds extremes of the known ones. The laws are
in tests/bsdf_laws.py.
"""

import dataclasses

import numpy as np
import pytest

from glanz.engine import (
    BlinnPhong,
    Gloss,
    Lambert,
    LambertTransmission,
    OrenNayar,
    Phong,
    PhongLecture,
    PhongTransmission,
    RoughRefraction,
    SceneError,
)
from glanz.engine.interfaces import Bsdf, albedo_of
from glanz.engine.maths.frames import to_world
from glanz.engine.maths.vectors import cosine_power, dot, reflect
from glanz.engine.maths.warps import square_to_cosine_power
from glanz.engine.registry import BSDFS
from glanz.tests import chance, helpers as h
from glanz.tests.bsdf_laws import (
    ANGLES,
    NORMAL,
    check_density_integrates_to_one,
    check_density_is_never_negative,
    check_dtype_is_kept,
    check_lanes_are_independent,
    check_no_more_leaves_than_albedo_says,
    check_reciprocity,
    check_samples_follow_the_density,
    viewer,
)

EXPONENTS = (0.0, 0.5, 1.0, 10.0, 1e3, 1e6)
EXAMPLES = {
    **{bsdf.key: [bsdf((1.0, 0.5, 0.25))] for bsdf in (Lambert, LambertTransmission)},
    **{bsdf.key: [bsdf((0.5, 0.25, 0.125), n) for n in EXPONENTS] for bsdf in (Phong, PhongLecture, BlinnPhong, PhongTransmission)},
    # Lobes whose axis is turned end where this quadrature does not look; `test_gloss` goes there.
    "gloss": [Gloss((0.5, 0.25, 0.125), n) for n in (0.0, 1.0, 10.0, 1000.0)],
    # With a colour of 1 as much leaves as arrives, to less than this quadrature says; `test_oren_nayar` goes there.
    "oren_nayar": [OrenNayar((1.0, 0.5, 0.25), 1.0, (0.8, 0.5, 0.25))],
    "rough_refraction": [RoughRefraction(), *(RoughRefraction((0.5, 0.25, 0.125), n, 1.0) for n in (0.0, 10.0))],
}
ALL = [value for key, plugin in BSDFS.items() if not plugin.is_specular for value in EXAMPLES.get(key, [plugin()])]

each = pytest.mark.parametrize("value", ALL, ids=lambda v: f"{v.key}-{getattr(v, 'exponent', getattr(v, 'roughness', ''))}")


@each
def test_a_bsdf_offers_the_interface(value):
    assert isinstance(value, Bsdf)
    assert BSDFS[value.key] is type(value)
    assert value.__doc__.strip()
    value.check("wood")
    assert len(albedo_of(value)) == 3


@each
def test_density_integrates_to_one_with_its_part_below_the_horizon(value):
    """Detects 1e-8 of the whole."""
    check_density_integrates_to_one(value)


@each
@chance.fresh
def test_samples_follow_the_density(value):
    """chi2 in 32 x 32 bins, 1e5 samples for each of 4 viewers; detects 4 % of the density in half of the bins."""
    check_samples_follow_the_density(value)


@each
def test_density_and_value_are_never_negative(value):
    check_density_is_never_negative(value)


@each
def test_light_may_travel_either_way_where_declared(value):
    """C6, and what is declared irreciprocal really is."""
    check_reciprocity(value)


@each
def test_no_more_light_leaves_than_albedo_says(value):
    """C7: by quadrature up to 1e-7 from grazing; detects a gain of 1e-9. That materials sum up to 1 is for `validate`."""
    check_no_more_leaves_than_albedo_says(value)


@pytest.mark.parametrize("value", [v for v in ALL if hasattr(v, "eval_and_pdf")], ids=lambda v: f"{v.key}-{v.exponent}")
def test_value_and_density_at_once_are_those_one_by_one(value):
    k, n, wo = h.table(value.row(), np.float32), NORMAL.astype(np.float32), viewer(ANGLES[1], np.float32)
    wi = h.directions(1, 256, np.float32)
    n, wo = np.repeat(n, 256, axis=1), np.repeat(wo, 256, axis=1)
    f, pdf = value.eval_and_pdf(k, n, wo, wi)
    assert h.same_bits(f, value.eval(k, n, wo, wi)) and h.same_bits(pdf, value.pdf(k, n, wo, wi))


@each
def test_dtype_is_kept(value):
    check_dtype_is_kept(value)


@each
def test_lanes_are_independent(value):
    check_lanes_are_independent(value)


@each
def test_nothing_is_nan_at_the_corners_of_the_unit_square(value):
    """Numbers 0 and the largest float32 below 1, seen straight, grazing and from the horizon itself."""
    u = np.array([0, 2.0**-24, 0.5, 1 - 2.0**-24], np.float32)
    u2 = np.stack(np.meshgrid(u, u)).reshape(2, -1)
    for angle in (*ANGLES, np.pi / 2):
        k, n = h.table(value.row(), np.float32), np.repeat(NORMAL, 16, 1).astype(np.float32)
        wo = np.repeat(viewer(angle, np.float32), 16, 1)
        wi = value.sample(k, n, wo, u2)
        assert np.isfinite(wi).all()
        assert np.isfinite(value.eval(k, n, wo, wi)).all()
        assert np.isfinite(value.pdf(k, n, wo, wi)).all()


@pytest.mark.parametrize("bsdf", [b for b in BSDFS.values() if "exponent" in {f.name for f in dataclasses.fields(b)}])
def test_parameters_out_of_range_are_refused_by_name(bsdf):
    for exponent in (-1.0, 1e7, float("nan")):
        with pytest.raises(SceneError, match=r"material 'brass': Phong exponent is (-1.0|10000000.0|nan)"):
            bsdf(exponent=exponent).check("brass")


# Mutants: what each law must refuse.


def phong_with(**changes):
    return mutant_of(Phong((1.0, 1.0, 1.0), 10.0), **changes)


def mutant_of(value, **changes):
    functions = {name: staticmethod(f) if callable(f) else f for name, f in changes.items()}
    return type("Mutant", (type(value),), functions)(**vars(value))


def _pdf_of_another_exponent(k, n, wo, wi):
    return Phong.pdf(h.table({"exponent": 11.0}), n, wo, wi)


def _sample_about_normal(k, n, wo, u2):
    return to_world(n, square_to_cosine_power(u2, k.exponent))


def _sample_of_half_the_turn(k, n, wo, u2):
    return Phong.sample(k, n, wo, u2 * np.array([[1.0], [0.5]]))


def _unnormalised(k, n, wo, wi):
    return k.exponent * cosine_power(reflect(wo, n), wi, k.exponent) / (2 * np.pi)


def _one_way(k, n, wo, wi):
    return Phong.eval(k, n, wo, wi) * dot(n, wo)


def _a_little_more(k, n, wo, wi):
    return Phong.eval(k, n, wo, wi) * (1 + 1e-6)


def _double(k, n, wo, wi):
    return Phong.pdf(k, n, wo, wi) * np.ones(1)


def _of_the_batch(k, n, wo, wi):
    return Phong.pdf(k, n, wo, wi) + wi[0].mean()


def _without_the_jacobian(k, n, wo, wi):
    return BlinnPhong.pdf(k, n, wo, wi) * (2 * np.linalg.norm(wo + wi, axis=0))


def _jacobian_of_the_other_cosine(k, n, wo, wi):
    return BlinnPhong.pdf(k, n, wo, wi) * np.linalg.norm(wo + wi, axis=0) / 2 / np.abs(dot(n, wi))


def _below_zero(k, n, wo, wi):
    return (k.exponent + 1) / (2 * np.pi) * dot(reflect(wo, n), wi) ** 11


@pytest.mark.parametrize(
    ("law", "mutant"),
    [
        (check_density_integrates_to_one, {"pdf": _unnormalised}),
        (check_samples_follow_the_density, {"pdf": _pdf_of_another_exponent}),
        (check_samples_follow_the_density, {"sample": _sample_about_normal}),
        (check_samples_follow_the_density, {"sample": _sample_of_half_the_turn}),
        (check_density_is_never_negative, {"pdf": _below_zero}),
        (check_reciprocity, {"eval": _one_way}),
        (check_reciprocity, {"is_reciprocal": False}),
        (check_no_more_leaves_than_albedo_says, {"eval": _a_little_more}),
        (check_dtype_is_kept, {"pdf": _double}),
        (check_lanes_are_independent, {"pdf": _of_the_batch}),
    ],
    ids=lambda x: x.__name__ if callable(x) else "-".join(getattr(f, "__name__", str(f)) for f in x.values()),
)
def test_the_contract_catches_a_broken_bsdf(law, mutant):
    with pytest.raises(AssertionError):
        law(phong_with(**mutant))


BLINN, LECTURE = BlinnPhong((1.0, 1.0, 1.0), 10.0), PhongLecture((0.5, 0.5, 0.5), 10.0)
PAPER, FILM = LambertTransmission((1.0, 1.0, 1.0)), PhongTransmission((1.0, 1.0, 1.0), 10.0)


def _one_percent_more(k, n, wo, wi):
    return BlinnPhong.eval(k, n, wo, wi) * 1.01


@pytest.mark.parametrize(
    ("law", "value", "mutant"),
    [
        (check_density_integrates_to_one, BLINN, {"pdf": _without_the_jacobian}),
        (check_density_integrates_to_one, BLINN, {"pdf": _jacobian_of_the_other_cosine}),
        (check_samples_follow_the_density, BLINN, {"pdf": Phong.pdf}),
        (check_no_more_leaves_than_albedo_says, BLINN, {"eval": _one_percent_more}),
        (check_no_more_leaves_than_albedo_says, LECTURE, {"albedo": lambda k: np.ones_like(k.reflectance)}),
        (check_reciprocity, LECTURE, {"eval": Phong.eval}),
        (check_density_integrates_to_one, PAPER, {"pdf": lambda k, n, wo, wi: np.abs(dot(n, wi)) / np.pi}),
        (check_samples_follow_the_density, PAPER, {"sample": lambda k, n, wo, u2: -LambertTransmission.sample(k, n, wo, u2)}),
        (check_samples_follow_the_density, FILM, {"sample": lambda k, n, wo, u2: PhongTransmission.sample(k, n, reflect(wo, n), u2)}),
        (check_no_more_leaves_than_albedo_says, PAPER, {"eval": lambda k, n, wo, wi: k.transmittance / 3.14}),
        (check_no_more_leaves_than_albedo_says, FILM, {"eval": lambda k, n, wo, wi: PhongTransmission.eval(k, n, wo, wi) * 1.5}),
        (check_reciprocity, FILM, {"eval": lambda k, n, wo, wi: PhongTransmission.eval(k, n, wo, wi) * -dot(n, wi)}),
    ],
    ids=lambda x: x.__name__ if callable(x) else None,
)
def test_the_contract_catches_a_broken_variant(law, value, mutant):
    law(value)
    with pytest.raises(AssertionError):
        law(mutant_of(value, **mutant))
