"""What a viewport does not export again: meshes and images that are as they were."""

from .bitmaps import Bitmaps

_SHAPES = ("MESH", "CURVE", "CURVES", "META", "LATTICE", "ARMATURE", "KEY")
"""Blender's types of data-blocks that make shapes."""


class Kept:
    """The engine's meshes and bitmaps, by the data-blocks that they are of."""

    def __init__(self):
        self._before, self._asked = {}, {}
        self._bitmaps = Bitmaps()

    def mesh(self, ob, attributes, make):
        """The engine's mesh of an object (evaluated) for these attributes: as it is known, or else what `make()` says.

        Evaluated data is known by its address, which may be another's later; so it also has to belong to the same
        object, or to the same data-block of the file.
        """
        key = ob.data.as_pointer(), attributes
        own = _owners(ob)
        owners, mesh = self._asked.get(key) or self._before.get(key, (set(), None))
        # Within an export no address is another's.
        if key not in self._asked and owners.isdisjoint(own):
            owners, mesh = set(), make()
        owners.update(own)
        self._asked[key] = owners, mesh
        return mesh

    def bitmaps(self, frame):
        """`Bitmaps` for a frame of the scene, which knows the images of earlier exports."""
        self._bitmaps = Bitmaps(frame, self._bitmaps.asked)
        return self._bitmaps

    def update(self, depsgraph):
        """Forget what Blender says has changed, and what nobody asked for since the last time; to be called before each export."""
        if depsgraph.id_type_updated("IMAGE"):
            self._bitmaps = Bitmaps()
        updates = [update for update in depsgraph.updates if update.is_updated_geometry]
        changed = {_identity(update.id) for update in updates}
        is_known = bool(updates) or not any(map(depsgraph.id_type_updated, _SHAPES))
        self._before = {key: value for key, value in self._asked.items() if is_known and not value[0] & changed}
        self._asked = {}


def _owners(ob):
    return {_identity(ob), _identity(ob.data)}


def _identity(datablock):
    """What stays of a data-block of the file for as long as Blender runs, whatever copies are evaluated of it."""
    original = datablock.original or datablock
    return getattr(original, "session_uid", 0) or original.as_pointer()
