"""Materials and worlds that are as they were: what they are to the engine, and what was noted of them."""

from dataclasses import dataclass

import bpy

from .changes import identities
from .findings import Findings


@dataclass(frozen=True, eq=False)
class _Look:
    """A value and its notes; the `stamps` of the images {identity: stamp} that it shows."""

    value: object
    notes: tuple
    stamps: dict


class Looks:
    """Engine values of data-blocks with nodes, whose images are known by `stamp`, see `stamps`.

    What refers to anything else, such as the place of an object or the frame of a movie, is not kept: Blender does not say of
    whom that is a part. Neither is what shows images that are painted.
    """

    def __init__(self, stamp):
        self._stamp = stamp
        self._known, self._wanted = {}, set()
        self.begin()

    def begin(self):
        """An export begins."""
        self._images, self._stamps = None, {}

    def of(self, datablock, kind, findings, make):
        """The value of a data-block (evaluated, or None), as it is known, or else what `make(findings)` says; `findings` are told.

        kind  what else the value depends on
        """
        own = frozenset(identities(datablock))
        if not own:
            return make(findings)
        key = own, datablock.name_full, kind
        look = self._known.get(key)
        if look is None or any(self._stamp_of(image) != stamp for image, stamp in look.stamps.items()):
            look = self._known[key] = self._made(datablock, make)
        self._wanted.add(key)
        if look.stamps is None:
            del self._known[key]
        for note in look.notes:
            findings.note(note.what, note.owner, note.kind, note.node)
        return look.value

    def forget(self, changed, images):
        """Forget those of the data-blocks `changed`, and those that show `images`, sets of identities, see `changes`; None: all."""
        is_known = changed is not None and images is not None
        self._known = {
            key: look for key, look in self._known.items() if is_known and changed.isdisjoint(key[0]) and images.isdisjoint(look.stamps)
        }

    def tidy(self):
        """Forget those that nobody has asked for since this was called the last time."""
        self._known = {key: look for key, look in self._known.items() if key in self._wanted}
        self._wanted = set()

    def _made(self, datablock, make):
        findings = Findings()
        value, images = make(findings), _images_of(datablock.node_tree)
        stamps = None if images is None else {image: self._stamp_of(image) for image in images}
        if stamps and None in stamps.values():
            stamps = None
        return _Look(value, findings.notes, stamps)

    def _stamp_of(self, identity):
        """The stamp of an image, None where there is none that stays."""
        if self._images is None:
            self._images = {image.session_uid: image for image in bpy.data.images}
        if identity not in self._stamps:
            image = self._images.get(identity)
            self._stamps[identity] = image and self._stamp(image)
        return self._stamps[identity]


def _images_of(tree):
    """Identities of the images that the nodes of a tree (or None), and those of its groups, refer to; None where that is not all."""
    images, todo, seen = set(), [tree] if tree else [], set()
    while todo:
        here = todo.pop()
        if here.as_pointer() in seen:
            continue
        seen.add(here.as_pointer())
        for datablock in _referred(here):
            if isinstance(datablock, bpy.types.NodeTree):
                todo.append(datablock)
            elif isinstance(datablock, bpy.types.Image) and datablock.source not in ("SEQUENCE", "MOVIE"):
                images |= identities(datablock)
            else:
                return None
    return images


def _referred(tree):
    """The data-blocks that the nodes of a tree refer to."""
    for node in tree.nodes:
        names = (p.identifier for p in node.bl_rna.properties if p.type == "POINTER")
        yield from (value for name in names if isinstance(value := getattr(node, name), bpy.types.ID))
