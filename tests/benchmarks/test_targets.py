"""Errors against the mean of other pictures are those against the truth."""

import json

import numpy as np
import pytest

from glanz.benchmarks import targets


def test_the_error_against_the_others_is_that_against_the_truth():
    """Of 20 pictures of 10,000 values with a relative noise of 2 %: each is known to 0.7 %, and to what the others say of its luck."""
    rng = np.random.default_rng(1)
    truth = rng.uniform(1, 3, (50, 67, 3))
    pictures = truth + rng.normal(0, 0.02 * truth.mean(), (20, *truth.shape))
    exact = [np.sqrt(np.square(p - truth).mean()) / truth.mean() for p in pictures]
    assert targets.errors(pictures) == pytest.approx(exact, rel=0.01)


def test_pictures_are_counted_as_the_bounds_say():
    assert targets.inside({"reached": [0.69, 0.7, 1.0, 1.05, 1.06]}) == 3
    one = {"reached": [0.9] * 20, "stated": [0.95] * 20, "samples": [400] * 20, "most": 16384, "date": "2026-01-31"}
    never = {"reached": [], "stated": [3.1], "samples": [16384], "most": 16384, "date": "2026-02-01"}
    text = targets.page({"facts": {"side": 32, "seeds": 20}, "scenes": {"one": one, "never": never}})
    assert "20 of 20 pictures reached 0.7 to 1.05 times the target.\n1 of the 2 scenes got that far" in text
    assert "in 1 of these 19 of 20 pictures did" in text
    assert "| never | not within 16,384 samples | | 3.10 | | 16,384 | 2026-02-01 |" in text


def test_scenes_that_are_not_measured_again_stay_as_they_were(tmp_path):
    """But for those that were measured in pictures of another size: they would stand in one table with what they cannot be compared to."""
    path, wide = tmp_path / "targets.json", {"seeds": 20, "side": 32}
    first, second = ({"reached": [error], "stated": [error], "samples": [64], "most": 1024, "date": "2026-01-31"} for error in (0.8, 0.9))
    targets.keep(path, "one", first, wide)
    targets.keep(path, "two", first, wide)
    assert targets.keep(path, "one", second, wide)["scenes"] == {"one": second, "two": first}
    assert json.loads(path.read_text(encoding="utf-8"))["scenes"] == {"one": second, "two": first}
    assert targets.keep(path, "one", first, wide | {"side": 16})["scenes"] == {"one": first}
