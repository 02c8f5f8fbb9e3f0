"""The page of promises names tests that exist, and a proof for every promise and every law."""

import ast
import functools
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = "docs/promises.md"
NAMED = re.compile(r"`([\w/]+\.py)::(\w+)`")
COUNTS = {"A": 13, "B": 11, "C": 11, "D": 17, "E": 13, "F": 11, "G": 11, "H": 10, "J": 23}
"""How many laws there are of each letter; some numbers were never given."""


def sections(text):
    """{title: rows of its tables, each the texts of its cells}."""
    found = {}
    for part in re.split(r"^#+ ", text, flags=re.MULTILINE)[1:]:
        title, _, body = part.partition("\n")
        rows = [[cell.strip() for cell in line.strip("|").split(" | ")] for line in body.splitlines() if line.startswith("| ")]
        found[title] = rows[1:]  # the first names the columns
    return found


@functools.cache
def names_in(file):
    """The names of the tests in a file below tests/."""
    path = ROOT / "tests" / file
    if not path.exists():
        return frozenset()
    body = ast.parse(path.read_text(encoding="utf-8")).body
    return frozenset(node.name for node in body if isinstance(node, ast.FunctionDef) and node.name.startswith("test_"))


def complaints(text):
    """What is wrong with a page of promises: tests that do not exist, lines without any, laws that lack or come twice."""
    wrong = [f"{file}::{name} is not there" for file, name in NAMED.findall(text) if name not in names_in(file)]
    # A name that is not written as such would not be looked for.
    wrong += [f"{name} is not looked for" for name in re.findall(r"`([^`]*::[^`]*)`", text) if not NAMED.fullmatch(f"`{name}`")]
    parts = sections(text)
    wrong += [f"'{promise}' has no proof" for promise, proof in parts["Promises"] if not NAMED.search(proof)]
    laws = [row for title, rows in parts.items() if title != "Promises" for row in rows]
    wrong += [f"{law} has no test" for law, _, tests, *_ in laws if not NAMED.search(tests)]
    wrong += [f"{law} has no mutant, nor says why" for law, *_, mutant in laws if not mutant.strip(" |")]
    numbers = [law for law, *_ in laws]
    wrong += [f"{law} comes twice" for law in set(numbers) if numbers.count(law) > 1]
    found = {letter: sum(law.startswith(letter) for law in numbers) for letter in COUNTS}
    return wrong + [f"{letter}: {found[letter]} laws, not {count}" for letter, count in COUNTS.items() if found[letter] != count]


def test_every_promise_has_a_proof_that_exists():
    assert complaints((ROOT / PAGE).read_text(encoding="utf-8")) == []


@pytest.mark.parametrize(
    ("change", "complaint"),
    [
        (lambda text: text.replace("::test_nothing_stands_in_its_own_light", "::test_nothing_stands_in_any_light"), "is not there"),
        (lambda text: text.replace("renders/test_leaks.py", "renders/test_leak.py"), "is not there"),
        (lambda text: text.replace("test_leaks.py::test_random_walks", "test_leaks.py::the random walks"), "is not looked for"),
        (lambda text: re.sub(r"(\| by any other factor it differs by rounding \|).*", r"\1 trust us |", text), "has no proof"),
        (lambda text: re.sub(r"^\| H9 .*\n", "", text, flags=re.MULTILINE), "laws, not"),
        (lambda text: re.sub(r"^\| H9 ", "| H8 ", text, flags=re.MULTILINE), "comes twice"),
    ],
)
def test_a_page_that_rots_is_noticed(change, complaint):
    text = (ROOT / PAGE).read_text(encoding="utf-8")
    assert change(text) != text
    assert any(complaint in wrong for wrong in complaints(change(text)))


@pytest.mark.parametrize("page", ["README.md", "docs/speed_and_accuracy.md"])
def test_the_page_is_linked(page):
    assert "promises.md" in (ROOT / page).read_text(encoding="utf-8")
