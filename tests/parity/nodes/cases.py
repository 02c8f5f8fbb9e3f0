"""Every shader node that Blender offers, in every mode, with random inputs: what is compared with Cycles.

Node types and their modes are asked of Blender, so that none is forgotten; what is not compared is listed with its reason.
"""

import itertools
import warnings
from dataclasses import dataclass, field

import bpy
import numpy as np

from glanz.tests.addon import blender

SEEDS = (1, 2)
CLOSURES = {
    "ShaderNodeBsdfPrincipled": "a shader: see closures.md",
    "ShaderNodeBsdfDiffuse": "a shader: see closures.md",
    "ShaderNodeBsdfGlossy": "a shader: see closures.md",
    "ShaderNodeBsdfGlass": "a shader: see closures.md",
    "ShaderNodeBsdfRefraction": "a shader: see closures.md",
    "ShaderNodeBsdfMetallic": "a shader: see closures.md",
    "ShaderNodeBsdfTransparent": "a shader: exact",
    "ShaderNodeBsdfTranslucent": "a shader: exact",
    "ShaderNodeEmission": "a shader: exact",
    "ShaderNodeMixShader": "a shader: exact",
    "ShaderNodeAddShader": "a shader: exact, up to all light that arrives",
}
"""Shaders, which are compared as such."""
ELSEWHERE = {
    "ShaderNodeGroup": "groups are followed; tested by the export's tests",
    "ShaderNodeCustomGroup": "groups are followed",
    "ShaderNodeOutputMaterial": "an output",
    "ShaderNodeOutputWorld": "an output",
    "ShaderNodeOutputLight": "an output",
    "ShaderNodeOutputLineStyle": "an output",
    "ShaderNodeOutputAOV": "an output; of materials, compared as a pass",
    "ShaderNodeScript": "Open Shading Language is not read: it would run code of the file",
    "ShaderNodeTexPointDensity": "needs particles as voxels; gone in Blender 5",
    "ShaderNodeTexIES": "of lights, where it is as in Cycles: LM-63 of types A, B and C; a file that cannot be read is named, and even",
    "ShaderNodeLightFalloff": "of lights, where it is as in Cycles 5: suns have no falloff",
    "ShaderNodeTexSky": "of worlds; compared as such",
    "ShaderNodeTexEnvironment": "of worlds; compared as such",
    "ShaderNodeTexImage": "needs pictures; compared on its own: 98 % or more, in the colour spaces Filmic and AgX before Blender 5.2 93 %, "
    "where Cycles cuts codes off to half precision",
    "ShaderNodeUVAlongStroke": "of line styles",
    "ShaderNodeSqueeze": "gone since Blender 2.8",
    "ShaderNodeDisplacement": "of displacement outputs; compared as reliefs",
    "ShaderNodeVectorDisplacement": "of displacement outputs; compared as reliefs",
    "ShaderNodeVolumeInfo": "inside of volumes",
    "ShaderNodePointInfo": "of point clouds, which Glanz does not render",
    "ShaderNodeHairInfo": "of hair, which Glanz does not render",
    "ShaderNodeCameraData": "differs by the ray, not by the plane; tested by the inputs' tests",
    "ShaderNodeRaycast": "traces rays of its own; is not read, as a warning says",
    "ShaderNodeAmbientOcclusion": "traces rays of its own; is 1 everywhere, as a warning says",
    "ShaderNodeBevel": "traces rays of its own; is the normal without a bevel, as a warning says",
}
"""Nodes that are not compared as emission on a plane."""

# Where Blender's soft range is none, or so wide that nothing can be seen.
RANGES = {
    "Scale": (1.0, 5.0),
    "Detail": (0.0, 3.5),
    "Lacunarity": (1.5, 3.0),
    "Roughness": (0.2, 0.9),
    "Offset": (0.2, 1.0),
    "Gain": (0.5, 2.0),
    "Distortion": (0.0, 1.5),
    "Exponent": (0.4, 3.0),
    "Temperature": (1000.0, 12000.0),
    "Wavelength": (380.0, 750.0),
    "Frequency": (0.7, 4.0),
    "IOR": (1.05, 2.5),
    "Randomness": (0.0, 1.0),
    "Smoothness": (0.05, 1.0),
    "Filter Width": (0.05, 1.0),
    "Sides": (2.2, 7.5),
}
COARSE = {
    "ShaderNodeTexBrick": {"Scale": (0.5, 1.5), "Brick Width": (0.2, 1.0), "Row Height": (0.2, 1.0)},
    "ShaderNodeTexVoronoi": {"Scale": (0.5, 1.5), "Detail": (0.0, 2.0)},
}
"""Patterns that jump: both engines look up points a two-thousandth of a square apart, which few edges must come between."""
BY_BITS = ("ShaderNodeTexWhiteNoise",)
"""What changes with the last bit is looked up at the same two points by both: those of a checker."""
PAIRS = {
    "ShaderNodeTexNoise": ("noise_dimensions", "noise_type"),
    "ShaderNodeTexVoronoi": ("voronoi_dimensions", "feature"),
    "ShaderNodeMapRange": ("data_type", "interpolation_type"),
    "ShaderNodeTexWave": ("wave_type", "wave_profile"),
    "ShaderNodeCombineColor": ("mode",),
    "ShaderNodeMix": ("data_type", "blend_type"),
}
"""Enums of which every pair of values is compared; of all others every value."""
FLAGS = ("use_clamp", "clamp", "clamp_factor", "clamp_result", "normalize", "invert")
"""Switches, each on and off."""
FIXED = {"ShaderNodeMix": {"factor_mode": ("UNIFORM", "NON_UNIFORM")}}


@dataclass(frozen=True)
class Case:
    """One output of a node in one mode, with inputs by a seed."""

    kind: str
    output: str
    seed: int
    properties: dict = field(hash=False)

    @property
    def mode(self):
        """The properties that are set, in words."""
        return ", ".join(f"{name} {value}" for name, value in self.properties.items())


def kinds():
    """The names of all node types whose outputs are values."""
    found = []
    scratch = bpy.data.materials.new("Scratch")
    tree = blender.new_nodes(scratch)
    with warnings.catch_warnings(action="ignore"):
        names = [name for name in sorted(dir(bpy.types)) if name.startswith("ShaderNode") and name not in ELSEWHERE]
    for name in names:
        try:
            node = tree.nodes.new(name)
        except RuntimeError:
            # A base class, or one that this version keeps for files only.
            continue
        if node.outputs and all(socket.type != "SHADER" for socket in node.outputs):
            found.append(name)
    bpy.data.materials.remove(scratch)
    return found


def label(kind):
    """What Blender's menus call a node type, or None where this version has none."""
    cls = getattr(bpy.types, kind, None)
    return cls.bl_rna.name if cls else None


def cases(kind):
    """Every case of a node type."""
    scratch = bpy.data.materials.new("Scratch")
    node = blender.new_nodes(scratch).nodes.new(kind)
    found = []
    for properties in modes(node):
        set_mode(node, properties)
        found += [Case(kind, s.identifier, seed, properties) for s in node.outputs if s.enabled and not s.is_unavailable for seed in SEEDS]
    bpy.data.materials.remove(scratch)
    return found


def modes(node):
    """The combinations {property: value} in which a node is compared."""
    own = {p.identifier: p for p in node.bl_rna.properties if p.identifier not in bpy.types.ShaderNode.bl_rna.properties}
    choices = {n: p for n, p in own.items() if p.type == "ENUM" and not (p.is_readonly or p.is_enum_flag)}
    enums = {n: [e.identifier for e in p.enum_items] for n, p in choices.items()}
    flags = {n: (False, True) for n in FLAGS if n in own and own[n].type == "BOOLEAN"}
    pairs = [n for n in PAIRS.get(node.bl_idname, ()) if n in enums]
    found = [dict(zip(pairs, values)) for values in itertools.product(*(enums[n] for n in pairs))] if pairs else [{}]
    for name, values in {**enums, **flags}.items():
        if name not in pairs:
            found += [{name: value} for value in values if value != getattr(node, name)]
    # What the node refuses, or shows no output for, is no mode.
    return [properties for properties in found if set_mode(node, properties)]


def set_mode(node, properties):
    inherited = bpy.types.ShaderNode.bl_rna.properties
    for name, p in node.bl_rna.properties.items():
        if p.type in ("ENUM", "BOOLEAN") and name not in inherited and not p.is_readonly and not getattr(p, "is_array", False):
            try:
                setattr(node, name, p.default)
            except (TypeError, AttributeError):
                continue
    for name, value in properties.items():
        try:
            setattr(node, name, value)
        except TypeError:
            return False
    return True


def build(tree, case):
    """The output of the node of a case in `tree`, with its inputs: vectors vary over the plane, others do or are constants."""
    rng = np.random.default_rng([case.seed, len(case.kind), *case.mode.encode()])
    node = tree.nodes.new(case.kind)
    set_mode(node, case.properties)
    shape(node, rng)
    for i, socket in enumerate(s for s in node.inputs if s.enabled and not s.is_unavailable):
        if socket.type == "VECTOR" and socket.identifier in ("Normal", "Tangent"):
            continue
        is_even = (case.kind.startswith("ShaderNodeTex") and socket.identifier != "Lacunarity") or socket.identifier not in RANGES
        may_vary = socket.type in ("VALUE", "RGBA") and is_even
        low, high = (0.0, 1.0) if socket.type == "RGBA" else _range(socket, case.kind)
        if case.kind in BY_BITS:
            tree.links.new(_two(tree, rng, socket.type), socket)
        elif socket.type == "VECTOR" or (may_vary and (i + case.seed) % 2 == 0):
            tree.links.new(_places(tree, rng, socket.type, low, high), socket)
        elif socket.type in ("VALUE", "INT"):
            value = rng.uniform(low, high)
            socket.default_value = round(value) if socket.type == "INT" else value
        elif socket.type == "RGBA":
            socket.default_value = (*rng.random(3), 1.0)
        elif socket.type == "BOOLEAN":
            socket.default_value = bool(rng.integers(2))
    return next(s for s in node.outputs if s.identifier == case.output)


def _range(socket, kind):
    ranges = {**RANGES, **COARSE.get(kind, {})}
    if socket.identifier in ranges:
        return ranges[socket.identifier]
    if socket.type == "VECTOR":
        return (-1.5, 1.5)
    p = socket.bl_rna.properties.get("default_value")
    if p is None:
        # Shaders have none.
        return (0.0, 1.0)
    low, high = max(p.soft_min, -2.0), min(p.soft_max, 2.0)
    return (low, high) if low < high else (0.0, 1.0)


def _places(tree, rng, kind, low, high):
    """An affine map of the plane's own coordinates into [low, high], as far as a plane can."""
    coordinates, mapping = tree.nodes.new("ShaderNodeTexCoord"), tree.nodes.new("ShaderNodeMapping")
    half = 0.5 * (high - low)
    values = {
        "Location": np.full(3, 0.5 * (low + high)) + (rng.uniform(-0.2, 0.2, 3) * half if kind == "VECTOR" else 0),
        "Rotation": rng.uniform(-3, 3, 3),
        "Scale": half * rng.uniform(0.5, 0.8, 3) * (1 if kind == "VECTOR" else 1.0),
    }
    for name, value in values.items():
        next(s for s in mapping.inputs if s.identifier == name).default_value = value
    tree.links.new(next(s for s in coordinates.outputs if s.identifier == "Object"), mapping.inputs["Vector"])
    return mapping.outputs[0]


def _two(tree, rng, kind):
    """Two vectors, or 0 and 1, in turn."""
    colours = {name: (*rng.uniform(0, 9, 3), 1) for name in ("Color1", "Color2")}
    return blender.add_node(tree, "ShaderNodeTexChecker", **colours).outputs["Fac" if kind == "VALUE" else "Color"]


def shape(node, rng):
    """Curves and ramps that are not straight."""
    if hasattr(node, "color_ramp"):
        for place in (0.3, 0.62):
            node.color_ramp.elements.new(place)
        for element in node.color_ramp.elements:
            element.color = (*rng.random(3), rng.random())
    if hasattr(node, "mapping") and hasattr(node.mapping, "curves"):
        for curve in node.mapping.curves:
            curve.points.new(*rng.uniform(0.2, 0.8, 2))
        node.mapping.update()
    if node.bl_idname in ("ShaderNodeRGB", "ShaderNodeValue", "ShaderNodeNormal"):
        output = node.outputs[0]
        output.default_value = rng.random() if output.type == "VALUE" else rng.random(len(output.default_value))
