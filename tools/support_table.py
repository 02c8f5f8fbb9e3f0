"""Write docs/support.md, how Glanz renders each feature and each node of Blender, as the export's code says: `make support`.

Nodes are tried: each is exported with every input set, and fed, and in every mode; what is noted is what is not as in Blender. Rows
of nodes that this version of Blender lacks are kept, so that each version renews its own; the newest, which has most inputs, comes last.
"""

import ast
import json
import os
import re
import sys
import warnings
from contextlib import suppress
from pathlib import Path

import bpy

import glanz
from glanz.addon import passes
from glanz.addon.export import camera, findings, light, objects, scene
from glanz.addon.export.bitmaps import Bitmaps
from glanz.addon.export.material import export_material

ROOT = Path(__file__).resolve().parent.parent
PAGE = ROOT / "docs" / "support.md"
HEAD = """# What of Blender is rendered, and how

*Exact* is what Cycles renders, up to noise and rounding. *Approximated* is rendered, but not as Cycles does. *Ignored* is left out.
*Missing* is what a file refers to and is not there. All but what is exact is named in a warning, with its object, material and node; with
*Strict* what is ignored or missing is an error before rendering. *Scene Requirements* in the Render properties shows it for a scene, as
does `glanz info`.

Written by `make support` from the code of the export; `make test` checks that it says the same.
"""
DENOISING = "Denoising Albedo, Normal and Depth of mirrors and glass are their own, not those of what is seen in them"
NODES = """
## Nodes

What is said of inputs and modes is noted where they are used only. Agreement is the least share of pixels that agree with Cycles, of all
modes, outputs and versions of Blender ([nodes](nodes.md)); shaders are compared [elsewhere](closures.md), and the width of rough lobes is
[measured](lobes.md).

| node | how | agreement |
|---|---|---|
"""
ROUGH = "rough reflection and refraction are Phong's lobes, as wide and as bright as those of GGX"
PHONG = ("gloss", "phong", "rough_refraction")
"""The engine's lobes that stand for those of microfacets."""
NO_NODES = ("ShaderNodeGroup", "ShaderNodeCustomGroup", "ShaderNodeScript")
"""Groups are followed, whatever they hold; scripts would run code of the file."""
OUTPUTS = {"Volume": "Volume", "Displacement": "Displacement"}
"""Names of outputs that are for an input of the material's output node, and none of a shader."""
MODULES = {
    "scene": "Scenes",
    "camera": "Cameras",
    "motion": "Motion",
    "objects": "Objects",
    "light": "Lights",
    "world": "Worlds",
    "material": "Materials",
    "lecture": "Materials",
    "inside": "Materials",
    "nodes": "Node trees",
    "values": "Node trees",
    "images": "Images",
    "missing": "Libraries",
}
"""Where what is noted of whole data-blocks stands in the code, and in the page."""


def main():
    """Write the page."""
    glanz.register()
    PAGE.write_text(page(rows_of(PAGE.read_text() if PAGE.exists() else "")))
    sys.stdout.flush()
    os._exit(0)


def page(old):
    """The text of docs/support.md; `old` {node: how} are rows for nodes that this Blender lacks."""
    rows = old | node_rows()
    figures = agreement()
    table = "".join(f"| {node} | {rows[node]} | {figures.get(node, '')} |\n" for node in sorted(rows))
    return HEAD + features() + NODES + table


def rows_of(text):
    """{node: how} of the table of nodes in a page."""
    table = text.partition("\n## Nodes\n")[2]
    return dict(re.findall(r"^\| (.*?) \| (.*?) \| .*\|$", table, re.MULTILINE)[1:])


def agreement():
    """{node: least share, in words}."""
    known = json.loads((ROOT / "docs" / "nodes.json").read_text())
    least = {}
    for shares in known["shares"].values():
        for kind, of_modes in shares.items():
            if of_modes:
                label = known["labels"][kind]
                least[label] = min(least.get(label, 1.0), *of_modes.values())
    return {label: f"{share:.1%}" for label, share in least.items()}


def features():
    """The tables of all that is no node."""
    exact = {
        "Cameras": [f"{camera._KINDS[kind][0].label.lower()} cameras" for kind in camera._KINDS],
        "Lights": [f"{kind.lower()} lights" for kind in light._KINDS],
        "Passes": [
            ", ".join(name for name in passes.TABLE if name != "Shadow"),
            "Shadow, which Cycles has not: EEVEE's, but in colours and by traced rays",
            "Cryptomatte by object, material and asset",
            "AOVs of materials",
            "light groups",
        ],
        "Objects": ["meshes, curves, surfaces, text and metaballs, with modifiers, and instances of them"],
        "Motion": ["cameras and objects that move, turn, grow and deform"],
    }
    noted = {"Passes": {DENOISING: "approximated"}}
    for module, section in MODULES.items():
        noted.setdefault(section, {}).update(notes_of(module))
    parts = []
    for section in dict.fromkeys((*noted, *exact)):
        lines = [f"| {what} | exact |" for what in exact.get(section, ())]
        lines += [f"| {what} | {kind} |" for what, kind in noted.get(section, {}).items()]
        if lines:
            parts.append("\n".join(("", f"## {section}", "", "| what | how |", "|---|---|", *lines)) + "\n")
    return "".join(parts)


def notes_of(module):
    """{what: kind} of the notes for whole data-blocks that a module of the export may make; what differs is an ellipsis."""
    found = {}
    for call in ast.walk(ast.parse((ROOT / "addon" / "export" / f"{module}.py").read_text())):
        if not isinstance(call, ast.Call) or ast.unparse(call.func) not in ("findings.note", "self._findings.note", "self.note", "note"):
            continue
        what, kinds = call.args[0], [getattr(findings, arg.id) for arg in call.args[1:] if isinstance(arg, ast.Name) and arg.id.isupper()]
        kind = kinds[0] if kinds else findings.APPROXIMATED
        for text in _texts(what, module):
            found[text] = kind
    return found


def _texts(expression, module):
    """What an expression in the code may say."""
    if isinstance(expression, ast.Constant):
        return [expression.value]
    if isinstance(expression, ast.JoinedStr):
        return ["".join(part.value if isinstance(part, ast.Constant) else "…" for part in expression.values).replace("……", "…")]
    tables = {("objects", "_NOT_RENDERED"): objects._NOT_RENDERED.values(), ("scene", "what"): scene._NOT_FOLLOWED}
    name = ast.unparse(expression).partition("[")[0]
    # The notes of nodes go by way of a parameter.
    return list(tables[module, name]) if (module, name) != ("nodes", "what") else []


def node_rows():
    """{node: how} for each shader node that this Blender offers."""
    found = {}
    material = bpy.data.materials.new("Scratch")
    if material.node_tree is None:
        material.use_nodes = True
    with warnings.catch_warnings(action="ignore"):
        for name in sorted(name for name in dir(bpy.types) if name.startswith("ShaderNode")):
            try:
                node = material.node_tree.nodes.new(name)
                label, is_shown = node.bl_label, bool(node.outputs) and name not in NO_NODES
            except RuntimeError:
                # A base class, or one that this version keeps for files only.
                continue
            if is_shown:
                found[label] = _how(_tried(material, name))
    bpy.data.materials.remove(material)
    return found


def _how(notes):
    """What is said of a node: {what: kind} in words."""
    if not notes:
        return "exact"
    return "; ".join(f"{kind}: {what}" for what, kind in sorted(notes.items(), key=lambda note: (findings.KINDS.index(note[1]), note[0])))


def _tried(material, kind):
    """{what: kind} of all that is noted of a node with any of its inputs set or fed, and in any mode."""
    found = {}
    for change in list(_changes(_built(material, kind), material.node_tree)):
        node = _built(material, kind)
        # Some modes are for the nodes of other trees.
        with suppress(TypeError):
            change(node)
        noted = findings.Findings()
        exported = export_material(material, noted, Bitmaps())
        # Files are missing as there are none here. What is said of other nodes is said because of this one.
        found |= {note.what: note.kind for note in noted.notes if note.kind != findings.MISSING and note.node}
        if any(type(lobe).key in PHONG for lobe in exported.lobes) and node.outputs[0].type == "SHADER":
            found[ROUGH] = findings.APPROXIMATED
    return found


def _built(material, kind):
    """A node of this kind in a material that is nothing else."""
    tree = material.node_tree
    tree.nodes.clear()
    node, end = tree.nodes.new(kind), tree.nodes.new("ShaderNodeOutputMaterial")
    if hasattr(node, "image"):
        node.image = bpy.data.images.get("Scratch") or bpy.data.images.new("Scratch", 1, 1)
    _shown(tree, node, end)
    return node


def _shown(tree, node, end):
    for output in (output for output in node.outputs if output.enabled):
        if output.type == "SHADER" or output.name in OUTPUTS:
            tree.links.new(output, end.inputs[OUTPUTS.get(output.name, "Surface" if "Volume" not in node.bl_label else "Volume")])
        else:
            # Each output has its own way to the surface.
            glow, sum_of = tree.nodes.new("ShaderNodeEmission"), tree.nodes.new("ShaderNodeAddShader")
            tree.links.new(output, glow.inputs["Color"])
            before = end.inputs["Surface"].links
            if before:
                tree.links.new(before[0].from_socket, sum_of.inputs[1])
            tree.links.new(glow.outputs[0], sum_of.inputs[0])
            tree.links.new(sum_of.outputs[0], end.inputs["Surface"])


def _changes(node, tree):
    """Functions that change a node: nothing, one input, or one mode."""
    yield lambda node: None
    for i, socket in enumerate(node.inputs):
        if socket.type == "VALUE":
            yield lambda node, i=i: setattr(node.inputs[i], "default_value", 0.5)
        if socket.type == "BOOLEAN":
            yield lambda node, i=i: setattr(node.inputs[i], "default_value", True)
        if socket.type != "SHADER" and not socket.is_unavailable:
            yield lambda node, i=i: tree.links.new(tree.nodes.new("ShaderNodeTexNoise").outputs[0], node.inputs[i])
    base = bpy.types.ShaderNode.bl_rna.properties
    for prop in node.bl_rna.properties:
        if prop.type == "ENUM" and prop.identifier not in base and not prop.is_readonly:
            for item in prop.enum_items:
                yield lambda node, name=prop.identifier, item=item.identifier: setattr(node, name, item)


if __name__ == "__main__":
    main()
