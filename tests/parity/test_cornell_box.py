"""Light that bounces: the sample scene `cornell_box` has the same brightness everywhere as in Cycles, with equal bounces."""

from pathlib import Path

import bpy
import numpy as np
import pytest

import glanz
from glanz.tests.parity import parity

FILE = Path(glanz.__file__).parent / "sample_scenes" / "cornell_box.blend"
SIDE = 128
"""Pixels per side: 16 blocks of 32 x 32."""
SAMPLES = 256
"""Two seeds of Glanz differ by 0.14 % in the worst block."""


@pytest.fixture(scope="module")
def pictures(tmp_path_factory):
    """The picture that an engine makes with a number of bounces; each is rendered once."""
    made = {}

    def of(engine, bounces):
        if (engine, bounces) not in made:
            open_box(bounces)
            made[engine, bounces] = parity.pixels(engine, tmp_path_factory.mktemp("pictures"))
        return made[engine, bounces]

    return of


def open_box(bounces, samples=SAMPLES):
    bpy.ops.wm.open_mainfile(filepath=str(FILE))
    render = bpy.context.scene.render
    render.resolution_x = render.resolution_y = SIDE
    parity.be_exact(samples, bounces)


@pytest.mark.parametrize("bounces", [0, 8])
def test_every_block_of_the_cornell_box_is_as_bright_as_in_cycles(pictures, bounces):
    """An error of 0.5 % in one of 16 blocks is noticed; all agree to 0.15 %."""
    assert parity.difference(pictures("GLANZ", bounces), pictures("CYCLES", bounces)) < parity.TOLERANCE


def test_bounces_left_out_are_noticed(pictures):
    assert parity.difference(pictures("GLANZ", 5), pictures("CYCLES", 8)) > parity.TOLERANCE


def test_a_wall_that_reflects_1_percent_less_is_noticed(pictures, tmp_path):
    """The mutant is rendered by Glanz only."""
    open_box(bounces=8)
    shader = next(node for node in bpy.data.materials["Red"].node_tree.nodes if node.type == "BSDF_DIFFUSE")
    colour = shader.inputs["Color"].default_value
    shader.inputs["Color"].default_value = (*(0.99 * np.array(colour[:3])), 1)
    assert parity.difference(parity.pixels("GLANZ", tmp_path), pictures("CYCLES", 8)) > parity.TOLERANCE
