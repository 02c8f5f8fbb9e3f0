"""What the export left out or approximated, collected so that a thousand objects give one line."""

from dataclasses import dataclass

from ...engine import SceneError

APPROXIMATED = "approximated"
"""Rendered, but not as Blender renders it."""
IGNORED = "ignored"
"""Not rendered, as if it were not asked for."""
MISSING = "missing"
"""What the file refers to and is not there: images, node groups, libraries, layers of meshes."""
KINDS = (MISSING, IGNORED, APPROXIMATED)
"""The worst first. What is exact has no note."""
LOST = (MISSING, IGNORED)
"""The kinds that are errors where a scene is strict."""

_MOST_NAMES = 4


@dataclass(frozen=True)
class Note:
    """One thing that is not rendered as Blender renders it.

    what   happened, such as "hair particles are not rendered"
    owner  whom it concerns, such as "object 'Cube'"; "": the text says it
    kind   one of `KINDS`
    node   names of the node, its group nodes first; (): it is no node
    """

    what: str
    owner: str
    kind: str = APPROXIMATED
    node: tuple = ()

    @property
    def place(self):
        """The owner with the node, such as "node 'Mix' in 'Group' of material 'Wood'"."""
        return f"node {' in '.join(repr(name) for name in self.node[::-1])} of {self.owner}" if self.node else self.owner

    @property
    def datablock(self):
        """(kind, name) of the owner, such as ("object", "Cube")."""
        kind, _, name = self.owner.partition(" '")
        return kind, name.removesuffix("'")

    def as_dict(self):
        """The note, ready for JSON."""
        kind, name = self.datablock
        return {"what": self.what, "kind": self.kind, "datablock": kind, "name": name, "node": list(self.node)}


class Findings:
    """Notes grouped by what they say; each names who is concerned, once. `is_strict`: what is lost is an error."""

    def __init__(self):
        self._notes = {}
        self.is_strict = False

    def note(self, what, owner, kind=APPROXIMATED, node=()):
        """Record a `Note` of these fields."""
        self._notes[Note(what, owner, kind, node)] = True

    def take(self, warnings):
        """Record what the engine warns of, `SceneWarning`s, and return it in `grouped` lines."""
        notes = [Note(w.what, w.owner, IGNORED if w.is_lost else APPROXIMATED) for w in warnings]
        self._notes |= dict.fromkeys(notes, True)
        return grouped(notes)

    @property
    def notes(self):
        """All notes in the order in which they came up."""
        return tuple(self._notes)

    def lines(self, kinds=KINDS):
        """One warning for each thing that happened, with the first few names and the count of the others."""
        return grouped(note for note in self._notes if note.kind in kinds)

    def refuse_lost(self, scene_name):
        """Raises SceneError with all that is missing or ignored, where that is an error."""
        if self.is_strict and (lines := self.lines(LOST)):
            raise SceneError(
                f"scene '{scene_name}' is strict, and Glanz does not render all of it:\n"
                + ";\n".join(lines)
                + ".\nChange this in the scene, or switch Strict off"
            )


def grouped(notes):
    """Lines for `notes`, one for each thing that happened."""
    places = {}
    for note in notes:
        places.setdefault((note.what, note.kind), []).append(note.place)
    return tuple(what + (f": {_shortened(names)}" if any(names) else "") for (what, _), names in places.items())


def _shortened(names):
    rest = len(names) - _MOST_NAMES
    return ", ".join(names[:_MOST_NAMES]) + (f" and {rest} more" if rest > 0 else "")
