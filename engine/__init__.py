"""Glanz: a wavefront ray tracer in NumPy over Embree. It needs no Blender.

Build a `Scene` from arrays, ask `Requirements.of` what it needs, iterate `render` for tiles as they finish or call
`render_image` for the whole picture, and write it with `write_exr`.
"""

from . import bsdfs, cameras, filters, integrators, lights, passes, samplers, textures  # noqa: F401 - fills the registries
from .bsdfs.blinn_phong import BlinnPhong
from .bsdfs.dielectric import Dielectric
from .bsdfs.gloss import Gloss
from .bsdfs.lambert import Lambert
from .bsdfs.lambert_transmission import LambertTransmission
from .bsdfs.mirror import Mirror
from .bsdfs.oren_nayar import OrenNayar
from .bsdfs.phong import Phong
from .bsdfs.phong_lecture import PhongLecture
from .bsdfs.phong_transmission import PhongTransmission
from .bsdfs.rough_refraction import RoughRefraction
from .bsdfs.transparent import Transparent
from .cameras.orthographic import OrthographicCamera
from .cameras.panorama import PanoramaCamera
from .cameras.perspective import PerspectiveCamera
from .constants import VERSION
from .errors import FileError, GlanzError, MemoryShortage, SceneError, SceneWarning
from .interfaces import albedo_of
from .io.checkpoint import Checkpoint
from .io.exr import write_exr
from .io.ies import parse_ies
from .io.scene_file import read_scene, write_scene
from .libraries import library_faults
from .lights.area import AreaLight
from .lights.cosine_spot import CosineSpotLight
from .lights.point import PointLight
from .lights.spot import SpotLight
from .lights.sun import SunLight
from .memory import require as require_memory
from .registry import FILTERS, INTEGRATORS, PASSES, SAMPLERS, TEXTURES
from .rendering import Image, Progress, Tile, gathered, metadata, prepare, render, render_image, render_plan
from .requirements import Requirements
from .saved import NO_CHECKPOINT
from .scene import (
    Bitmap,
    Coordinates,
    EnvironmentMap,
    Lens,
    Material,
    Medium,
    Mesh,
    MeshAttribute,
    Mist,
    Object,
    Scene,
    Settings,
    Shade,
    World,
)
from .scene.graphs import is_texture
from .scene.points import average_of
from .scene.textured import folded, textures_of
from .scene.validate import validate
from .scene.visibility import RAY_KINDS
from .textures.arithmetic import Math
from .textures.attribute import Attribute
from .textures.average import Average
from .textures.blackbody import Blackbody
from .textures.brick import BrickTexture
from .textures.brightness_contrast import BrightnessContrast
from .textures.bump_map import BumpMap
from .textures.camera_data import CameraData
from .textures.checker import CheckerTexture
from .textures.clamp import Clamp
from .textures.colour_ramp import ColourRamp
from .textures.combine import Combine
from .textures.curves import Curves
from .textures.environment import EnvironmentTexture
from .textures.fresnel import Fresnel
from .textures.gabor import GaborTexture
from .textures.gamma import Gamma
from .textures.geometry import Geometry
from .textures.ggx_albedo import GgxAlbedo
from .textures.glass_tint import GlassTint
from .textures.gradient import GradientTexture
from .textures.hue_saturation import HueSaturation
from .textures.ies import IesTexture
from .textures.image import ImageTexture
from .textures.invert import Invert
from .textures.layer_weight import LayerWeight
from .textures.light_falloff import LightFalloff
from .textures.light_path import LightPath
from .textures.linear import LinearTexture
from .textures.lobe_exponent import LobeExponent
from .textures.luminance import Luminance
from .textures.magic import MagicTexture
from .textures.map_range import MapRange
from .textures.mapping import Mapping
from .textures.mix import Mix
from .textures.mix_colour import MixColour
from .textures.noise import NoiseTexture
from .textures.normal_dot import NormalDot
from .textures.normal_map import NormalMap
from .textures.object_value import ObjectValue
from .textures.radial_tiling import RadialTiling
from .textures.relative_index import RelativeIndex
from .textures.separate import Separate
from .textures.sheen_albedo import SheenAlbedo
from .textures.sky import SkyTexture
from .textures.tangent import Tangent
from .textures.vector_arithmetic import VectorMath
from .textures.vector_rotate import VectorRotate
from .textures.vector_transform import VectorTransform
from .textures.voronoi import VoronoiTexture
from .textures.wave import WaveTexture
from .textures.wavelength import Wavelength
from .textures.white_noise import WhiteNoiseTexture
from .textures.wireframe import Wireframe

__version__ = VERSION

__all__ = [
    "FILTERS",
    "INTEGRATORS",
    "NO_CHECKPOINT",
    "PASSES",
    "RAY_KINDS",
    "SAMPLERS",
    "TEXTURES",
    "AreaLight",
    "Attribute",
    "Average",
    "Bitmap",
    "Blackbody",
    "BlinnPhong",
    "BrickTexture",
    "BrightnessContrast",
    "BumpMap",
    "CameraData",
    "CheckerTexture",
    "Checkpoint",
    "Clamp",
    "ColourRamp",
    "Combine",
    "Coordinates",
    "CosineSpotLight",
    "Curves",
    "Dielectric",
    "EnvironmentMap",
    "EnvironmentTexture",
    "FileError",
    "Fresnel",
    "GaborTexture",
    "Gamma",
    "Geometry",
    "GgxAlbedo",
    "GlanzError",
    "GlassTint",
    "Gloss",
    "GradientTexture",
    "HueSaturation",
    "IesTexture",
    "Image",
    "ImageTexture",
    "Invert",
    "Lambert",
    "LambertTransmission",
    "LayerWeight",
    "Lens",
    "LightFalloff",
    "LightPath",
    "LinearTexture",
    "LobeExponent",
    "Luminance",
    "MagicTexture",
    "MapRange",
    "Mapping",
    "Material",
    "Math",
    "Medium",
    "MemoryShortage",
    "Mesh",
    "MeshAttribute",
    "Mirror",
    "Mist",
    "Mix",
    "MixColour",
    "NoiseTexture",
    "NormalDot",
    "NormalMap",
    "Object",
    "ObjectValue",
    "OrenNayar",
    "OrthographicCamera",
    "PanoramaCamera",
    "PerspectiveCamera",
    "Phong",
    "PhongLecture",
    "PhongTransmission",
    "PointLight",
    "Progress",
    "RadialTiling",
    "RelativeIndex",
    "Requirements",
    "RoughRefraction",
    "Scene",
    "SceneError",
    "SceneWarning",
    "Separate",
    "Settings",
    "Shade",
    "SheenAlbedo",
    "SkyTexture",
    "SpotLight",
    "SunLight",
    "Tangent",
    "Tile",
    "Transparent",
    "VectorMath",
    "VectorRotate",
    "VectorTransform",
    "VoronoiTexture",
    "WaveTexture",
    "Wavelength",
    "WhiteNoiseTexture",
    "Wireframe",
    "World",
    "albedo_of",
    "average_of",
    "folded",
    "gathered",
    "is_texture",
    "library_faults",
    "metadata",
    "parse_ies",
    "prepare",
    "read_scene",
    "render",
    "render_image",
    "render_plan",
    "require_memory",
    "textures_of",
    "validate",
    "write_exr",
    "write_scene",
]
