"""Persistent data: what frames before were exported as and compiled to, for those that are the same but for their camera.

Meshes, images, materials and worlds are exported anew where they have changed, or may have, see `export.kept`; all else is in each
frame, and all values are compared. So nothing that changes is overlooked, and what takes the time is done once.
"""

from dataclasses import fields, is_dataclass, replace

import numpy as np

from ..engine import NO_CHECKPOINT, Progress, prepare, render_plan
from .export import Kept, stamp_of


class Persistent:
    """What stays from frame to frame: what was exported, and the last plan of each view layer and view, by keys of any kind."""

    def __init__(self):
        self.kept = Kept(stamp_of)
        self._known = {}

    def watched(self, depsgraph, frame_set):
        """`frame_set`, after which is forgotten what Blender says it has changed."""

        def go(frame, subframe):
            frame_set(frame, subframe)
            self.kept.forget(depsgraph)

        return go

    def render(self, key, scene, settings, ends=(), checkpoint=NO_CHECKPOINT):
        """As the engine's `render`; nothing is compiled where `scene` differs from the last with this `key` in its camera alone."""
        plan, told, before = self._known.get(key, (None, (), None))
        if plan and _film_aside(plan.settings) == _film_aside(settings) and is_same(_camera_aside(before), _camera_aside(scene)):
            yield Progress(0.0, warnings=told)
            plan = plan.seen_from(scene.camera, settings)
            # Far from where the first camera was, single precision asks for a render space of its own.
            plan = plan if plan.is_exact() else prepare(scene, settings)[0]
        else:
            # Not two at once in memory, unless Embree's tree can stay.
            self._known.pop(key, None)
            plan = plan if plan and _has_same_tree(plan, before, scene) else None
            yield Progress(0.0)
            plan, told = prepare(scene, settings, before=plan)
            yield Progress(0.0, warnings=told)
        self._known[key] = plan, told, scene
        yield from render_plan(plan, ends, checkpoint=checkpoint)


def _has_same_tree(plan, before, scene):
    """Whether `scene` has the shapes and places of the scene `before`, of the `plan`, also as seen from its camera."""
    return np.array_equal(plan.world.frame.origin, scene.camera.position) and is_same(_shapes(before), _shapes(scene))


def _shapes(scene):
    return [(o.mesh, o.world_from_object, o.motion) for o in scene.objects]


def _film_aside(settings):
    return replace(settings, seed=0)


def _camera_aside(scene):
    return [getattr(scene, field.name) for field in fields(scene) if field.name != "camera"]


def is_same(a, b):
    """Whether two values of the engine are the same, bit by bit; what it does not know how to compare is not, unless it is one thing."""
    todo, seen = [(a, b)], set()
    while todo:
        a, b = todo.pop()
        if a is b or (id(a), id(b)) in seen:
            continue
        if type(a) is not type(b):
            return False
        seen.add((id(a), id(b)))
        if isinstance(a, np.ndarray):
            if a.__array_interface__ == b.__array_interface__ and not a.dtype.hasobject:
                continue
            if (a.dtype, a.shape) != (b.dtype, b.shape) or a.dtype.hasobject or a.tobytes() != b.tobytes():
                return False
        elif is_dataclass(a):
            todo += [(getattr(a, field.name), getattr(b, field.name)) for field in fields(a)]
        elif isinstance(a, dict):
            if a.keys() != b.keys():
                return False
            todo += [(a[key], b[key]) for key in a]
        elif isinstance(a, (tuple, list)):
            if len(a) != len(b):
                return False
            todo += zip(a, b, strict=True)
        elif not (isinstance(a, (int, float, str, bytes, frozenset, np.generic, type(None))) and a == b):
            return False
    return True
