"""No length, time or cosine is compared with a number that somebody has typed: the engine's laws hold at every scale."""

import ast
import operator
from pathlib import Path

import pytest

ENGINE = Path(__file__).resolve().parents[2] / "engine"
SMALLEST = 1e-3
"""What is nearer than this to 0, or to 1, may be an epsilon."""
OPERATORS = {ast.Add: operator.add, ast.Sub: operator.sub, ast.Mult: operator.mul, ast.Div: operator.truediv, ast.Pow: operator.pow}
HALF_UNIT, WORD = 2.0**-24, 2.0**-32

REVIEWED = {
    # Random and hashed integers become numbers in [0, 1): no tolerance, a change of units.
    ("maths/hashing.py", HALF_UNIT): "24 bits of a hash",
    ("maths/cellhash.py", WORD): "32 bits of a hash",
    ("maths/cellhash.py", 2.0**-31): "31 bits of a hash, and a sign",
    ("maths/discrete.py", HALF_UNIT): "probabilities are multiples of what a random number can tell apart",
    ("filters/mitchell.py", 1 - HALF_UNIT): "the largest random number below 1",
    # Units of rounding, which are multiplied by the sizes at hand where they are used.
    ("constants.py", HALF_UNIT): "half a unit of float32; all that keeps rays off surfaces is a multiple of it and of coordinates",
    ("constants.py", 1 - HALF_UNIT): "the largest random number below 1",
    ("wavefront/views.py", 2.0**-14): "times a triangle's extent",
    ("world/lamp_search.py", 2.0**-20): "times the distance, and 2^10 times that of the radius",
    ("world/sky.py", 2.0**-20): "times the largest float32: so many weights can be added up",
    ("maths/normals.py", "eps"): "times the area of a corner's triangles",
    ("maths/poses.py", "eps"): "times the largest scale of an object",
    # Shares of the whole, and of what weights are: nothing that has a unit.
    ("maths/discrete.py", 2.0**-22): "the least probability of what weighs something",
    ("world/light_choice.py", 2.0**-10): "of the strongest light's weight",
    ("world/light_tree.py", 2.0**-30): "of the strongest light's power",
    ("world/lights.py", 2.0**-10): "of the light of a lamp that a texture darkens",
    ("world/materials.py", 2.0**-10): "radiance by which a texture is chosen that was black where it was looked at",
    ("world/by_cosine.py", 2.0**-10): "of the value in a table",
    ("world/environment.py", 2.0**-80): "sr^-1: a density between texels that nothing has",
    ("scene/validate.py", 1 + 1e-6): "how far the sum of reflectances given as float32 may exceed 1",
    # Of directions, which are unit at every scale, of angles, and of pure numbers.
    ("bsdfs/blinn_phong.py", "eps"): "of |wo + wi|, both unit: less has no direction",
    ("world/sky.py", 2.0**-10): "of a unit vector, and of the entries of a rotation",
    ("maths/facing.py", 2.0**-17): "of an index of refraction, as in Cycles",
    ("maths/arithmetic.py", "eps"): "Blender's Math > Compare, of two numbers of the user's",
    ("maths/skydome.py", "eps"): "of the dome, whose radius is 1",
    ("io/ies.py", 2.0**-13): "degrees",
    ("textures/ies.py", 2.0**-13): "degrees",
    ("wavefront/media.py", 0.9994): "part of a direction that people align nothing with",
    ("switching.py", 0.0005): "seconds that a thread waits for another",
    # Published formulas.
    ("maths/atmosphere.py", 2e6 / 1.3681e20): "km^-1 and molecules of ozone",
    ("maths/atmosphere.py", 0.1 / 1000): "km of a height over the ground of the Earth",
    ("maths/daylight.py", 0.8 / 1000): "a coefficient of Preetham's",
    ("maths/daylight.py", -0.4 / 1000): "a coefficient of Preetham's",
    ("textures/checker.py", 1e-6): "Blender's own shift of its checker, in units of its cubes",
    ("textures/checker.py", 0.999999): "the same, as a factor",
    ("textures/wave.py", 1e-6): "Blender's own shift of its waves, in units of them",
    ("textures/wave.py", 0.999999): "the same, as a factor",
    ("textures/gradient.py", 0.999999): "Blender's own limit of its gradients",
    ("maths/voronoi.py", 1e-4): "the least distance, squared, of points that Blender draws an edge between, in units of its cells",
}
"""The only numbers that near to 0 or 1 in the engine, and of what they are."""


def value_of(node):
    """What an expression of typed numbers comes to; None for others."""
    if isinstance(node, ast.Constant):
        return node.value if type(node.value) in (int, float) else None
    if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
        value = value_of(node.operand)
        return None if value is None else -value
    if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
        left, right = value_of(node.left), value_of(node.right)
        if left is None or right is None:
            return None
        try:
            return OPERATORS[type(node.op)](left, right)
        except (ArithmeticError, TypeError):
            return None
    return None


def epsilons(source):
    """Numbers nearer than SMALLEST to 0 or 1, typed or worked out of typed ones, such as 10**-6; and the eps of a kind of float."""
    found = []

    def look(node):
        value = value_of(node)
        if isinstance(value, float) and any(0 < abs(abs(value) - x) < SMALLEST for x in (0, 1)):
            found.append(value)
            return
        if isinstance(node, ast.Attribute) and node.attr in ("eps", "resolution"):
            found.append(node.attr)
        for child in ast.iter_child_nodes(node):
            look(child)

    look(ast.parse(source))
    return found


def place(path):
    return path.relative_to(ENGINE).as_posix()


@pytest.mark.parametrize("path", sorted(ENGINE.rglob("*.py")), ids=place)
def test_no_epsilon_is_typed(path):
    """Offsets and tolerances are in proportion to the numbers at hand, never 1e-6 metres."""
    unknown = [value for value in epsilons(path.read_text(encoding="utf-8")) if (place(path), value) not in REVIEWED]
    assert unknown == []


def test_what_was_reviewed_is_still_there():
    there = {(place(path), value) for path in ENGINE.rglob("*.py") for value in epsilons(path.read_text(encoding="utf-8"))}
    assert sorted(map(str, set(REVIEWED) - there)) == []


@pytest.mark.parametrize(
    "planted",
    [
        "h = 1e-6 * n",
        "t > -0.0001",
        "hit = t > 10**-6",
        "hit = t > 1 / 65536",
        "o = p + np.float32(2.0**-16) * n",
        "is_mirror = cos > 1 - 1e-6",
        "is_mirror = cos > 0.99999",
        "distance = max(distance, np.finfo(np.float32).eps)",
    ],
)
@pytest.mark.parametrize("file", ["world/interaction.py", "wavefront/direct.py", "maths/patches.py", "world/accel.py"])
def test_a_planted_epsilon_is_found(planted, file):
    source = (ENGINE / file).read_text(encoding="utf-8")
    assert not [value for value in epsilons(source) if (file, value) not in REVIEWED]
    assert [value for value in epsilons(f"{source}\n{planted}\n") if (file, value) not in REVIEWED]


def test_plain_numbers_are_no_epsilons():
    assert not epsilons("x = 0.5 + 1.0 * y - 2 / 3\nn = 1\nm = -1.0\nz = 0.0")
