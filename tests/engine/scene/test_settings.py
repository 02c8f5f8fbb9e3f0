"""Settings are checked when they are made: each error names the setting and the value."""

import dataclasses

import numpy as np
import pytest

from glanz.engine import SceneError, Settings


@pytest.mark.parametrize("name", ["width", "height", "samples", "max_depth", "tile_size", "threads", "motion_steps"])
@pytest.mark.parametrize("value", [-1, 2.5, "8", None, True, 10**9])
def test_whole_numbers_out_of_range_are_refused_by_name(name, value):
    with pytest.raises(SceneError, match=f"setting {name} is {value!r}, allowed: whole numbers from [01] to"):
        Settings(**{name: value})


@pytest.mark.parametrize("name", ["width", "height", "samples", "motion_steps"])
def test_nothing_cannot_be_rendered(name):
    with pytest.raises(SceneError, match=f"setting {name} is 0"):
        Settings(**{name: 0})


@pytest.mark.parametrize("value", [0.5, "x", None, False])
def test_a_seed_is_a_whole_number(value):
    with pytest.raises(SceneError, match=f"setting seed is {value!r}"):
        Settings(seed=value)


@pytest.mark.parametrize("value", [0, -1.0, 10.5, float("nan"), float("inf"), "wide"])
def test_a_filter_has_a_width(value):
    with pytest.raises(SceneError, match=f"setting filter_width is {value!r} px, allowed"):
        Settings(filter_width=value)


@pytest.mark.parametrize("value", [-0.1, 1.5, float("nan"), float("inf"), "0", None])
def test_a_threshold_of_colours_is_a_share(value):
    with pytest.raises(SceneError, match=f"setting adaptive_threshold is {value!r}, allowed: from 0 to 1"):
        Settings(adaptive_threshold=value)


@pytest.mark.parametrize("value", [0, 7, 2.0, True])
def test_pixels_can_be_divided_six_times(value):
    with pytest.raises(SceneError, match=f"setting adaptive_levels is {value!r}, allowed: whole numbers from 1 to 6"):
        Settings(adaptive_levels=value)


@pytest.mark.parametrize(
    "border", [(0, 0, 0, 8), (0, 0, 9, 8), (-1, 0, 8, 8), (0, 0, 8), (4, 4, 2, 8), (0.0, 0, 8, 8), (0, 5, 8, 5)], ids=str
)
def test_a_border_lies_inside_the_frame(border):
    with pytest.raises(SceneError, match=r"setting border is .* inside 8x8 px and not empty"):
        Settings(width=8, height=8, border=border)


@pytest.mark.parametrize("value", [(0, 0), (4, 4), (5, 4), (-1, 4), (0, 9), (0, 4, 8), (0.0, 4), (False, True)], ids=str)
def test_a_range_of_samples_lies_inside_all(value):
    with pytest.raises(SceneError, match=r"setting sample_range is .* of 8 samples and not empty"):
        Settings(samples=8, sample_range=value)


def test_a_range_of_samples_cannot_decide_what_is_divided():
    assert Settings(samples=8, sample_range=[2, 5]).rendered_samples == (2, 5)
    assert Settings(samples=8).rendered_samples == (0, 8)
    with pytest.raises(SceneError, match="all samples decide together"):
        Settings(samples=8, sample_range=(0, 4), adaptive_threshold=0.1)


def test_numpy_integers_are_whole_numbers_or_refused_by_name():
    """Never silently something else."""
    try:
        assert Settings(width=np.int64(8)).width == 8
    except SceneError as error:
        assert "setting width" in str(error)


def test_the_region_is_the_border_or_the_frame():
    assert Settings(width=8, height=4).region == (0, 0, 8, 4)
    assert Settings(width=8, height=4, border=[1, 2, 3, 4]).region == (1, 2, 3, 4)


def test_settings_cannot_be_changed():
    with pytest.raises(dataclasses.FrozenInstanceError):
        Settings().width = 3


@pytest.mark.parametrize(
    ("name", "value"),
    [
        ("branches", 0),
        ("branches", 2.5),
        ("min_contribution", -0.1),
        ("min_contribution", float("nan")),
        ("light_falloff", 1),
        ("filter_textures", None),
        ("film_transparent", 1),
        ("precision", "double"),
        ("precision", ["exact"]),
    ],
)
def test_senseless_choices_are_refused_by_name(name, value):
    with pytest.raises(SceneError, match=f"setting {name} is"):
        Settings(**{name: value})
