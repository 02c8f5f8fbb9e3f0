"""Files of lamp makers: every photometric type and symmetry in one frame, and bad files told apart."""

import numpy as np
import pytest

from glanz.engine import FileError, IesTexture, parse_ies
from glanz.engine.io.ies import CANDELA
from glanz.engine.scene.points import Points
from glanz.tests import helpers as h

QUARTER, HALF, WHOLE = np.linspace(0, 90, 10), np.linspace(0, 180, 19), np.linspace(0, 360, 37)


def text(candela, vertical, horizontal, kind=1, tilt="TILT=NONE", multiplier=1.0, separator=" "):
    """An LM-63 file of a function candela(v, h) of its own angles [degrees]."""
    values = [candela(np.radians(vertical), np.radians(angle)) + 0 * vertical for angle in horizontal]
    head = [f"1 1000 {multiplier} {len(vertical)} {len(horizontal)} {kind} 2 0 0 0", "1 1 40"]
    rows = [separator.join(f"{x:.6f}" for x in row) for row in (vertical, horizontal, *values)]
    return "\r\n".join(["IESNA:LM-63-2002", "[MANUFAC] Löwe, 1 Watt", tilt, *head, *rows]) + "\r\n"


def shape(d):
    """Intensity of a lamp (3, N) -> (N,) that has every symmetry: an ellipsoid, more down than up."""
    x, y, z = d
    return 1 + 0.5 * x * x + 0.2 * y * y - 0.4 * z


def of_angles(v, h):
    """The same by the angles of type C: from -z, about it."""
    return shape(np.stack(np.broadcast_arrays(-np.sin(v) * np.sin(h), -np.sin(v) * np.cos(h), -np.cos(v))))


def looked_up(tables, d):
    return np.concatenate([IesTexture(tuple(a), **tables).eval(Points())[0] for a in d.T])


@pytest.mark.parametrize("horizontal", [QUARTER, HALF, WHOLE, WHOLE[:-1]])
def test_type_c_is_completed_by_its_symmetry(horizontal):
    d = h.directions(1, 300)
    tables = parse_ies(text(of_angles, HALF, horizontal, multiplier=2.0))
    # Steps of 10 degrees, cubics between: 0.2 % of the brightest.
    np.testing.assert_allclose(looked_up(tables, d), 2 * CANDELA * shape(d), atol=0.008 * CANDELA)


def test_one_angle_is_all_around_and_what_is_beyond_the_angles_is_dark():
    tables = parse_ies(text(lambda v, _: np.cos(v), QUARTER, np.zeros(1)))
    d = h.directions(2, 300)
    # At the ends of a table cubics bend less than in between.
    np.testing.assert_allclose(looked_up(tables, d), CANDELA * np.maximum(-d[2], 0), atol=0.02 * CANDELA)


def test_type_a_lies_and_is_mirrored():
    """Its horizontal angles run to the sides of the axis; the axis becomes that at 180 degrees, +y."""

    def candela(v, a):
        return np.cos(v) * np.cos(a)

    half, whole = (looked_up(parse_ies(text(candela, HALF - 90, angles, kind=3)), h.directions(3, 300)) for angles in (QUARTER, HALF - 90))
    np.testing.assert_allclose(half, whole, atol=0.01 * CANDELA)
    # At the ends of a table cubics bend less than in between.
    np.testing.assert_allclose(whole, CANDELA * np.maximum(h.directions(3, 300)[1], 0), atol=0.03 * CANDELA)


def test_type_b_changes_its_axes_and_is_mirrored():
    whole = parse_ies(text(lambda v, a: 1 + np.cos(v) ** 2 + 0.3 * np.cos(a), HALF - 90, HALF - 90, kind=2))
    part = parse_ies(text(lambda v, a: 1 + np.cos(v) ** 2 + 0.3 * np.cos(a), QUARTER, QUARTER, kind=2))
    for name, table in whole.items():
        np.testing.assert_allclose(part[name], table, atol=1e-6)


def test_tilt_tables_and_commas_are_passed():
    plain = parse_ies(text(of_angles, HALF, QUARTER))
    for other in (
        text(of_angles, HALF, QUARTER, tilt="TILT=INCLUDE\n1\n3\n0 45 90\n1 0.9 0.8"),
        text(of_angles, HALF, QUARTER, separator=", "),
        text(of_angles, HALF, QUARTER) + "END OF FILE\n",
    ):
        assert all(h.same_bits(a, b) for a, b in zip(parse_ies(other).values(), plain.values()))


GOOD = text(of_angles, HALF, QUARTER)


@pytest.mark.parametrize(
    ("bad", "cause"),
    [
        ("", "TILT"),
        ("PNG\x00\xff" * 50, "TILT"),
        (GOOD[: len(GOOD) // 2], "ends too early"),
        (GOOD.replace(" 19 10 1 2", " 0 10 1 2"), "vertical angles"),
        (GOOD.replace(" 19 10 1 2", " 19 99999999999 1 2"), "horizontal angles"),
        (GOOD.replace(" 19 10 1 2", " nan 10 1 2"), "vertical angles"),
        (GOOD.replace(" 19 10 1 2", " 19 10 7 2"), "photometric type"),
        (GOOD.replace("1000 1.0", "1000 x"), "could not convert"),
        (GOOD.replace("1000 1.0", "1000 inf"), "not finite"),
        (GOOD.replace("1000 1.0", "1000 1e40"), "beyond"),
        (GOOD.replace("10.000000 20.000000", "10.000000 10.0000001"), "do not grow"),
        (GOOD.replace("10.000000 20.000000", "20.000000 10.000000"), "do not grow"),
        (text(of_angles, HALF[:1], QUARTER), "single angle"),
    ],
)
def test_bad_files_are_refused_with_their_cause(bad, cause):
    with pytest.raises(FileError, match=cause):
        parse_ies(bad)
