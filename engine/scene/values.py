"""The scene as values: frozen records of arrays, numbers and names, in metres and radiometric units.

World space is right-handed with z up, as Blender's. Nothing here knows how it will be rendered.
"""

import math
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from ..arrays import frozen
from ..errors import SceneError
from ..maths.normals import vertex_normals
from ..maths.poses import between
from .graphs import is_texture
from .medium import Medium
from .mist import Mist
from .motion import no_motion, settle
from .textured import attributes_of
from .visibility import hidden_from


def _array(owner, name, dtype, shape):
    try:
        value = frozen(getattr(owner, name), dtype, shape, f"{type(owner).__name__.lower()} '{owner.name}'", name)
    except ValueError as error:
        raise SceneError(str(error)) from None
    object.__setattr__(owner, name, value)


def _two_matrices(owner, name):
    _array(owner, name, np.float64, (None, 4, 4))
    count = len(getattr(owner, name))
    if count not in (0, 2):
        raise SceneError(f"{type(owner).__name__.lower()} '{owner.name}': {name} are {count} matrices, allowed: 2 or none")


def _check_indices(mesh, name, count):
    indices = getattr(mesh, name)
    if indices.size and not 0 <= indices.min() <= indices.max() < count:
        raise SceneError(f"mesh '{mesh.name}': {name} reach from {indices.min()} to {indices.max()}, allowed: 0 to {count - 1}")


@dataclass(frozen=True, kw_only=True, eq=False)
class MeshAttribute:
    """What a mesh has besides its shape, for textures to look up: it varies linearly over each triangle.

    values   (C, K): one number; two, of a plane; three, of a vector; four, a colour and its alpha
    indices  (3, F) which of them each corner of each triangle takes; none (3, 0): one for each vertex
    Raises SceneError for a shape that does not fit.
    """

    name: str
    values: np.ndarray
    indices: np.ndarray = field(default_factory=lambda: np.zeros((3, 0)))

    def __post_init__(self):
        _array(self, "values", np.float32, (None, None))
        _array(self, "indices", np.int32, (3, None))
        if not 1 <= len(self.values) <= 4:
            raise SceneError(f"mesh attribute '{self.name}': values have {len(self.values)} components, allowed: 1 to 4")


@dataclass(frozen=True, kw_only=True, eq=False)
class Mesh:
    """Triangles in object space; many objects may share one mesh.

    vertices          (3, V) float32 or float64 [m]
    triangles         (3, F) vertex indices, counter-clockwise seen from the front
    normals           (3, K) shading normals, unit; none (3, 0): the mesh is flat
    normal_indices    (3, F) which normal each corner of each triangle takes; none (3, 0): the mesh is flat
    material_indices  (F,) which of the object's materials each triangle wears; none (0,): the first
    uv_layers         the names of its L layers of texture coordinates; the first is the one meant where none is named
    uvs               (L, 2, K) of each layer
    uv_indices        (3, F) which of them each corner of each triangle takes, in all layers; none (3, 0) without layers
    generated         (3, V) texture coordinates of the vertices; none (3, 0): the bounding box as the unit cube
    attributes        `MeshAttribute` values
    shapes            (K, 3, V) the vertices at equally spaced times, the first and the last included, while the shutter is open;
                      none (0, 3, 0): the mesh keeps its shape. `vertices` are then set to the middle
    shape_normals     (K, 3, K_n) the normals at the same times; none (0, 3, 0): they stay
    beside            (2, 3, V) the vertices one frame before and one after, for passes; none (0, 3, 0): they are the same
    Raises SceneError where shapes or indices do not fit.
    """

    name: str
    vertices: np.ndarray
    triangles: np.ndarray
    normals: np.ndarray = field(default_factory=lambda: np.zeros((3, 0)))
    normal_indices: np.ndarray = field(default_factory=lambda: np.zeros((3, 0)))
    material_indices: np.ndarray = field(default_factory=lambda: np.zeros(0))
    uv_layers: tuple = ()
    uvs: np.ndarray = field(default_factory=lambda: np.zeros((0, 2, 0)))
    uv_indices: np.ndarray = field(default_factory=lambda: np.zeros((3, 0)))
    generated: np.ndarray = field(default_factory=lambda: np.zeros((3, 0)))
    attributes: tuple = ()
    shapes: np.ndarray = field(default_factory=lambda: np.zeros((0, 3, 0)))
    shape_normals: np.ndarray = field(default_factory=lambda: np.zeros((0, 3, 0)))
    beside: np.ndarray = field(default_factory=lambda: np.zeros((0, 3, 0)))

    def __post_init__(self):
        self._settle_shapes()
        is_double = getattr(self.vertices, "dtype", None) == np.float64
        _array(self, "vertices", np.float64 if is_double else np.float32, (3, None))
        _array(self, "triangles", np.int32, (3, None))
        _array(self, "normals", np.float32, (3, None))
        _array(self, "normal_indices", np.int32, (3, None))
        _array(self, "material_indices", np.int32, (None,))
        _array(self, "beside", np.float32, (None, 3, None))
        expected = (2, 3, self.vertices.shape[1])
        if self.beside.shape not in ((0, 3, 0), expected):
            raise SceneError(f"mesh '{self.name}': beside has shape {self.beside.shape}, expected {expected}, or none")
        object.__setattr__(self, "uv_layers", tuple(self.uv_layers))
        _array(self, "uvs", np.float32, (len(self.uv_layers), 2, None))
        _array(self, "uv_indices", np.int32, (3, None))
        _array(self, "generated", np.float32, (3, None))
        object.__setattr__(self, "attributes", tuple(self.attributes))
        _check_indices(self, "triangles", self.vertices.shape[1])
        _check_indices(self, "normal_indices", self.normals.shape[1])
        _check_indices(self, "uv_indices", self.uvs.shape[2])
        if self.generated.shape[1] not in (0, self.vertices.shape[1]):
            raise SceneError(f"mesh '{self.name}': generated must have one point for each of {self.vertices.shape[1]} vertices, or none")
        if self.uv_layers and self.uv_indices.shape[1] != self.triangles.shape[1]:
            raise SceneError(f"mesh '{self.name}': uv_indices must have one entry for each of {self.triangles.shape[1]} triangles")
        for name in ("normal_indices", "material_indices", "uv_indices"):
            if getattr(self, name).shape[-1] not in (0, self.triangles.shape[1]):
                raise SceneError(f"mesh '{self.name}': {name} must have one entry for each of {self.triangles.shape[1]} triangles, or none")
        for attribute in self.attributes:
            self._check_attribute(attribute)

    def _check_attribute(self, attribute):
        count, indices = attribute.values.shape[1], attribute.indices
        if indices.shape[1] not in (0, self.triangles.shape[1]) or (not indices.size and count != self.vertices.shape[1]):
            raise SceneError(
                f"mesh '{self.name}': attribute '{attribute.name}' must have indices for each of {self.triangles.shape[1]} triangles, "
                f"or one value for each of {self.vertices.shape[1]} vertices"
            )
        if indices.size and not 0 <= indices.min() <= indices.max() < count:
            raise SceneError(
                f"mesh '{self.name}': indices of attribute '{attribute.name}' reach from {indices.min()} to {indices.max()}, "
                f"allowed: 0 to {count - 1}"
            )

    def _settle_shapes(self):
        """Keys that are all the same are no deformation; else vertices and normals become those of the middle."""
        _array(self, "shape_normals", np.float32, (None, 3, None))
        is_double = getattr(self.shapes, "dtype", None) == np.float64
        _array(self, "shapes", np.float64 if is_double else np.float32, (None, 3, None))
        shapes, normals = self.shapes, self.shape_normals
        for name, keys, still in (("shapes", shapes, self.vertices), ("shape_normals", normals, self.normals)):
            if len(keys) and keys.shape[1:] != np.shape(still):
                raise SceneError(f"mesh '{self.name}': {name} have shape {keys.shape}, expected (any, 3, {np.shape(still)[-1]})")
        if len(normals) not in (0, len(shapes)):
            raise SceneError(f"mesh '{self.name}': {len(shapes)} shapes, but {len(normals)} shape_normals")
        if not len(shapes):
            return
        moves = bool((shapes != shapes[0]).any() or (len(normals) and (normals != normals[0]).any()))
        object.__setattr__(self, "vertices", between(shapes, 0.5).astype(shapes.dtype) if moves else shapes[0])
        if len(normals):
            object.__setattr__(self, "normals", between(normals, 0.5).astype(np.float32) if moves else normals[0])
        if not moves:
            object.__setattr__(self, "shapes", np.zeros((0, 3, 0), shapes.dtype))
            object.__setattr__(self, "shape_normals", np.zeros((0, 3, 0), np.float32))

    @property
    def deforms(self):
        """Whether its shape changes while the shutter is open."""
        return len(self.shapes) > 0

    def at(self, time):
        """The mesh as it is at `time` in [0, 1] of the shutter, without shapes."""
        if not self.deforms:
            return self
        normals = between(self.shape_normals, time) if len(self.shape_normals) else self.normals
        none = {"shapes": np.zeros((0, 3, 0)), "shape_normals": np.zeros((0, 3, 0))}
        return replace(self, vertices=between(self.shapes, time), normals=normals, **none)

    @property
    def is_smooth(self):
        """Whether the mesh brings shading normals of its own."""
        return self.normal_indices.shape[1] > 0

    def smoothed(self, angle=math.pi):
        """This mesh with shading normals made from its triangles: at each vertex the sum of theirs, weighted by area.

        Edges at which triangles meet at more than `angle` [rad] stay sharp: vertices on them have several normals.
        Raises SceneError for an angle that is not from 0 to pi.
        """
        if not 0 <= angle <= math.pi:
            raise SceneError(f"mesh '{self.name}': the angle of smoothing is {angle}, allowed: 0 to pi")
        normals, indices = vertex_normals(self.vertices, self.triangles, angle)
        return replace(self, normals=normals, normal_indices=indices, shape_normals=np.zeros((0, 3, 0)))


@dataclass(frozen=True, kw_only=True)
class Material:
    """What a surface does to light: the sum of its lobes, plus what it emits.

    lobes     BSDF values (`Lambert`, `Phong`, ...); none: black
    emission  radiance leaving both sides [W m^-2 sr^-1], linear Rec. 709
    alpha     the share of the surface that is there, in [0, 1]; where it is not, light goes straight on. It cuts out what the
              lobes make, not what is emitted. A texture beyond [0, 1] is cut off
    Emission, alpha, holdout and any parameter of a lobe may be a texture.
    holdout   the share of light, in [0, 1], for which the camera sees nothing there: black, and clear. No other ray knows of it, and alpha
              does not cut it out
    ambient   k_a of the lecture's illumination model, the share of each light that arrives everywhere; no other model knows it
    relief    textures that give normals in world space, such as `NormalMap` and `BumpMap`; each bends what the one before has left
    aovs      pairs (name, value) of what passes are to show of the surface: numbers, colours, textures
    index     a number of one's own, for the pass that tells materials apart
    medium    the `Medium` behind surfaces that let light pass; None: nothing is known of it, and nothing is absorbed
    """

    name: str
    lobes: tuple = ()
    emission: tuple = (0.0, 0.0, 0.0)
    ambient: tuple = (0.0, 0.0, 0.0)
    alpha: float = 1.0
    medium: Medium | None = None
    relief: tuple = ()
    index: float = 0.0
    aovs: tuple = ()
    holdout: tuple = (0.0, 0.0, 0.0)

    def __post_init__(self):
        object.__setattr__(self, "lobes", tuple(self.lobes))
        object.__setattr__(self, "relief", tuple(self.relief))
        object.__setattr__(self, "aovs", tuple(map(tuple, self.aovs)))
        for name in ("emission", "ambient", "holdout"):
            if not is_texture(getattr(self, name)):
                object.__setattr__(self, name, tuple(float(c) for c in getattr(self, name)))

    @cached_property
    def attributes(self):
        """What its textures are looked up at: a set of `Coordinates.attribute`."""
        return attributes_of(self)


@dataclass(frozen=True, kw_only=True, eq=False)
class Object:
    """A mesh placed in the world.

    world_from_object  (4, 4) affine, float64
    materials          one for each material index of the mesh; indices beyond the last take the last, none is black
    motion             (K, 4, 4) world_from_object at equally spaced times, the first and the last included, while the shutter is
                       open; none (0, 4, 4): it stands still. `world_from_object` is then set to the middle
    values             what textures can ask about it: pairs (name, four numbers), such as ("colour", (r, g, b, alpha)) and
                       ("random", (x, x, x, 1)); what is not among them is 0
    asset              the name of what it is a part of; empty: its own
    group              the light group that what it emits belongs to; empty: none
    hidden_from        the kinds of rays that do not see it, of `scene.visibility.RAY_KINDS`
    beside             (2, 4, 4) world_from_object one frame before and one after, for passes; none (0, 4, 4): it stands still
    Raises SceneError for values of another form.
    """

    name: str
    mesh: Mesh
    world_from_object: np.ndarray = field(default_factory=lambda: np.eye(4))
    materials: tuple = ()
    motion: np.ndarray = field(default_factory=no_motion)
    values: tuple = ()
    asset: str = ""
    group: str = ""
    hidden_from: tuple = ()
    beside: np.ndarray = field(default_factory=no_motion)

    def __post_init__(self):
        object.__setattr__(self, "hidden_from", hidden_from(self.hidden_from, f"object '{self.name}'"))
        settle(self, "object", "world_from_object")
        _array(self, "world_from_object", np.float64, (4, 4))
        object.__setattr__(self, "materials", tuple(self.materials))
        _two_matrices(self, "beside")
        try:
            object.__setattr__(self, "values", tuple((str(name), tuple(map(float, four))) for name, four in self.values))
        except (TypeError, ValueError):
            raise SceneError(f"object '{self.name}': values are not pairs of a name and four numbers") from None
        for name, four in self.values:
            if len(four) != 4:
                raise SceneError(f"object '{self.name}': value '{name}' is {four}, allowed: four numbers")

    @property
    def moves(self):
        """Whether it changes its place while the shutter is open."""
        return len(self.motion) > 0

    @property
    def is_still(self):
        """Whether nothing of it changes while the shutter is open."""
        return not (self.moves or self.mesh.deforms)


@dataclass(frozen=True, kw_only=True)
class World:
    """What surrounds the scene.

    radiance     from every direction [W m^-2 sr^-1], linear Rec. 709; or a texture, all of whose coordinates are the direction, unit
    environment  an `EnvironmentMap` that adds to a constant radiance, or None
    mist         a `Mist`, for the pass of that name
    group        the light group that it belongs to; empty: none
    occlusion_distance  how far away things may be that hide others from their surroundings, for ambient occlusion [m]
    hidden_from  the kinds of rays that do not see it, of `scene.visibility.RAY_KINDS`; it is black to them
    """

    name: str = "World"
    radiance: tuple = (0.0, 0.0, 0.0)
    environment: object = None
    mist: Mist = field(default_factory=Mist)
    group: str = ""
    occlusion_distance: float = 10.0
    hidden_from: tuple = ()

    def __post_init__(self):
        object.__setattr__(self, "hidden_from", hidden_from(self.hidden_from, f"world '{self.name}'"))
        if not is_texture(self.radiance):
            object.__setattr__(self, "radiance", tuple(float(c) for c in self.radiance))

    @property
    def may_vary(self):
        """Whether radiance differs by direction, so that it is worth looking for."""
        return is_texture(self.radiance) or (self.environment is not None and self.environment.gives_light)


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """Everything that a picture depends on, but for the `Settings`.

    camera   a camera value (`PerspectiveCamera`, `OrthographicCamera`, `PanoramaCamera`)
    objects  `Object` values
    lights   light values (`PointLight`, `SpotLight`, `CosineSpotLight`, `SunLight`, `AreaLight`)
    camera_beside  (2, 4, 4) where the camera is one frame before and one after, for passes; none (0, 4, 4): it stands still
    """

    camera: object
    objects: tuple = ()
    lights: tuple = ()
    world: World = World()
    name: str = "Scene"
    camera_beside: np.ndarray = field(default_factory=no_motion)

    def __post_init__(self):
        _two_matrices(self, "camera_beside")
        object.__setattr__(self, "objects", tuple(self.objects))
        object.__setattr__(self, "lights", tuple(self.lights))
