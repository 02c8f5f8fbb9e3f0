"""Nothing is found by a name that users or translations of Blender may change: what is renamed exports the same, to the bit."""

import pytest

from glanz.addon.persistent import is_same
from glanz.tests.addon import blender
from glanz.tests.addon.export import trees
from glanz.tests.samples.samples import NAMES, open_sample


@pytest.mark.parametrize("name", NAMES)
def test_names_in_node_trees_mean_nothing(name):
    open_sample(name)
    scene, warnings = blender.export()
    trees.rename_all()
    again, warnings_again = blender.export()
    assert is_same(scene, again)
    assert trees.nameless(warnings) == trees.nameless(warnings_again)
