"""What the command line understands, and what it answers to what it does not."""

from dataclasses import fields

import pytest

from glanz.cli import main
from glanz.cli.arguments import border, frame_range, parser, resolution, sample_range
from glanz.cli.commands import OVERRIDES
from glanz.cli.outputs import numbered
from glanz.engine import Settings


@pytest.mark.parametrize(
    ("text", "frames"), [("1-3", [1, 2, 3]), ("5-5", [5]), ("1-10:4", [1, 5, 9]), ("-2-1", [-2, -1, 0, 1]), ("-5--3", [-5, -4, -3])]
)
def test_a_range_of_frames_is_inclusive(text, frames):
    assert list(frame_range(text)) == frames


def test_the_other_values_are_what_they_say():
    assert resolution("1920x1080") == (1920, 1080)
    assert sample_range("16,32") == (16, 32)
    assert border("0,0.25,0.5,1") == (0, 0.25, 0.5, 1)


WRONG = [
    [],
    ["paint", "a.blend"],
    ["render"],
    ["render", "a.blend", "--frames", "3-1"],
    ["render", "a.blend", "--frames", "1-3:0"],
    ["render", "a.blend", "--frames", "1-3", "--frame", "1"],
    ["render", "a.blend", "--resolution", "0x5"],
    ["render", "a.blend", "--resolution", "5"],
    ["render", "a.blend", "--border", "0,0,1"],
    ["render", "a.blend", "--border", "0.5,0,0.5,1"],
    ["render", "a.blend", "--border", "0,0,1,nan"],
    ["render", "a.blend", "--samples", "many"],
    ["render", "a.blend", "--sample-range", "16"],
    ["render", "a.blend", "--sample-range", "16,16"],
    ["render", "a.blend", "--sample", "1"],
    ["render", "a.blend", "-o", "a.jpg"],
    ["render", "a.blend", "-o", "a.exr", "-o", "a.exr"],
    ["export", "a.blend"],
    ["export", "a.blend", "-o", "b.blend"],
]


@pytest.mark.parametrize("words", WRONG, ids=" ".join)
def test_what_is_not_understood_is_one_line_and_status_2(words, capsys):
    assert main(words) == 2
    out, err = capsys.readouterr()
    assert out == ""
    assert err.startswith("glanz: error: ")
    assert err.count("\n") == 1


@pytest.mark.parametrize("words", [["--help"], ["render", "--help"], ["info", "--help"], ["export", "--help"]], ids=" ".join)
def test_help_is_given_with_status_0(words, capsys):
    assert main(words) == 0
    assert "usage: glanz" in capsys.readouterr().out


def test_every_setting_of_the_command_line_has_its_own_name():
    words = "--integrator i --sampler s --samples 1 --max-depth 2 --seed 3 --threads 4 --pixel-filter f"
    words += " --max-transparent 9 --branches 8 --min-contribution 0.5 --adaptive-threshold 0.1 --adaptive-levels 5 --precision p"
    arguments = parser("1").parse_args(["render", "a.blend", *words.split()])
    assert (arguments.integrator, arguments.sampler, arguments.samples, arguments.max_depth) == ("i", "s", 1, 2)
    assert (arguments.max_transparent, arguments.branches, arguments.min_contribution) == (9, 8, 0.5)
    assert (arguments.seed, arguments.threads, arguments.pixel_filter, arguments.precision) == (3, 4, "f", "p")
    assert (arguments.adaptive_threshold, arguments.adaptive_levels) == (0.1, 5)


def test_every_setting_of_the_command_line_is_followed():
    """The border, which it has in fractions, in a way of its own."""
    arguments = vars(parser("1").parse_args(["render", "a.blend"]))
    assert {field.name for field in fields(Settings)} & {*arguments} == {*OVERRIDES, "border"}


@pytest.mark.parametrize(("words", "value"), [([], None), (["--film-transparent"], True), (["--no-film-transparent"], False)])
def test_the_film_is_as_the_file_says_unless_told_otherwise(words, value):
    assert parser("1").parse_args(["render", "a.blend", *words]).film_transparent is value


@pytest.mark.parametrize(
    ("path", "frame", "is_sequence", "name"),
    [
        ("a/out.exr", None, False, "a/out.exr"),
        ("a/out.exr", 7, False, "a/out.exr"),
        ("a/out.exr", 7, True, "a/out_0007.exr"),
        ("a/out.exr", 12345, True, "a/out_12345.exr"),
        ("a/out.v2.exr", 7, True, "a/out.v2_0007.exr"),
        ("a#/o#ut_###.exr", 7, True, "a#/o#ut_007.exr"),
        ("#.png", 7, False, "7.png"),
        ("##.png", -7, True, "-7.png"),
    ],
)
def test_frames_are_numbered_as_blender_does(path, frame, is_sequence, name):
    assert numbered(path, frame, is_sequence) == name
