"""What is not exported again: meshes, images, materials and worlds that are as they were."""

from .bitmaps import Bitmaps
from .changes import changed_images, changed_looks, changed_shapes, identities
from .looks import Looks
from .stamps import no_stamp


class Kept:
    """The engine's meshes, bitmaps and `looks`, by the data-blocks that they are of.

    stamp  what else tells that an image has changed, see `stamps`
    """

    def __init__(self, stamp=no_stamp):
        self._meshes, self._wanted, self._exported = {}, set(), set()
        self._bitmaps, self.looks = Bitmaps(stamp=stamp), Looks(stamp)

    def begin(self, frame):
        """`Bitmaps` for an export at a frame of the scene, which begins."""
        self._exported = set()
        self.looks.begin()
        return self._bitmaps.begin(frame)

    def mesh(self, ob, attributes, make):
        """The engine's mesh of an object (evaluated) for these attributes: as it is known, or else what `make()` says.

        Evaluated data is known by its address, which may be another's later; so it also has to belong to the same
        object, or to the same data-block of the file.
        """
        key = ob.data.as_pointer(), attributes
        own = identities(ob, ob.data)
        owners, mesh = self._meshes.get(key, (set(), None))
        # Within an export no address is another's.
        if key not in self._exported and owners.isdisjoint(own):
            owners, mesh = set(), make()
        owners.update(own)
        self._meshes[key] = owners, mesh
        self._wanted.add(key)
        self._exported.add(key)
        return mesh

    def forget(self, depsgraph):
        """Forget what Blender says has changed; to be called after each evaluation of the scene, as it tells but once."""
        shapes, images = changed_shapes(depsgraph), changed_images(depsgraph)
        self._meshes = {key: value for key, value in self._meshes.items() if shapes is not None and not value[0] & shapes}
        self._bitmaps.forget(images)
        self.looks.forget(changed_looks(depsgraph), images)

    def tidy(self):
        """Forget what nobody has asked for since this was called the last time."""
        self._meshes = {key: value for key, value in self._meshes.items() if key in self._wanted}
        self._wanted = set()
        self._bitmaps.tidy()
        self.looks.tidy()
