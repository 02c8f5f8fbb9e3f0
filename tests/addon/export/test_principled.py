"""The layers of the Principled BSDF keep energy at every angle, and meet the limits that have names."""

import dataclasses
import itertools

import numpy as np
import pytest
from hypothesis import given, strategies as st

from glanz.addon.export.principled import Layers
from glanz.engine import Dielectric, GgxAlbedo, Gloss, Lambert, Mirror, Mix
from glanz.engine.maths.fresnel import index_of_level
from glanz.engine.scene.points import OnPlane
from glanz.tests.chance import law

POINTS = 64
UNIT = st.floats(0, 1, width=32)
COLOUR = st.tuples(UNIT, UNIT, UNIT)


def sent_on(lobes):
    """What all `lobes` reflect and pass, (3, N), looked at from all around."""
    at = OnPlane(np.zeros((3, POINTS), np.float32))
    colours = (at.value(getattr(lobe, "reflectance", None) or getattr(lobe, "transmittance", None)) for lobe in lobes)
    return sum(np.broadcast_to(colour, (3, POINTS)) for colour in colours)


@law(quick=300, thorough=10_000)
@given(
    colours=st.tuples(COLOUR, COLOUR, COLOUR, COLOUR),
    shares=st.tuples(*[UNIT] * 6),
    iors=st.tuples(st.floats(1, 4), st.floats(1, 4)),
    level=UNIT,
)
def test_no_layers_send_on_more_than_arrives(colours, shares, iors, level):
    base, tint, coat_tint, sheen_tint = colours
    metallic, roughness, transmission, coat, coat_roughness, sheen = shares
    lobes, _ = Layers(
        base=base,
        tint=tint,
        coat_tint=coat_tint,
        sheen_tint=sheen_tint,
        metallic=metallic,
        roughness=roughness,
        transmission=transmission,
        coat=coat,
        coat_roughness=coat_roughness,
        sheen=sheen,
        ior=iors[0],
        coat_ior=iors[1],
        specular_level=level,
    ).lobes()
    total = sent_on(lobes)
    assert np.isfinite(total).all()
    assert (total >= 0).all()
    assert total.max() <= 1 + 1e-5


@pytest.mark.parametrize(
    ("metallic", "transmission", "coat", "roughness"), list(itertools.product((0.0, 1.0), (0.0, 1.0), (0.0, 1.0), (0.0, 0.25, 0.5, 1.0)))
)
def test_what_is_white_sends_on_everything(metallic, transmission, coat, roughness):
    """The furnace, at every angle."""
    white = Layers(base=(1.0, 1.0, 1.0), metallic=metallic, transmission=transmission, coat=coat, roughness=roughness)
    assert sent_on(white.lobes()[0]) == pytest.approx(1, abs=1e-5)


def test_a_base_that_ignores_its_coat_is_caught():
    lobes, _ = Layers(base=(1.0, 1.0, 1.0)).lobes()
    assert sent_on((*lobes[:-1], Lambert((1.0, 1.0, 1.0)))).max() > 1.01


def test_a_metal_is_glossy_only():
    (glossy,) = Layers(base=(0.9, 0.5, 0.1), metallic=1.0).lobes()[0]
    assert type(glossy) is Gloss
    assert type(glossy.reflectance) is GgxAlbedo


def test_without_specular_it_is_diffuse_only():
    (diffuse,) = Layers(base=(0.9, 0.5, 0.1), specular_level=0.0).lobes()[0]
    assert diffuse == Lambert((0.9, 0.5, 0.1))


def test_a_smooth_one_is_a_mirror_and_smooth_glass_is_exact():
    assert [type(lobe) for lobe in Layers(roughness=0.0).lobes()[0]] == [Mirror, Lambert]
    assert Layers(base=(1.0, 1.0, 1.0), roughness=0.0, transmission=1.0).lobes()[0] == (Dielectric(1.5),)


def test_specular_level_scales_the_reflection_at_normal_incidence():
    f0 = lambda ior: ((ior - 1) / (ior + 1)) ** 2  # noqa: E731
    cases = (1.5, 0.5, 0.04), (1.5, 1.0, 0.08), (1.5, 0.0, 0), (1 / 1.5, 0.5, 0.04), (40.0, 1.0, 0.99), (1.5, -1.0, 0)
    for ior, level, expected in cases:
        assert f0(index_of_level(np.float32(ior), np.float32(level))) == pytest.approx(expected, rel=1e-5)


VARIED = {"ior": (1.1, 2.5), "specular_level": (0.2, 1.0), "coat_ior": (1.1, 2.5), "base": ((0.9, 0.5, 0.2), (0.2, 0.5, 0.9))}


@pytest.mark.parametrize("name", VARIED)
@pytest.mark.parametrize("roughness", [0.0, 0.5])
@pytest.mark.parametrize("transmission", [0.0, 1.0])
def test_what_varies_is_at_each_point_what_it_is_there(name, roughness, transmission):
    """Every parameter of every lobe, where a texture has a value, is what it is for that value."""
    others = {"roughness": roughness, "transmission": transmission, "coat": 1.0}
    lobes, _ = Layers(**{name: Mix(0.0, *VARIED[name])}, **others).lobes()
    plain, _ = Layers(**{name: VARIED[name][0]}, **others).lobes()
    assert [type(lobe) for lobe in lobes] == [type(lobe) for lobe in plain]
    for lobe, truth in zip(lobes, plain):
        at = OnPlane(np.zeros((3, POINTS), np.float32))
        for field in dataclasses.fields(lobe):
            found, expected = np.broadcast_arrays(*(at.value(getattr(value, field.name)) for value in (lobe, truth)))
            assert found == pytest.approx(expected, rel=1e-5, abs=1e-6), field.name
