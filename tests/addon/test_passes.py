"""One table, and nothing beside it."""

import bpy

from glanz.addon import passes
from glanz.engine import PASSES


def test_blender_knows_every_pass_of_the_engine():
    assert set(passes.TABLE) == set(PASSES)


def test_flags_are_properties_of_view_layers():
    for row in passes.TABLE.values():
        if row.flag:
            owner, name = passes.switch(bpy.context.view_layer, row.flag)
            assert name in owner.bl_rna.properties


def test_what_is_chosen_is_what_is_registered():
    class Engine:
        registered = ()

        def register_pass(self, *row):
            self.registered = (*self.registered, row[2:])

    layer = bpy.context.view_layer
    layer.use_pass_z, layer.use_pass_normal = False, True
    engine = Engine()
    passes.register_passes(engine, bpy.context.scene, layer)
    assert engine.registered == (("Combined", 4, "RGBA", "COLOR"), ("Normal", 3, "XYZ", "VECTOR"))
    assert passes.chosen(layer, bpy.context.scene) == ("Combined", "Normal")
