"""Compare every node with Cycles and write docs/nodes.md: `make nodes`, and `BPY=4.2.23 make nodes` for another Blender.

Figures are kept in docs/nodes.json by version of Blender, so that one run renews one column of the page.
"""

import json
import os
import sys
import tempfile
from pathlib import Path

import bpy

import glanz
from glanz.tests.parity.nodes import extremes, shortfalls
from glanz.tests.parity.nodes.cases import CLOSURES, ELSEWHERE, cases, kinds, label
from glanz.tests.parity.nodes.grid import shares
from glanz.tests.parity.nodes.shortfalls import bar

DOCS = Path(__file__).resolve().parent.parent / "docs"
HEAD = """# Nodes, compared with Cycles

Every node that gives a value is rendered in every mode by Glanz and by Cycles: the node's output glows on a bent square, inputs are
random or vary over it, and both engines look through the middles of the same pixels. A pixel agrees where all its channels differ by
at most 1/255 (of the value, where that is more than 1). The figures are the least share of pixels that agree, over all
outputs, modes and seeds. At least 99 % is asked of arithmetic, colours and inputs, 98 % of textures.

The same nodes work in the trees of lights, asked where rays meet the light: UV over an area light, the cone of a spot, around a bulb,
over the disk of a sun; Object, Generated and Normal in the light's frame; Incoming from the light. Blocks of a lit plane agree with
Cycles within 1 %, noise included; before 4.5 Cycles took the frame of the world for Object and Generated.
How often a path was scattered is not known there (depths of Light Path count as on the first bounce), and what is below 0 is no light.

Written by `make nodes`; `make test` checks the same.
"""
EXACTLY = "In brackets: with inputs that are texels, so that both engines compute with the very same numbers."


def measured(names, **how):
    """{node: {output and mode: least share}} in this Blender; `how`: see `shares`."""
    found = {}
    with tempfile.TemporaryDirectory() as folder:
        for kind in names:
            print(kind, flush=True)
            worst = {}
            for case, share in shares(cases(kind), Path(folder), **how).items():
                key = f"{case.output}: {case.mode}" if case.mode else case.output
                worst[key] = min(worst.get(key, 1.0), round(share, 4))
            found[kind] = worst
    return found


def page(figures, exact, labels):
    """The text of docs/nodes.md; `exact` are the `figures` of nodes that fall short, with inputs that are the same in both engines."""
    versions = sorted(figures, key=lambda v: tuple(map(int, v.split("."))))
    every = sorted({kind for version in versions for kind in figures[version]}, key=lambda kind: labels[kind])
    rows = ["| node | modes and outputs | " + " | ".join(f"Blender {v}" for v in versions) + " |", "|---" * (2 + len(versions)) + "|"]
    low = []
    for kind in every:
        columns = [figures[v].get(kind) for v in versions]
        rows.append(f"| {labels[kind]} | {max(len(c) for c in columns if c)} | " + " | ".join(_cell(c) for c in columns) + " |")
        for mode in dict.fromkeys(m for c in columns if c for m in c):
            values = [c.get(mode) if c else None for c in columns]
            if any(v is not None and v < bar(kind) for v in values):
                pairs = zip(values, (exact.get(v, {}).get(kind, {}).get(mode) for v in versions))
                low.append(f"| {labels[kind]} | {mode} | " + " | ".join(map(_pair, pairs)) + " |")
    reasons = [f"| {labels[kind]} | {reason} |" for kind, (reason, _) in sorted(shortfalls.NODES.items()) if kind in labels]
    others = [f"| {labels.get(kind, kind)} | {reason} |" for kind, reason in sorted({**ELSEWHERE, **CLOSURES}.items())]
    parts = [HEAD, *rows]
    if low:
        head = ["| node | output and mode | " + " | ".join(versions) + " |", "|---" * (2 + len(versions)) + "|"]
        parts += ["", "## Below the bar", "", EXACTLY, "", *head, *low]
    if reasons:
        parts += ["", "Why:", "", "| node | reason |", "|---|---|", *reasons]
    return "\n".join([*parts, "", "## Not in this table", "", "| node | |", "|---|---|", *others]) + "\n"


def _cell(worst):
    return f"{min(worst.values()):.1%}" if worst else ""


def _pair(pair):
    return " ".join(form.format(share) for form, share in zip(("{:.1%}", "({:.1%})"), pair) if share is not None)


def main():
    """Measure in this Blender, and write the data and the page."""
    glanz.register()
    path = DOCS / "nodes.json"
    kept = json.loads(path.read_text()) if path.exists() else {"labels": {}, "shares": {}}
    version = "{}.{}".format(*bpy.app.version)
    kept["shares"][version] = measured(kinds())
    kept.setdefault("exact", {})[version] = measured([k for k in kinds() if k in shortfalls.NODES], build=extremes.build)
    kept["labels"].update({kind: label(kind) for kind in (*kinds(), *ELSEWHERE, *CLOSURES) if label(kind)})
    path.write_text(json.dumps(kept, indent=1, sort_keys=True) + "\n")
    (DOCS / "nodes.md").write_text(page(kept["shares"], kept["exact"], kept["labels"]))
    sys.stdout.flush()
    os._exit(0)


if __name__ == "__main__":
    main()
