"""Examples of nodes that compute, and what they refuse, for the contract of textures."""

import numpy as np

from glanz.engine import (
    Blackbody,
    BrightnessContrast,
    Clamp,
    ColourRamp,
    Combine,
    Curves,
    Gamma,
    HueSaturation,
    Invert,
    LinearTexture,
    Mapping,
    MapRange,
    Math,
    Mix,
    MixColour,
    NoiseTexture,
    RadialTiling,
    Separate,
    VectorMath,
    VectorRotate,
    Wavelength,
)
from glanz.engine.maths.colour_models import FROM_RGB, TO_RGB
from glanz.engine.maths.ranges import PROGRESS
from glanz.engine.scene.coordinates import GENERATED

TABLE = np.random.default_rng(3).random((3, 33)).astype(np.float32)
# Those of which each is worked out in another way than all others.
_NUMBERS = (
    *("power", "logarithm", "exponent", "smooth min", "modulo", "wrap", "pingpong"),
    *("sine", "tangent", "arccosine", "arctan2", "sinh", "tanh"),
)
_TRIPLES = ("cross product", "project", "refract", "faceforward", "distance", "normalize", "wrap", "power")
_BLENDS = ("mix", "burn", "dodge", "soft light", "divide", "hue", "saturation", "value")
X, Y = Separate(GENERATED, 0), Separate(GENERATED, 1)
CONVERTERS = {
    "math": [Math(X, LinearTexture((Y,), (1.0,), 1.5), 0.3, operation) for operation in _NUMBERS],
    "vector math": [VectorMath(GENERATED, NoiseTexture(is_coloured=True), X, operation) for operation in _TRIPLES],
    "mix": [Mix(X, GENERATED, (0.3, 0.2, 2.0)), Mix(GENERATED, X, Y, is_clamped=False)],
    "mix colour": [MixColour(X, GENERATED, NoiseTexture(is_coloured=True), blend, clamps_result=True) for blend in _BLENDS],
    "colour ramp": [ColourRamp(X, TABLE), ColourRamp(X, TABLE[:1], is_smooth=False)],
    "curves": [Curves(GENERATED, 0.7, TABLE, -1.0, 2.0), Curves(X, Y, TABLE[:1], goes_on=False)],
    "gamma": [Gamma(GENERATED, X)],
    "invert": [Invert(GENERATED, X)],
    "brightness contrast": [BrightnessContrast(GENERATED, X, Y)],
    "hue saturation": [HueSaturation(GENERATED, X, 1.3, Y, 0.6)],
    "combine": [Combine(X, Y, 0.5, model) for model in TO_RGB],
    "separate": [Separate(GENERATED, component, model) for model in FROM_RGB for component in (0, 1, 2)],
    "clamp": [Clamp(X, Y, 0.5), Clamp(X, 0.5, Y, is_range=True)],
    "map range": [MapRange(X, 0.2, Y, 1.0, GENERATED, 3.0, interpolation) for interpolation in PROGRESS],
    "mapping": [Mapping(GENERATED, GENERATED, X, (1.0, 0.0, 2.0), kind) for kind in ("point", "texture", "vector", "normal")],
    "vector rotate": [VectorRotate(GENERATED, X, GENERATED, Y, is_euler=e, is_inverted=i) for e in (True, False) for i in (True, False)],
    "radial tiling": [
        *(RadialTiling(GENERATED, 3.7, 0.4, output) for output in ("coordinates", "number", "width", "rotation")),
        *(RadialTiling(GENERATED, sides, X, is_normalized=n) for sides in (2.0, 5.0, 4.6) for n in (False, True)),
    ],
    "blackbody": [Blackbody(LinearTexture((X,), (2000.0,), 2000.0))],
    "wavelength": [Wavelength(LinearTexture((X,), (100.0,), 500.0))],
}
REFUSED = [
    (Math(operation="join"), "join"),
    (VectorMath(operation="compare"), "compare"),
    (MixColour(blend="glue"), "glue"),
    (Combine(model="yuv"), "yuv"),
    (Separate(model="yuv"), "yuv"),
    (Separate(component=3), "3"),
    (MapRange(interpolation="cubic"), "cubic"),
    (Mapping(kind="plane"), "plane"),
    (RadialTiling(output="area"), "area"),
    (ColourRamp(table=np.zeros((2, 8), np.float32)), "table"),
    (ColourRamp(table=np.full((3, 8), np.nan, np.float32)), "finite"),
    (Curves(table=np.zeros((1, 1), np.float32)), "table"),
    (Curves(table=np.zeros((1, 4))), "float32"),
    (Curves(low=1.0), "upwards"),
]
"""(texture, a word of the complaint)."""


def grows_beyond_numbers(value):
    """Whether what a texture makes of finite numbers may be too large for one."""
    return value.key == "gamma" or getattr(value, "operation", "") in ("power", "exponent", "sinh")
