"""The page of nodes shows the figures that were measured: `make nodes` writes both."""

import json
from pathlib import Path

DOCS = Path(__file__).resolve().parents[2] / "docs"
KEPT = json.loads((DOCS / "nodes.json").read_text(encoding="utf-8"))


def test_the_page_has_the_least_share_of_every_node_in_every_version():
    lines = (DOCS / "nodes.md").read_text(encoding="utf-8").splitlines()
    versions = sorted(KEPT["shares"], key=lambda version: tuple(map(int, version.split("."))))
    assert any(line.endswith("".join(f" Blender {version} |" for version in versions)) for line in lines)
    for kind in {kind for version in versions for kind in KEPT["shares"][version]}:
        least = [KEPT["shares"][version].get(kind) for version in versions]
        cells = "".join(f" {min(shares.values()):.1%} |" if shares else "  |" for shares in least)
        assert any(line.startswith(f"| {KEPT['labels'][kind]} |") and line.endswith(cells) for line in lines), kind
