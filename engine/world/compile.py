"""Scene values to one merged mesh, tables of materials and lights, and Embree's tree."""

from dataclasses import dataclass, replace

import numpy as np

from ..errors import AccelError, MemoryShortage, SceneError, SceneWarning
from ..maths.vectors import cross, dot, length
from ..scene.textured import asks_for_around
from ..scene.validate import torn
from ..scene.values import Material
from .accel import Accel
from .attributes import compile_attributes
from .by_cosine import ByCosine, tabulated
from .emitters import Emitters
from .frame import Frame
from .holdouts import Holdouts
from .lights import Lights
from .materials import Materials
from .measured import Lost, MeasuredAccel
from .media import Bodies, Media
from .movers import Movers, Moving
from .moving_lamps import MovingLamps
from .passing import Passing
from .placement import place
from .room import require_room
from .sights import Sight, Sights
from .sky import environment_of
from .texturing import EVEN, TexturedGlow
from .touching import moved_apart
from .views import CameraSpace

FARTHEST = 1e12
"""In render space; Embree's robust test overflows from 3e12 on, and finds nothing."""
AT_ONCE = 2**16
"""Triangles that are measured at once: in double precision they fit into the cache."""
_MOVES = 2
"""The rank of triangles that move: 0 is that of others, 1 that of those which emit."""


@dataclass(frozen=True, slots=True, eq=False)
class Triangles:
    """The merged mesh in render space; every array has one column per triangle.

    First those that stand still, of which those that emit come last; then those that move, object by object, each in its
    object's local frame (see `movers`), and once for each shape that it takes.

    shape           (12, F), in the precision of rays, as extent is: first corner, the edges to the second and third, and the geometric
                    normal (unit, by winding), three rows each
    extent          (F,): the largest coordinate of the edges by magnitude
    smooth          (F,) intp: a column of `corner_normals`, -1 for flat triangles; (0,): all are flat
    corner_normals  (9, S) float32: the shading normal of the first corner, and the differences to those of the second
                    and third
    material        (F,) intp, a row of `Materials`
    first_emitter   triangles from here on emit, up to
    first_moving    from where on they move
    runs            (R,) the first of triangles that are of one object, and `run_object` (R,) int32 the number of that
    """

    shape: np.ndarray
    extent: np.ndarray
    smooth: np.ndarray
    corner_normals: np.ndarray
    material: np.ndarray
    first_emitter: int
    first_moving: int
    runs: np.ndarray
    run_object: np.ndarray

    def owner(self, prim):
        """The number of the object that a triangle is of."""
        return int(self.run_object[np.searchsorted(self.runs, prim, side="right") - 1])


@dataclass(frozen=True, slots=True, eq=False)
class CompiledWorld:
    """What rays travel through.

    accel       the triangles that stand still, an `Accel` or a `MeasuredAccel`
    movers      the others; None where all stand still
    by_cosine   what materials are by the cosine from which they are seen; None where none depends on that alone
    emitters    the patches that emit: the last ones of `lights`, made of the last ones of the triangles that stand still
    attributes  {key: `Attribute`}: what textures are looked up at
    light_groups  {name: (lights + 1,) bool}: which lights belong to each group; the last stands for `film.BACKGROUND`
    glow        what textured emitters shine with, see `texturing`
    camera      the `CameraSpace`
    background  (3, 1) [W m^-2 sr^-1]
    media       what is inside of bodies; None where nobody asks
    passing     what passes surfaces straight on; None where nobody asks
    sights      what rays of each kind see; None where all see everything
    holdouts    what the camera sees as clear; None where there is nothing
    lost        counts rays that met nothing though Embree says so, see `measured`
    """

    frame: Frame
    accel: Accel | MeasuredAccel
    movers: object
    triangles: Triangles
    materials: Materials
    by_cosine: ByCosine | None
    lights: Lights
    emitters: Emitters
    background: np.ndarray
    media: Media | None
    passing: Passing | None
    sights: Sights | None
    holdouts: Holdouts | None
    attributes: dict
    light_groups: dict
    glow: object
    camera: CameraSpace
    lost: Lost
    warnings: tuple

    def seen_from(self, camera):
        """The same world with another camera, in the same render space."""
        space = CameraSpace.of(camera, self.frame)
        return replace(self, camera=space, glow=self.glow.seen_from(space), lights=self.lights.seen_from(space))


# Corners may be anything; what is not finite after all is found by `_measure` and told.
@np.errstate(over="ignore", invalid="ignore")
def compile_world(
    scene,
    bsdfs,
    smooth,
    has_choice,
    samples_lights=True,
    has_media=False,
    has_environment=False,
    motion_steps=0,
    passing_of=None,
    disperses=False,
    has_sights=False,
    has_holdouts=False,
    before=None,
    asked=(),
    real=np.float32,
):
    """`scene` (validated) as a `CompiledWorld`.

    `bsdfs` are the lobes to make room for, `smooth` says that shading normals are wanted, `has_choice` that there may be more than one
    light, `samples_lights` that shadow rays look for them, `has_media` that it matters what is inside of bodies, `has_environment` that
    the world has a picture that gives light, `disperses` that indices depend on the wavelength, `has_sights` that something is hidden
    from some rays, `has_holdouts` that something is held out, and `passing_of` (None: nothing passes) makes the `Passing` of the
    materials. Deforming meshes take `motion_steps` shapes, and without any all is as at the middle of the shutter. `before`, a world of
    the scene as it was, lends the origin of its render space, which is else the camera, and its tree if no triangle is another. `asked`
    are what all meshes and objects have to bring, keys as in `attributes`; `real` is the dtype of rays. Raises MemoryShortage, a
    SceneError, where the geometry does not fit into memory.
    """
    require_room(scene, motion_steps, real)
    materials, row = _number_materials(scene)
    bodies = Bodies.of(scene.objects) if has_media else None
    # What is no body may lie in one, too.
    around = {row[m] for m in materials if has_media and bodies.layer.any() and asks_for_around(m)}
    by_cosine, table = tabulated(Materials.of(materials, bsdfs, () if disperses else ("spread",), real), around)
    still = place([(i, o) for i, o in enumerate(scene.objects) if o.is_still or not motion_steps], row, smooth)
    changing = [(i, o) for i, o in enumerate(scene.objects) if motion_steps and o.mesh.triangles.size and not o.is_still]
    moving = [Moving.of(i, o, row, smooth, motion_steps) for i, o in changing]
    parts = [*still, *(part for m in moving for part in m.parts)]
    if (count := _starts(parts)[-1]) >= 2**31:
        raise SceneError(f"scene '{scene.name}': its objects have {count} vertices, allowed: less than 2^31; leave objects out")
    frame, vertices, indices, radius = _merge(still, moving, before.frame.origin if before else scene.camera.position)
    material = _concatenate([part.material for part in parts], 0, np.intp)
    owner = _concatenate([part.owner for part in parts], 0, np.int32)
    if has_media:
        away = np.zeros(len(scene.objects))
        away[[i for i, _ in changing]] = [frame.scale * m.away(frame.origin) for m in moving]
        vertices = moved_apart(vertices, indices, owner, bodies.layer.take(owner), away)
    shape, extent, usable, has_area = _measure(vertices, indices, real)
    warnings = [torn(scene.objects[i]) for i in np.unique(owner[~usable])]
    # Emitters come last, but for what moves.
    rank = table.emission.any(axis=0)[material].astype(np.int8)
    faces = sum(part.owner.size for part in still)
    rank[faces:] = _MOVES
    glows = [colours.take(material[faces:], axis=1) for colours in (table.emission, table.shine)]
    glowing = np.where(usable[faces:], vertices.take(indices[:, faces:], axis=1), 0) if glows[0].any() else None
    # A triangle without an area is never hit: leaving it out changes no picture.
    keep = np.nonzero(has_area)[0]
    keep = keep[np.argsort(rank[keep], kind="stable")]
    rank = rank[keep]
    if keep.size < owner.size or (np.diff(keep) != 1).any():
        shape, extent, indices = (values.take(keep, axis=-1) for values in (shape, extent, indices))
        material, owner = material.take(keep), owner.take(keep)
    first_emitter, first_moving = np.count_nonzero(rank < 1), np.count_nonzero(rank < _MOVES)
    try:
        at_rest = vertices, indices[:, :first_moving]
        embree = before.accel.embree if before and before.accel.embree.is_of(*at_rest) else Accel(*at_rest)
        lost_rays = Lost()
        measured = _measuring(shape, extent, lost_rays)
        accel = measured(embree, slice(first_moving))
        movers = _movers(moving, parts, frame, vertices, indices, keep, measured) if moving else None
        whole = Sight(accel, None, movers)
        sights = Sights.of(scene, owner[:first_moving], at_rest, whole, [i for i, _ in changing], measured) if has_sights else None
    except (AccelError, MemoryShortage) as error:
        raise SceneError(f"scene '{scene.name}': {error}") from error
    column, corner_normals = _smooth(parts, keep, shape[9:]) if smooth else (np.zeros(0, np.intp), np.zeros((9, 0), np.float32))
    runs = np.nonzero(np.diff(owner, prepend=-1))[0]
    triangles = Triangles(
        shape=shape,
        extent=extent,
        smooth=column,
        corner_normals=corner_normals,
        material=material,
        first_emitter=first_emitter,
        first_moving=first_moving,
        runs=runs,
        run_object=owner.take(runs),
    )
    last = slice(triangles.first_emitter, triangles.first_moving)
    emitters = Emitters.of(
        vertices,
        indices[:, last],
        shape[9:, last],
        table.emission.take(material[last], axis=1),
        owner[last],
        np.isin(material[last], list(table.glowing)),
        np.arange(last.start, last.stop) if table.glowing else None,
    )
    if glowing is not None:
        kept = keep[triangles.first_moving :] - faces
        emitters = emitters.followed_by(MovingLamps.of(movers, moving, glowing, *glows, kept, bool(table.glowing)))
    # Asked for with every feature there is, it may still be missing or black.
    environment = environment_of(scene.world) if has_environment and scene.world.may_vary else None
    passing = passing_of(materials) if passing_of else None
    attributes, lost = compile_attributes(
        parts, keep, material, table.wanted | dict.fromkeys(asked, range(len(materials))), scene.objects, owner
    )
    camera = CameraSpace.of(scene.camera, frame)
    glow = TexturedGlow(table.glowing, triangles, attributes, frame, camera) if table.glowing else EVEN
    lights = Lights.of(scene.lights, environment, emitters, frame, radius, has_choice, samples_lights, glow, camera, real)
    seems_dark = "its texture was black, below 0 or no number wherever looked at, so it seems to be dark"
    dark = (SceneWarning(seems_dark, "light", name) for name in lights.dark)
    return CompiledWorld(
        frame=frame,
        accel=accel,
        movers=movers,
        triangles=triangles,
        materials=table,
        by_cosine=by_cosine,
        lights=lights,
        emitters=emitters,
        background=np.array((0.0, 0.0, 0.0) if environment else scene.world.radiance, real)[:, None],
        media=Media.of(bodies, row, material, owner, frame.scale) if has_media else None,
        passing=passing,
        sights=sights and sights.of_lights(scene, lights, emitters.objects),
        holdouts=Holdouts.of(materials) if has_holdouts else None,
        attributes=attributes,
        light_groups=_light_groups(scene, lights, emitters),
        glow=glow,
        camera=camera,
        lost=lost_rays,
        warnings=(*warnings, *lost, *dark),
    )


def _light_groups(scene, lights, emitters):
    """{name: (lights + 1,) bool}, see `CompiledWorld`."""
    around = [scene.world.group]
    if not any((*lights.lamp_groups, *around, *(o.group for o in scene.objects))):
        return {}
    names = np.array([*lights.lamp_groups, *(around if lights.environment else ()), *(o.group for o in scene.objects), *around])
    # As the film is told of lights: lamps and environment, patches by whose they are, what is the same everywhere.
    first = lights.first_patch
    place = np.concatenate((np.arange(first), first + emitters.objects, [names.size - 1])).astype(np.intp)
    return {name: (names == name).take(place) for name in {*names.tolist()} - {""}}


def _number_materials(scene):
    """The different materials of `scene`, black where an object has none, and the number of each; None is black."""
    materials = [*dict.fromkeys(m for o in scene.objects for m in o.materials)]
    if not all(o.materials for o in scene.objects) or not materials:
        materials.append(Material(name="none"))
    return materials, {material: i for i, material in enumerate(materials)} | {None: len(materials) - 1}


def _merge(still, moving, origin):
    """Render space; the vertices (3, V) float32 and triangles (3, F) of all parts, each in its frame; the scene's radius [m]."""
    world = _concatenate([part.vertices for part in still], (3, 0), np.float64)
    away = _concatenate([world, *(m.world for m in moving)], (3, 0), np.float64) - origin[:, None]
    frame = Frame.around(origin, length(away))
    reach = np.abs(away, out=away).max(axis=0)
    radius = float(reach[reach * frame.scale < FARTHEST].max(initial=0)) or 1.0
    del away
    parts = [*still, *(part for m in moving for part in m.parts)]
    # Rounded once; from here on the rounded values are the geometry, for Embree and for everything else.
    local = [frame.scale * part.vertices for m in moving for part in m.parts]
    vertices = _concatenate([values.astype(np.float32) for values in (frame.points(world), *local)], (3, 0), np.float32)
    indices = _joined([part.triangles for part in parts], _starts(parts))
    return frame, vertices, indices, radius


def _starts(parts):
    """Where the vertices of each of `parts` begin, and where those of the last one end."""
    return np.cumsum([0] + [part.vertices.shape[1] for part in parts])


def _measuring(shape, extent, lost):
    """What makes a tree (embree, part) for rays of the precision of `shape`: `embree` is the `Accel` of a `part` of the triangles."""
    if shape.dtype == np.float32:
        return lambda embree, part: embree
    return lambda embree, part: MeasuredAccel(embree, shape[:, part], extent[part], lost)


def _movers(moving, parts, frame, vertices, indices, keep, measured):
    """The `Movers`: their parts are the last of `parts`, their triangles the last of `indices` (3, F), which were `keep` (F,)."""
    count = sum(len(m.parts) for m in moving)
    faces = np.searchsorted(np.sort(keep), np.cumsum([0] + [part.owner.size for part in parts]))
    corners = _starts(parts)
    own = range(len(parts) - count, len(parts))
    return Movers.of(
        moving,
        frame,
        [np.ascontiguousarray(vertices[:, corners[i] : corners[i + 1]]) for i in own],
        [indices[:, faces[i] : faces[i + 1]] - corners[i] for i in own],
        int(faces[own[0]]),
        measured,
    )


def _measure(vertices, indices, real):
    """`Triangles.shape` and `.extent` of the dtype `real`, which triangles are usable, and which of these have an area, (F,) bool each."""
    count = indices.shape[1]
    shape, extent = np.empty((12, count), real), np.empty(count, real)
    usable, has_area = np.empty(count, bool), np.empty(count, bool)
    for start in range(0, count, AT_ONCE):
        here = slice(start, start + AT_ONCE)
        corners = vertices.take(indices[:, here], axis=1)
        usable[here] = (np.abs(corners) < FARTHEST).all(axis=(0, 1))  # false for NaN
        exact = corners.astype(np.float64)
        normal = cross(exact[:, 1] - exact[:, 0], exact[:, 2] - exact[:, 0])
        double_area = length(normal)
        has_area[here] = usable[here] & (double_area > 0)
        # The same numbers in any precision.
        first, second, third = corners.astype(real, copy=False).transpose(1, 0, 2)
        normal /= np.maximum(double_area, np.finfo(np.float64).tiny)
        shape[:, here] = np.concatenate((first, second - first, third - first, normal), dtype=real, casting="same_kind")
        extent[here] = np.abs(shape[3:9, here]).max(axis=0)
    return shape, extent, usable, has_area


def _smooth(parts, keep, flat):
    """`Triangles.smooth` and `.corner_normals`; corners whose normal has no direction take the geometric one."""
    normals = _concatenate([part.normals for part in parts], (3, 0), np.float32)
    indices = _joined([part.normal_indices for part in parts], np.cumsum([0] + [part.normals.shape[1] for part in parts]))
    is_smooth = _concatenate([np.full(part.owner.size, part.normal_indices.shape[1] > 0) for part in parts], 0, bool)
    column = np.cumsum(is_smooth, dtype=np.intp)
    column -= 1
    column[~is_smooth] = -1
    column = column.take(keep)
    kept = np.nonzero(column >= 0)[0]
    result = np.empty((9, kept.size), np.float32)
    for start in range(0, kept.size, AT_ONCE):
        here = kept[start : start + AT_ONCE]
        normal = flat.take(here, axis=1)
        corners = normals.take(indices.take(column[here], axis=1), axis=1).transpose(1, 0, 2)
        for corner in corners:
            cos = dot(corner, normal)
            # Not NaN, not zero, and on the side of the geometric normal, whose sign decides for both.
            corner *= np.copysign(1, cos).astype(np.float32)
            lacking = ~(np.abs(cos) > 0)
            corner[:, lacking] = normal[:, lacking]
        corners[1:] -= corners[0]
        result[:, start : start + AT_ONCE] = corners.reshape(9, -1)
    column[kept] = np.arange(kept.size)
    return column, result


def _joined(indices, starts):
    """Indices (3, F) of several parts as one; each begins at its own of `starts`, which end with how many there are of what they count."""
    dtype = np.int32 if starts[-1] < 2**31 else np.int64
    return _concatenate([values + dtype(start) if start else values for values, start in zip(indices, starts)], (3, 0), dtype)


def _concatenate(arrays, empty, dtype):
    """The arrays along their last axis as one of `dtype`, `empty` being the shape of none; one alone is not copied."""
    if len(arrays) == 1:
        return arrays[0].astype(dtype, copy=False)
    return np.concatenate(arrays, axis=-1, dtype=dtype) if arrays else np.zeros(empty, dtype)
