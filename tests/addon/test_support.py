"""docs/support.md says what the export does; what it says was measured is for `make nodes` to renew."""

from pathlib import Path

import bpy
import pytest

from glanz.addon.export import values

ROOT = Path(__file__).resolve().parents[2]
AGAIN = "docs/support.md is not what the code does any more: PYTHON=python3.13 make support"
NEWEST = (5, 2)
"""The Blender that has the last word; others may lack an input."""


@pytest.fixture
def support_table(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT / "tools"))
    import support_table

    return support_table


@pytest.fixture
def page():
    return (ROOT / "docs" / "support.md").read_text()


def outdated(support_table, page):
    """The nodes of this Blender that the page says something else of."""
    said, found = support_table.rows_of(page), support_table.node_rows()
    assert len(found) > 80
    if bpy.app.version < NEWEST:
        return [node for node, how in found.items() if not set(how.split("; ")) <= set(said.get(node, "").split("; "))]
    return [node for node, how in found.items() if how != said.get(node)]


def test_the_page_says_of_every_node_how_it_is_rendered(support_table, page):
    assert not outdated(support_table, page), AGAIN


def test_a_node_that_is_not_read_any_more_is_noticed(support_table, page, monkeypatch):
    monkeypatch.delitem(values.TABLE, "TEX_WAVE")
    assert outdated(support_table, page) == ["Wave Texture"]


def test_the_page_has_all_that_is_noted_of_whole_data_blocks(support_table, page):
    assert support_table.HEAD + support_table.features() + support_table.NODES in page, AGAIN


def test_notes_of_data_blocks_are_found_in_the_code(support_table):
    assert support_table.notes_of("objects")["volumes are not rendered"] == "ignored"
    assert support_table.notes_of("nodes")["the node group is missing"] == "missing"
    assert "the node tree has no active output, so the material is black" in support_table.notes_of("material")
