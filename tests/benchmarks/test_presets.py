"""What noise and bias come to in equal time is told by the laws that they follow, and what was measured is kept as long as it holds."""

import json
import math

import pytest

from glanz.benchmarks.presets import report
from glanz.benchmarks.presets.__main__ import keep

PRESETS = {"BALANCED": {"integrator": "path", "samples": 100, "max_depth": 8}, "PREVIEW": {"samples": 10, "max_depth": 4}}
FACTS = {"processor": "P", "cores": 2, "load": 0.1, "python": "3", "date": "today"}


def _ladder(biases, power=0.5):
    """Noise falls as samples^-power from 1."""
    samples = (1, 10, 100, 1000)
    return [
        {"depth": d, "samples": n, "noise": n**-power, "bias": bias, "rmse": math.hypot(bias, n**-power)}
        for d, bias in biases.items()
        for n in samples
    ]


PACES = {"4": 4, "8": 8}
"""Each bounce costs a microsecond."""


def _scene(times, errors):
    told = zip(PRESETS, times, errors, strict=True)
    found = {key: {"microseconds": time, "rmse": error, "noise": error, "bias": 0.0} for key, time, error in told}
    return {"facts": FACTS, "ladder": _ladder({4: 0.05, 8: 0.0}), "paces": PACES, "presets": found}


@pytest.mark.parametrize("samples", [1, 4, 25, 100, 1000, 4000])
@pytest.mark.parametrize("power", [0.5, 0.8])
def test_noise_in_equal_time_follows_its_power_law(samples, power):
    found = report.at_equal_time({"ladder": _ladder({4: 0.05, 8: 0.01}, power), "paces": PACES}, samples, 8)
    for depth, bias, count in ((4, 0.05, 2 * samples), (8, 0.01, samples)):
        assert found[depth] == pytest.approx((math.hypot(bias, count**-power), count**-power, bias))


def test_few_bounces_lose_once_their_bias_is_above_the_noise_that_they_save():
    """Half the price is a noise of 0.7; the bias of 0.05 is as much as that saves at 200 samples."""
    scenes = {"a": {"ladder": _ladder({4: 0.05, 8: 0.0}), "paces": PACES}}
    for samples, best in ((100, 4), (180, 4), (220, 8), (1000, 8)):
        found = report.losses(scenes, {"samples": samples, "max_depth": 8})
        assert found[best] == [1.0] and all(loss > 1 for depth, (loss,) in found.items() if depth != best)


def test_the_summary_is_of_ratios_within_scenes():
    """A scene that is slow throughout says the same."""
    scenes = {"a": _scene((10, 1), (1, 3)), "b": _scene((1000, 200), (5, 20)), "c": _scene((1, 0.4), (1, 2))}
    found = report.summary(scenes, PRESETS)
    assert found["PREVIEW"]["time"] == [0.2, 0.1, 0.4]
    assert found["PREVIEW"]["error"] == [3, 2, 4]
    assert found["BALANCED"]["time"] == [1, 1, 1]


def test_scenes_are_kept_until_the_presets_change(tmp_path):
    path, asked_for = tmp_path / "presets.json", {"presets": PRESETS, "effort": {"size": (4, 3)}}
    keep(path, "b", _scene((10, 1), (1, 3)), asked_for)
    results = keep(path, "a", _scene((10, 2), (1, 3)), asked_for)
    assert list(results["scenes"]) == ["a", "b"]
    assert json.loads(path.read_text()) == results
    # A line for each rung, so that changes can be read.
    assert len(path.read_text().splitlines()) < 70
    changed = {"presets": PRESETS | {"PREVIEW": {"samples": 20, "max_depth": 4}}}
    assert list(keep(path, "c", _scene((10, 1), (1, 3)), asked_for | changed)["scenes"]) == ["c"]


def test_the_page_tells_what_there_is_and_whether_the_machine_was_busy():
    asked_for = {"presets": PRESETS | {"FINAL": {"integrator": "path", "samples": 1000, "max_depth": 8}}}
    asked_for["presets"]["PREVIEW"] |= {"integrator": "path"}
    effort = {"size": (4, 3), "timed_size": (8, 6), "longest": 4096, "deepest": 256, "seeds": 3}
    scene = _scene((10, 1), (1, 3))
    scene["presets"]["FINAL"] = scene["presets"]["BALANCED"]
    results = asked_for | {"effort": effort, "scenes": {"a": scene}, "summary": report.summary({"a": scene}, asked_for["presets"])}
    labels = {key: key.title() for key in asked_for["presets"]}
    page = report.page(results, labels)
    assert "| Preview | path, 10 samples, 4 bounces | 0.1 (0.1 to 0.1) | 3 (3 to 3) | 3 (3 to 3) | 5 % (5 % to 5 %) |" in page
    assert "scenes: a." in page and "busy machine" not in page
    scene["facts"] = FACTS | {"load": 9}
    assert "**Measured on a busy machine**" in report.page(results, labels)
