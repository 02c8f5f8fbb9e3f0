"""What moves while the shutter is open: Blender's frames between, looked at one after the other, and what is found in them.

As in Cycles the scene is that of the middle of the shutter, and an object with `motion_steps` n is looked at 2^n + 1 times. Things
that are the same at all times stand still, for the engine drops keys that are equal.
"""

from dataclasses import dataclass, replace

import bpy
import numpy as np

from ...engine import SceneError, require_memory
from .findings import IGNORED
from .mesh import corners, has_vertex_normals, is_flat, mesh_of, normals, triangle_corners, vertices

_MOST_STEPS = 7
"""As in Cycles: 129 keys."""
_LAST_FRAME = 1_048_574
"""Of Blender."""


def keys_of(ob, parent=None):
    """How many keys the motion of an object has, and of its instancer's, if any; 0 where motion blur is switched off."""
    own = getattr(ob, "cycles", None)
    if not getattr(own, "use_motion_blur", True):
        return 0
    count = 2 ** min(max(getattr(own, "motion_steps", 1), 1), _MOST_STEPS) + 1
    if parent is None:
        return count
    return min(count, keys_of(parent)) and max(count, keys_of(parent))


def may_deform(ob, parent=None):
    """Whether the object, and its instancer, if any, are meant to be blurred where they change their shape."""
    return all(getattr(getattr(owner, "cycles", None), "use_deform_motion", True) for owner in (ob, parent) if owner)


@dataclass(frozen=True)
class Shutter:
    """The frames (K,), with fractions, at equal times while the shutter is open, K odd; `frame_set` (frame, fraction) goes to one.

    start  the frame that was before
    blurs  whether the picture is; else passes alone show what moves
    Raises SceneError for frames that Blender does not have.
    """

    frames: tuple
    frame_set: object
    start: float
    blurs: bool = True

    def __post_init__(self):
        # Not "> ...": what is no number is refused too.
        if not all(abs(frame) <= _LAST_FRAME for frame in (self.start, *self.frames)):
            seen = f"from frame {self.frames[0]:g} to {self.frames[-1]:g}"
            raise SceneError(
                f"what moves is to be seen {seen}, allowed: -{_LAST_FRAME} to {_LAST_FRAME}; look at the frame and the shutter"
            )

    @classmethod
    def beside(cls, depsgraph, frame_set):
        """The frames before and after that of a scene, for passes; None where Blender does not go to others."""
        frame = depsgraph.scene_eval.frame_current + depsgraph.scene_eval.frame_subframe
        return frame_set and cls((frame - 1, frame, frame + 1), frame_set, frame, blurs=False)

    @classmethod
    def of(cls, depsgraph, frame_set, findings):
        """The shutter of a scene, or None where nothing is to be blurred."""
        scene = depsgraph.scene_eval
        render, cycles = scene.render, getattr(scene, "cycles", None)
        if not render.use_motion_blur:
            return None
        name = f"scene '{scene.name}'"
        if frame_set is None:
            findings.note("motion blur is not rendered", name, IGNORED)
            return None
        if not _is_box(render):
            findings.note("the shutter opens and closes at once, its curve is ignored", name, IGNORED)
        if getattr(cycles, "rolling_shutter_type", "NONE") != "NONE":
            findings.note("the shutter does not roll, the whole picture is exposed at once", name, IGNORED)
        length = render.motion_blur_shutter
        position = getattr(render, "motion_blur_position", getattr(cycles, "motion_blur_position", "CENTER"))
        frame = scene.frame_current + scene.frame_subframe
        first = frame - length * {"START": 0.0, "CENTER": 0.5, "END": 1.0}[position]
        count = max((keys_of(ob) for ob in depsgraph.objects), default=0)
        if not (count and length > 0):
            return None
        return cls(tuple(first + length * i / (count - 1) for i in range(count)), frame_set, frame)

    @property
    def middle(self):
        """The number of the key in the middle."""
        return len(self.frames) // 2

    def go(self, frame):
        """Let Blender evaluate the scene at `frame`."""
        whole = int(np.floor(frame))
        self.frame_set(whole, frame - whole)

    def __enter__(self):
        if self.frames[self.middle] != self.start:
            self.go(self.frames[self.middle])
        return self

    def others(self):
        """Goes to the other keys, and yields their numbers."""
        for number, frame in enumerate(self.frames):
            if number != self.middle:
                self.go(frame)
                yield number

    def __exit__(self, *error):
        self.go(self.start)

    def picked(self, keys, count):
        """`count` of the `keys`, a list, evenly: (count, ...)."""
        return np.stack(keys[:: max((len(keys) - 1) // (count - 1), 1)])


def _is_box(render):
    mapping = getattr(render, "motion_blur_shutter_curve", None)
    if mapping is None:
        return True
    mapping.initialize()
    return all(abs(mapping.evaluate(mapping.curves[0], i / 16) - 1) < 0.01 for i in range(17))


class CameraTrack:
    """Where the camera of one view is; `export` makes the engine's camera of what Blender says of it now, in the middle first."""

    def __init__(self, ob, export, blurs=True):
        self.middle = export()
        self._export, self._keys, self._blurs = export, keys_of(ob) if blurs else 3, blurs
        self._seen = {}

    def look(self, number):
        """Note where the camera is at the key `number`, which Blender is at."""
        if self._keys:
            self._seen[number] = self._export()

    def moved(self, shutter, findings):
        """The camera with its motion, if that blurs."""
        if not (self._seen and self._blurs):
            return self.middle
        seen = [self._seen.get(number, self.middle) for number in range(len(shutter.frames))]
        if any((camera.lens, getattr(camera, "window", ())) != (seen[0].lens, getattr(seen[0], "window", ())) for camera in seen):
            findings.note("the lens changes while the shutter is open, it is that of the middle", f"camera '{self.middle.name}'")
        return replace(self.middle, motion=shutter.picked([camera.world_from_camera for camera in seen], self._keys))

    def beside(self):
        """Where the camera is one frame before and one after, (2, 4, 4), for passes; (0, 4, 4) where nobody asks."""
        looks = () if self._blurs else self._seen.values()
        return np.array([camera.world_from_camera for camera in looks]).reshape(-1, 4, 4)


class Still:
    """What `Tracks` is where nothing is to be blurred."""

    def start(self, instance, matrix, mesh):
        """See `Tracks.start`."""

    def start_light(self, instance, matrix, light):
        """See `Tracks.start_light`."""

    def moved(self, identities, objects):
        """`objects` without those that are None, a tuple."""
        return tuple(o for o in objects if o is not None)


STILL = Still()


class Tracks:
    """Where objects and lights are, and what shape their meshes have: first in the middle, then at all other keys.

    `cameras`, the `CameraTrack`s, look whenever the objects do; `check` is called before, and may raise to stop.
    """

    def __init__(self, shutter, depsgraph, cameras, findings, check):
        self._check = check
        self._shutter, self._depsgraph, self._cameras, self._findings = shutter, depsgraph, cameras, findings
        self._instances, self._shapes, self._lights = {}, {}, []
        self._seen = {}

    def start(self, instance, matrix, mesh):
        """Note an instance in the middle: where it is, and which of the engine's meshes it has. Returns its identity."""
        ob, parent = instance.object, instance.parent
        shapes = None
        if mesh is not None and may_deform(ob, parent):
            if id(mesh) not in self._shapes:
                with mesh_of(ob) as data:
                    self._shapes[id(mesh)] = _Shapes(mesh, data, len(self._shutter.frames))
            shapes = self._shapes[id(mesh)]
        identity = self._identity(instance)
        matrices = [None] * len(self._shutter.frames)
        matrices[self._shutter.middle] = matrix
        self._instances[identity] = _Instance(matrices, keys_of(ob, parent), shapes)
        return identity

    def start_light(self, instance, matrix, light):
        """Note a light in the middle."""
        self._lights.append((self.start(instance, matrix, None), light))

    def moved(self, identities, objects):
        """`objects` without those that are None, each with its motion and its shapes; looks at all other keys for them."""
        for number in self._shutter.others():
            self._check()
            for camera in self._cameras:
                camera.look(number)
            self._look(number)
        for identity, light in self._lights:
            self._note_light(self._instances[identity], light)
        return tuple(self._moved(self._instances[i], o) for i, o in zip(identities, objects, strict=True) if o is not None)

    def _look(self, number):
        self._seen = {}
        for instance in self._depsgraph.object_instances:
            ob = instance.object
            if ob.type == "LIGHT" or (instance.show_self and isinstance(ob.data, bpy.types.Mesh)):
                known = self._instances.get(self._identity(instance))
                if known is None:
                    continue
                known.matrices[number] = np.array(instance.matrix_world, np.float64)
                if known.shapes:
                    with mesh_of(ob) as data:
                        known.shapes.look(number, data)

    def _moved(self, instance, o):
        if not instance.keys:
            return o
        if any(matrix is None or not np.isfinite(matrix).all() for matrix in instance.matrices):
            self._findings.note("it is not there all the time that the shutter is open, and stands still", f"object '{o.name}'")
            return o
        mesh = o.mesh
        if instance.shapes:
            mesh = instance.shapes.changed(instance.keys, self._shutter.picked)
            if instance.shapes.is_other:
                self._findings.note("its topology changes while the shutter is open, its shape stays", f"object '{o.name}'")
        return replace(o, mesh=mesh, motion=self._shutter.picked(instance.matrices, instance.keys))

    def _note_light(self, instance, light):
        if instance.keys and any(matrix is None or (matrix != instance.matrices[0]).any() for matrix in instance.matrices):
            self._findings.note("it moves, and is rendered where it is in the middle of the shutter", f"light '{light.name}'")

    def _identity(self, instance):
        """Who an instance is, at all times; if several have everything in common, the order tells them apart."""
        ids = (instance.object.original.as_pointer(),)
        if instance.is_instance:
            ids = (*ids, instance.parent.original.as_pointer() if instance.parent else 0, *instance.persistent_id)
        self._seen[ids] = self._seen.get(ids, 0) + 1
        return (*ids, self._seen[ids])


class Beside(Tracks):
    """Where objects are one frame before and one after, for passes: the picture stays as it is."""

    def start_light(self, instance, matrix, light):
        """Nobody asks."""

    def _moved(self, instance, o):
        before, middle, after = instance.matrices
        mesh = instance.shapes.beside() if instance.shapes else o.mesh
        is_known = before is not None and after is not None and np.isfinite((before, after)).all()
        if not is_known or ((before == middle) & (after == middle)).all():
            return replace(o, mesh=mesh)
        return replace(o, mesh=mesh, beside=np.stack((before, after)))


@dataclass(frozen=True)
class _Instance:
    """The matrices of an instance, None where it is not there; how many `keys` it has; its `_Shapes`, if it may have any."""

    matrices: list
    keys: int
    shapes: object


class _Shapes:
    """The shapes that one mesh takes; `is_other` where it is another mesh at some time.

    `data` is Blender's mesh in the middle.
    """

    def __init__(self, mesh, data, count):
        self._mesh, self._corners = mesh, corners(data)
        # Faces may be triangulated otherwise at other times.
        self._triangle_corners = triangle_corners(data) if has_vertex_normals(data) else None
        self._vertices, self._normals = [mesh.vertices] * count, [mesh.normals] * count
        self._looked = set()
        self._changed = {}
        self.is_other = False

    def look(self, number, data):
        """Note the shape of Blender's mesh `data`, once for each key."""
        if number in self._looked or self.is_other:
            return
        self._looked.add(number)
        now = vertices(data)
        if np.array_equal(now, self._mesh.vertices):
            return
        if now.shape != self._mesh.vertices.shape or not np.array_equal(corners(data), self._corners):
            self.is_other = True
            return
        if all(shape is self._mesh.vertices for shape in self._vertices):
            # All of them, and once more side by side.
            needed = 2 * len(self._vertices) * (now.nbytes + self._mesh.normals.nbytes)
            what = f"the {len(self._vertices)} shapes of mesh '{self._mesh.name}', with {now.shape[1]} vertices each,"
            require_memory(needed, what, "take fewer motion steps, or switch off its deformation blur")
        self._vertices[number] = now
        if self._mesh.is_smooth and not is_flat(data):
            now, is_of_vertices = normals(data), has_vertex_normals(data)
            if self._triangle_corners is not None and not is_of_vertices:
                self._sharpen()
            self._normals[number] = now.take(self._corners, axis=1) if is_of_vertices and self._triangle_corners is None else now

    def _sharpen(self):
        """From normals of vertices to those of corners: an edge is sharp at some time."""
        self._normals = [values.take(self._corners, axis=1) for values in self._normals]
        smooth = self._mesh.normals.take(self._corners, axis=1)
        self._mesh = replace(self._mesh, normals=smooth, normal_indices=self._triangle_corners)
        self._triangle_corners = None

    def beside(self):
        """The mesh with the shapes of the frames beside; as it was where it does not change or is another."""
        if self.is_other or all(shape is self._mesh.vertices for shape in self._vertices):
            return self._mesh
        if "beside" not in self._changed:
            self._changed["beside"] = replace(self._mesh, beside=np.stack(self._vertices[::2]))
        return self._changed["beside"]

    def changed(self, count, picked):
        """The mesh with `count` of the shapes, the same value each time; as it was where it does not change or is another."""
        if self.is_other or all(shape is self._mesh.vertices for shape in self._vertices):
            return self._mesh
        if count not in self._changed:
            self._changed[count] = replace(self._mesh, shapes=picked(self._vertices, count), shape_normals=picked(self._normals, count))
        return self._changed[count]
