"""What Blender says has changed since it told the last time, and what of it may concern shapes, images and looks."""

import bpy

_SHAPES = ("MESH", "CURVE", "CURVES", "META", "LATTICE", "ARMATURE", "KEY")
"""Blender's types of data-blocks that make shapes."""


def identities(*datablocks):
    """What stays of data-blocks of the file for as long as Blender runs, whatever copies are evaluated of them; a set.

    What is no part of the file, such as meshes that nodes make, has nothing that stays.
    """
    return {getattr(d.original or d, "session_uid", 0) for d in datablocks if d is not None} - {0}


def changed_shapes(depsgraph):
    """`identities` of what may have another shape, None where that may be anything."""
    updates = list(depsgraph.updates)
    told = {update.id.id_type for update in updates}
    # Blender may say that something of a type has changed, and not what.
    if any(depsgraph.id_type_updated(kind) and kind not in told for kind in _SHAPES):
        return None
    return identities(*(update.id for update in updates if update.is_updated_geometry or _is_anything(update)))


def _is_anything(update):
    is_told = update.is_updated_transform or update.is_updated_shading
    return not is_told and update.id.id_type in ("OBJECT", *_SHAPES)


def changed_images(depsgraph):
    """`identities` of images that may have changed, as far as Blender tells of it: see `stamps`. None where that may be any.

    Of images that were loaded again Blender says no more than that node trees have changed which show them.
    """
    updates = list(depsgraph.updates)
    images = [update.id for update in updates if isinstance(update.id, bpy.types.Image)]
    if depsgraph.id_type_updated("IMAGE") and not images:
        return None
    trees = [update.id for update in updates if isinstance(update.id, bpy.types.NodeTree)]
    return identities(*images, *(getattr(node, "image", None) for tree in trees for node in tree.nodes))


def changed_looks(depsgraph):
    """`identities` of materials and worlds that may have changed, None where that may be any."""
    updates = [update.id for update in depsgraph.updates]
    trees = [datablock for datablock in updates if isinstance(datablock, bpy.types.ShaderNodeTree)]
    owners = [datablock for datablock in updates if isinstance(datablock, (bpy.types.Material, bpy.types.World))]
    # Of groups, and where Blender says that there is something and not what, it may be anything.
    is_unsaid = not trees and not owners and any(map(depsgraph.id_type_updated, ("MATERIAL", "WORLD", "NODETREE")))
    if is_unsaid or not all(tree.is_embedded_data for tree in trees):
        return None
    originals = [tree.original for tree in trees]
    owners += [owner for owner in (*bpy.data.materials, *bpy.data.worlds) if originals and owner.node_tree in originals]
    return identities(*owners)
