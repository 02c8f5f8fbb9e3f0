"""Inputs that nodes have to bear: numbers of either sign and of many sizes, whole ones, 0 and equal ones, texel by texel.

Nodes that compute are compared with Cycles on them as they are in `cases` on smooth ones.
"""

import bpy
import numpy as np

from glanz.tests.parity.nodes import cases, grid

KINDS = (
    "Math VectorMath Mix MixRGB MapRange Mapping VectorRotate Clamp CombineXYZ SeparateXYZ CombineColor SeparateColor "
    "CombineRGB SeparateRGB CombineHSV SeparateHSV HueSaturation BrightContrast Gamma Invert RGBToBW Blackbody Wavelength "
    "RGBCurve FloatCurve VectorCurve ValToRGB"
)
SCALED = {"ShaderNodeBlackbody": 4000.0, "ShaderNodeWavelength": 400.0}
"""What inputs are times, where numbers about 1 say nothing."""


def anything(rng, shape):
    """Random numbers of all kinds."""
    kinds = (
        rng.uniform(-2, 2, shape),
        rng.uniform(0, 1, shape),
        np.zeros(shape),
        rng.integers(-4, 5, shape) / 2,
        rng.normal(size=shape) * 10.0 ** rng.integers(-6, 7, shape),
    )
    return np.choose(rng.choice(5, shape, p=(0.3, 0.4, 0.08, 0.12, 0.1)), kinds)


def build(tree, case):
    """The output of the node of a case in `tree`, every input fed with numbers of its own."""
    node = tree.nodes.new(case.kind)
    rng = np.random.default_rng([case.seed, len(case.kind), *case.mode.encode()])
    inner = {name: value for name, value in case.properties.items() if "." in name}
    cases.set_mode(node, {name: value for name, value in case.properties.items() if name not in inner})
    cases.shape(node, rng)
    for name, value in inner.items():
        part, _, attribute = name.partition(".")
        setattr(getattr(node, part), attribute, value)
    if "mapping.extend" in inner:
        _bend(node, rng)
    for i, socket in enumerate(s for s in node.inputs if s.enabled and not s.is_unavailable):
        feed(tree, socket, picture(10 * case.seed + i, SCALED.get(case.kind, 1.0)))
    return next(s for s in node.outputs if s.identifier == case.output)


def _bend(node, rng):
    """Curves that end where others do not."""
    for curve in node.mapping.curves:
        curve.points[0].location = rng.uniform(-0.3, 0.1, 2)
        curve.points[-1].location = rng.uniform(0.85, 1.3, 2)
        curve.points[1].handle_type = ("AUTO", "VECTOR", "AUTO_CLAMPED")[rng.integers(3)]
    node.mapping.update()


def feed(tree, socket, image):
    """The texels of an image, one for each pixel, into an input: three numbers, or the first of them."""
    texture, coordinates, mapping = (tree.nodes.new(f"ShaderNode{kind}") for kind in ("TexImage", "TexCoord", "Mapping"))
    texture.image, texture.interpolation = image, "Closest"
    mapping.inputs["Location"].default_value, mapping.inputs["Scale"].default_value = (0.5, 0.5, 0), (0.5, 0.5, 0)
    tree.links.new(coordinates.outputs["Object"], mapping.inputs[0])
    tree.links.new(mapping.outputs[0], texture.inputs[0])
    found = texture.outputs[0]
    if socket.type not in ("VECTOR", "RGBA"):
        split = tree.nodes.new("ShaderNodeSeparateXYZ")
        tree.links.new(found, split.inputs[0])
        found = split.outputs[0]
    tree.links.new(found, socket)


def picture(seed, scale):
    """An image of `anything`, the same for the same seed."""
    name = f"Anything {seed} {scale}"
    if name not in bpy.data.images:
        image = bpy.data.images.new(name, grid.SIDE, grid.SIDE, float_buffer=True)
        image.colorspace_settings.name = "Non-Color"
        texels = np.ones((grid.SIDE, grid.SIDE, 4), np.float32)
        texels[..., :3] = scale * anything(np.random.default_rng(seed), (grid.SIDE, grid.SIDE, 3))
        image.pixels.foreach_set(texels.ravel())
        image.update()
        image.pack()
    return bpy.data.images[name]


def known():
    """The node types of this version of Blender."""
    return cases.kinds()


def inner_modes():
    """{name: cases}: the modes of the ramps and curves that nodes hold."""
    hues = bpy.types.ColorRamp.bl_rna.properties["hue_interpolation"].enum_items.keys()
    kinds = bpy.types.ColorRamp.bl_rna.properties["interpolation"].enum_items.keys()
    ramps = [{"interpolation": kind} for kind in kinds]
    ramps += [{"color_mode": mode, "hue_interpolation": hue} for mode in ("HSV", "HSL") for hue in hues]
    ramps += [{"color_mode": "HSV", "interpolation": "CONSTANT"}]
    curves = [{"extend": extend, "use_clip": is_cut} for extend in ("EXTRAPOLATED", "HORIZONTAL") for is_cut in (False, True)]
    found = {"ramps": _cases("ValToRGB", "Color", "color_ramp", ramps) + _cases("ValToRGB", "Alpha", "color_ramp", ramps)}
    for kind, output in (("RGBCurve", "Color"), ("VectorCurve", "Vector"), ("FloatCurve", "Value")):
        found[kind] = _cases(kind, output, "mapping", curves)
    return found


def _cases(kind, output, part, modes):
    inner = [{f"{part}.{name}": value for name, value in mode.items()} for mode in modes]
    return [cases.Case(f"ShaderNode{kind}", output, seed, mode) for mode in inner for seed in cases.SEEDS]
