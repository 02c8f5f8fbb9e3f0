"""Notes are few, whatever the size of the scene; each says what, who, which node, and how it is rendered."""

import json

import bpy
import pytest

from glanz.addon.export import export_scene
from glanz.addon.export.findings import APPROXIMATED, IGNORED, LOST, MISSING, Findings
from glanz.addon.settings import settings_of
from glanz.engine import SceneError

from .. import blender


def notes():
    """{what: [note]} of the open file."""
    findings, depsgraph = Findings(), bpy.context.evaluated_depsgraph_get()
    _, warnings = export_scene(depsgraph, settings_of(depsgraph.scene_eval, depsgraph.view_layer_eval), findings=findings)
    assert warnings == findings.lines()
    found = {}
    for note in findings.notes:
        found.setdefault(note.what, []).append(note)
    return found


def test_equal_notes_become_one_line_with_names_and_a_count():
    findings = Findings()
    for i in range(1000):
        findings.note("hair is not rendered", f"object '{i % 10}'")
    findings.note("volumes are not rendered", "object 'Fog'")
    assert findings.lines() == (
        "hair is not rendered: object '0', object '1', object '2', object '3' and 6 more",
        "volumes are not rendered: object 'Fog'",
    )


def test_a_strict_scene_refuses_what_is_lost_and_lets_pass_what_is_approximated():
    findings = Findings()
    findings.is_strict = True
    findings.note("sheen is diffuse", "material 'Silk'", APPROXIMATED)
    findings.refuse_lost("Shop")
    findings.note("hair is not rendered", "object 'Fox'", IGNORED)
    findings.note("the image is missing", "material 'Wall'", MISSING, ("Group", "Image"))
    with pytest.raises(SceneError, match="scene 'Shop' is strict") as raised:
        findings.refuse_lost("Shop")
    assert "object 'Fox'" in str(raised.value) and "node 'Image' in 'Group' of material 'Wall'" in str(raised.value)
    assert "Silk" not in str(raised.value)
    findings.is_strict = False
    findings.refuse_lost("Shop")
    assert len(findings.lines(LOST)) == 2 and len(findings.lines()) == 3


def test_owners_keep_any_name():
    findings = Findings()
    findings.note("odd", "object 'Rock 'n' Roll''")
    (note,) = findings.notes
    assert note.datablock == ("object", "Rock 'n' Roll'")
    assert json.loads(json.dumps(note.as_dict())) == {
        "what": "odd",
        "kind": "approximated",
        "datablock": "object",
        "name": "Rock 'n' Roll'",
        "node": [],
    }


def test_nodes_are_named_with_the_groups_that_they_are_in():
    """The same group twice: each use has a note; so has each material that shows a missing image."""
    group = bpy.data.node_groups.new("Aged", "ShaderNodeTree")
    group.interface.new_socket("Colour", in_out="OUTPUT", socket_type="NodeSocketColor")
    inner, end = group.nodes.new("ShaderNodeTexImage"), group.nodes.new("NodeGroupOutput")
    inner.name, inner.image = "Rust", bpy.data.images.new("lost", 1, 1)
    inner.image.source, inner.image.filepath = "FILE", "//no_such_file.png"
    group.links.new(inner.outputs[0], end.inputs[0])
    for name in ("Door", "Gate"):
        material = blender.new_material(name, "ShaderNodeBsdfToon")
        tree = material.node_tree
        user = tree.nodes.new("ShaderNodeGroup")
        user.node_tree, user.name = group, f"{name}'s group"
        tree.links.new(user.outputs[0], tree.nodes["Toon BSDF"].inputs["Color"])
        blender.add_plane(name).data.materials.append(material)
    blender.add_camera()
    found = notes()
    images = found["the image 'lost' is missing and is rendered magenta"]
    assert {(n.owner, n.node, n.kind) for n in images} == {
        ("material 'Door'", ("Door's group", "Rust"), MISSING),
        ("material 'Gate'", ("Gate's group", "Rust"), MISSING),
    }
    toons = found["Toon BSDF is not supported and is rendered as Diffuse of its colour"]
    assert [(n.node, n.kind) for n in toons] == [(("Toon BSDF",), APPROXIMATED)] * 2


def test_what_has_no_node_names_its_owner_alone():
    blender.add_camera()
    bpy.context.scene.render.use_freestyle = True
    ((note,),) = notes().values()
    assert (note.place, note.node, note.kind) == ("scene 'Scene'", (), IGNORED)
