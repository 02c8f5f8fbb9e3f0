"""What may stand after the name of a benchmark."""

import pytest

from glanz.benchmarks.words import asked

KNOWN = {"a": 1, "b": 2}


@pytest.mark.parametrize(
    ("words", "names", "is_quick"), [([], ["a", "b"], False), (["--quick"], ["a", "b"], True), (["b", "--quick"], ["b"], True)]
)
def test_all_parts_or_those_that_are_named(words, names, is_quick):
    assert asked("x", "About.", "part", KNOWN, "less", words) == (names, is_quick)


def test_an_unknown_part_is_named_with_those_that_are_known(capsys):
    with pytest.raises(SystemExit):
        asked("x", "About.", "part", KNOWN, "less", ["c"])
    assert "unknown: c; known: a, b" in capsys.readouterr().err
