"""The status line says how far, and how long yet."""

import sys

import numpy as np
import pytest

from glanz.addon.memory import peak_megabytes, used_megabytes
from glanz.addon.status import minutes, text


@pytest.mark.parametrize(("seconds", "expected"), [(0, "0:00"), (5, "0:05"), (65, "1:05"), (3600, "1:00:00"), (59.6, "1:00")])
def test_minutes(seconds, expected):
    assert minutes(seconds) == expected


def test_remaining_time_is_in_proportion():
    assert text(0.25, 64, 30) == "25% of 64 samples, 1:30 left"
    assert text(1, 64, 30) == "100% of 64 samples, 0:00 left"


def test_warnings_are_counted():
    assert text(0.25, 64, 30, 1) == "25% of 64 samples, 1:30 left, 1 warning"
    assert text(0, 64, 0, 3) == "0% of 64 samples, 3 warnings"
    assert text(0.5, 64, 30, 2, 1234.5) == "50% of 64 samples, 0:30 left, 1,234 MB, 2 warnings"


def test_there_is_no_guess_before_anything_is_done():
    assert text(0, 64, 0) == "0% of 64 samples"


def test_memory_is_that_of_a_process_with_blender_in_it():
    before = used_megabytes()
    assert before is None or 50 < before < 100_000
    if sys.platform == "linux":
        kept = np.ones(2**26, np.uint8)
        assert used_megabytes() - before == pytest.approx(64, abs=16)
        assert peak_megabytes() >= used_megabytes() - 1
        del kept
        assert used_megabytes() - before == pytest.approx(0, abs=16)
