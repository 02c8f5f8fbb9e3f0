"""The curve of error against time: numbers from known errors, and the command on a scene file."""

import csv
import json
import sys

import numpy as np
import pytest

from glanz.cli import curve, main
from glanz.engine import AreaLight, write_scene
from glanz.tests import helpers as h


def lit():
    """A floor and a box under a lamp, which light between them."""
    floor = h.thing(h.quad((0, 0, -0.5), (8, 0, 0), (0, 8, 0), name="floor"), h.lambert(0.8))
    lamp = AreaLight(name="lamp", world_from_light=h.affine(translation=(0, 0, 3)), size_x=1, size_y=1, radiance=(9.0, 9.0, 9.0))
    return h.scene([h.thing(h.box()), floor], [lamp])


@pytest.mark.parametrize(("noise", "bias"), [(0.1, 0.0), (0.1, 0.05), (0.05, 0.2), (0.0, 0.1)])
def test_noise_and_bias_are_told_apart(noise, bias):
    """Of pictures made of numbers: each to 5 %, which 30,000 values tell at four standard deviations; their sum is the RMSE."""
    rng = np.random.default_rng(1)
    truth = 2 + np.indices((100, 100)).sum(axis=0)[..., None] / 100 * np.ones(3)
    mean, doubt = truth.mean(), np.full_like(truth, 0.02)
    pictures = truth + bias * mean + noise * mean * rng.normal(size=(3, *truth.shape))
    found = curve.errors(pictures, truth + doubt * rng.normal(size=truth.shape), doubt)
    assert found["noise"] == pytest.approx(noise, rel=0.05, abs=1e-12)
    assert found["bias"] == pytest.approx(bias, rel=0.05, abs=1e-12)
    assert found["rmse"] == pytest.approx(np.hypot(noise, bias), rel=0.05)


def test_the_doubt_of_the_reference_is_taken_off():
    """A reference as noisy as the pictures: without, their errors would be 1.4 times as large."""
    rng = np.random.default_rng(2)
    truth = np.ones((100, 100, 3))
    pictures = truth + 0.1 * rng.normal(size=(3, *truth.shape))
    noisy = truth + 0.1 * rng.normal(size=truth.shape)
    assert curve.errors(pictures, noisy, np.full_like(truth, 0.1))["rmse"] == pytest.approx(0.1, rel=0.05)
    assert curve.errors(pictures, noisy, np.zeros_like(truth))["rmse"] == pytest.approx(0.1414, rel=0.05)


def test_few_bounces_are_a_bias_and_path_tracing_has_none():
    """A box on a floor that light each other: without bounces a good part is missing whatever the samples."""
    settings = h.settings(width=24, height=24, max_depth=4)
    rungs = curve.measure(lit(), settings, ("path",), ("sobol",), (0, 4), (4, 16), lambda done: None)
    none, some = [rung for rung in rungs if rung.max_depth == 0], [rung for rung in rungs if rung.max_depth == 4]
    assert all(rung.bias > 0.05 for rung in none)
    assert [rung.kind for rung in some] == ["noise"] * 2
    # The first of them under twice the noise, by which it is known to a tenth.
    assert none[0].bias == pytest.approx(none[1].bias, rel=0.4)
    assert -1.6 < some[0].slope < -0.45


def test_the_front_has_what_nothing_beats():
    rungs = [curve.Rung("path", "sobol", 1, n, s, 0, e, 0, None, e, 0) for n, s, e in ((1, 1, 0.5), (2, 2, 0.6), (3, 2, 0.5), (4, 3, 0.2))]
    assert [rung.is_best for rung in curve._ranked(rungs)] == [True, False, False, True]


def test_the_command_writes_tables_and_plots(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_scene("a.glanz", lit(), h.settings(width=16, height=8, max_depth=1))
    words = "bench a.glanz -o out --samples 1,4 --samplers sobol --integrators path,distributed --precisions fast,exact"
    assert main(words.split()) == 0
    said = capsys.readouterr()
    heads = [line.split()[:5] for line in said.out.splitlines()[1:9]]
    kinds = [(integrator, precision, n) for integrator in ("path", "distributed") for precision in ("fast", "exact") for n in "14"]
    assert heads == [[integrator, "sobol", "1", precision, n] for integrator, precision, n in kinds]
    with open("out/curve.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    kept = json.loads((tmp_path / "out/curve.json").read_text())
    assert [float(row["rmse"]) for row in rows] == [rung["rmse"] for rung in kept["rungs"]]
    assert (kept["width"], kept["height"]) == (16, 8)
    assert all(0 < rung["flip"] < 1 for rung in kept["rungs"])
    assert (tmp_path / "out/curve.png").read_bytes()[:4] == b"\x89PNG"
    assert b"<svg" in (tmp_path / "out/curve.svg").read_bytes()


def test_without_libraries_there_is_a_table_and_a_cure(tmp_path, capsys, monkeypatch):
    """As inside Blender, which has neither matplotlib nor FLIP."""
    monkeypatch.chdir(tmp_path)
    for name in ("matplotlib", "matplotlib.figure", "flip_evaluator"):
        monkeypatch.setitem(sys.modules, name, None)
    write_scene("a.glanz", lit(), h.settings(width=8, height=8, max_depth=0))
    assert main(["bench", "a.glanz", "--samples", "1", "--samplers", "random"]) == 0
    said = capsys.readouterr()
    assert said.err.count("pip install 'glanz[bench]'") == 2
    assert sorted(path.name for path in (tmp_path / "glanz_bench").iterdir()) == ["curve.csv", "curve.json"]


@pytest.mark.parametrize(
    ("words", "said"),
    [
        (["--samples", "1,x"], "'1,x' is not a list of numbers"),
        (["--samples", "0"], "setting samples is 0"),
        (["--integrators", "magic"], "magic"),
        (["--precisions", "double"], "setting precision is 'double'"),
    ],
    ids=str,
)
def test_what_is_wrong_is_said_before_the_reference_is_rendered(words, said, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(curve, "rendered", None)
    write_scene("a.glanz", lit(), h.settings())
    assert main(["bench", "a.glanz", *words]) != 0
    assert said in capsys.readouterr().err


def test_a_black_scene_is_refused(tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    write_scene("a.glanz", h.scene([h.thing(h.box())]), h.settings())
    assert main(["bench", "a.glanz", "--samples", "1"]) == 1
    assert "is black" in capsys.readouterr().err
