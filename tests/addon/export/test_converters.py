"""Nodes that compute become textures only where something varies, and are read only where they count."""

import bpy
import numpy as np
import pytest

from glanz.engine import CheckerTexture, Coordinates, Curves, Mapping, Math, MixColour, NoiseTexture
from glanz.tests.addon import blender


class Graph:
    """A material that glows with the output of a node."""

    def __init__(self):
        self.material = blender.new_material("Glow", "ShaderNodeEmission")
        self.tree = self.material.node_tree
        blender.add_plane().data.materials.append(self.material)

    def add(self, kind, source=None, into=0, **values):
        """A node; `values` are attributes in lower case, else inputs. The first output of `source` feeds the input `into`."""
        node = self.tree.nodes.new(f"ShaderNode{kind}")
        for name, value in values.items():
            if name.islower():
                setattr(node, name, value)
            else:
                blender.node_input(node, name).default_value = value
        if source is not None:
            self.tree.links.new(source.outputs[0], node.inputs[into])
        return node

    def exported(self, node, output=0):
        """(emission, warnings) with an output of `node` as its colour."""
        emission = next(n for n in self.tree.nodes if n.type == "EMISSION")
        self.tree.links.new(node.outputs[output], emission.inputs["Color"])
        scene, warnings = blender.export()
        return scene.objects[0].materials[0].emission, warnings


@pytest.fixture
def graph():
    return Graph()


def test_what_is_computed_of_constants_is_a_constant(graph):
    a = graph.add("Math", operation="MULTIPLY", Value=3.0, Value_001=0.5)
    b = graph.add("Gamma", a, Gamma=2.0)
    assert graph.exported(b) == ((2.25, 2.25, 2.25), ())


def test_inputs_that_an_operation_does_not_have_are_not_read(graph):
    noise = graph.add("TexNoise")
    root = graph.add("Math", noise, into=1, operation="SQRT", Value=4.0)
    assert graph.exported(root) == ((2.0, 2.0, 2.0), ())


def test_a_node_that_feeds_two_inputs_is_one_texture(graph):
    noise = graph.add("TexNoise")
    product = graph.add("Math", noise, operation="MULTIPLY")
    graph.tree.links.new(noise.outputs[0], product.inputs[1])
    found, _ = graph.exported(product)
    assert type(found) is Math and found.operation == "multiply" and type(found.a) is NoiseTexture and found.a is found.b


def test_affine_mappings_stay_coordinates(graph):
    places = graph.add("TexCoord")
    first = graph.add("Mapping", places, Scale=(2, 2, 2))
    second = graph.add("Mapping", first, Location=(1, 0, 0))
    checker, _ = graph.exported(graph.add("TexChecker", second, Scale=1.0))
    matrix = np.diag((2.0, 2.0, 2.0, 1.0))
    matrix[0, 3] = 1
    assert checker.coordinates == Coordinates(source="generated", matrix=matrix)


@pytest.mark.parametrize("varies", [False, True])
def test_other_mappings_are_textures(graph, varies):
    places = graph.add("TexCoord")
    mapping = graph.add("Mapping", places, vector_type="POINT" if varies else "NORMAL")
    if varies:
        graph.tree.links.new(graph.add("TexNoise").outputs[0], mapping.inputs["Scale"])
    checker, warnings = graph.exported(graph.add("TexChecker", mapping, Scale=1.0))
    assert type(checker) is CheckerTexture and warnings == ()
    inner = checker.coordinates.textures[0] if hasattr(checker.coordinates, "textures") else checker.coordinates
    assert type(inner) is Mapping and inner.kind == ("point" if varies else "normal")


def test_curves_are_read_without_a_change_to_them(graph):
    node = graph.add("RGBCurve", graph.add("TexNoise"), into=1)
    node.mapping.curves[1].points.new(0.3, 0.8)
    before = [[tuple(point.location) for point in curve.points] for curve in node.mapping.curves]
    found, _ = graph.exported(node)
    assert type(found) is Curves and found.table.shape == (3, 257) and found.goes_on
    assert [[tuple(point.location) for point in curve.points] for curve in node.mapping.curves] == before
    # The second curve, at 77 of 256 steps: next to its new point.
    assert found.table[1, 77] == pytest.approx(0.8, abs=0.01) and found.table[0, 77] == pytest.approx(0.3, abs=0.01)


def test_a_mix_of_old_files_is_that_of_new_ones(graph):
    old = graph.add("MixRGB", graph.add("TexNoise"), blend_type="SOFT_LIGHT", use_clamp=True)
    found, warnings = graph.exported(old)
    assert type(found) is MixColour and (found.blend, found.clamps_factor, found.clamps_result) == ("soft light", True, True)
    assert warnings == ()


def test_what_is_not_read_is_named(graph):
    _, warnings = graph.exported(graph.add("Squeeze", graph.add("TexNoise")))
    assert any("Squeeze" in line and "'Glow'" in line for line in warnings)


@pytest.mark.skipif(not hasattr(bpy.types, "ShaderNodeRadialTiling"), reason="before Blender 5.0 no vector has two numbers")
def test_vectors_of_two_numbers_lie_in_the_plane(graph):
    found, warnings = graph.exported(graph.add("RadialTiling"), output=2)
    assert warnings == () and found == pytest.approx((np.tan(np.pi / 5),) * 3)
