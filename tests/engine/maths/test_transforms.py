"""Points, normals and sides under affine maps (catalogue A14)."""

import numpy as np
import pytest

from glanz.engine.maths import transforms
from glanz.tests import helpers as h

MATRICES = {
    "rotation": h.rotation(1),
    "mirror": h.rotation(2) @ np.diag((1, 1, -1)),
    "non-uniform": h.rotation(3) @ np.diag((1e-6, 1, 1e6)),
    "shear": np.array([[1, 2, 0], [0, 1, 3], [0, 0, 1.0]]),
}


@pytest.mark.parametrize("name", MATRICES)
def test_cofactors_carry_normals(name):
    """A normal stays across its plane: cof(M) n = (M a) x (M b) for n = a x b, to 1e-12."""
    matrix = h.affine(MATRICES[name], (5, 6, 7))
    a, b = h.directions(5, 100), h.directions(6, 100)
    carried = transforms.cofactors(matrix) @ np.cross(a.T, b.T).T
    exact = matrix[:3, :3].astype(np.longdouble)
    truth = np.cross((exact @ a).T, (exact @ b).T).T
    assert np.abs(carried - truth).max() <= 1e-12 * np.abs(truth).max()


def test_cofactors_need_no_inverse():
    flat = h.affine(np.diag((2.0, 3.0, 0.0)))
    assert (transforms.cofactors(flat) @ [0, 0, 1] == [0, 0, 6]).all()


def test_orientation_is_flipped_by_an_odd_number_of_mirrors():
    assert not transforms.flips_orientation(h.affine(h.rotation(1)))
    assert transforms.flips_orientation(h.affine(np.diag((-1, 1, 1))))
    assert not transforms.flips_orientation(h.affine(np.diag((-1, -1, 1))))
    assert transforms.flips_orientation(h.affine(np.diag((-1, -1, -1))))


def test_look_at_has_the_axes_of_the_lecture():
    matrix = transforms.look_at((1, 2, 3), (1, 2, -5), up=(0, 1, 0))
    np.testing.assert_allclose(matrix, h.affine(np.eye(3), (1, 2, 3)), atol=1e-15)
    matrix = transforms.look_at((3, -4, 2), (0.5, 1, -1))
    np.testing.assert_allclose(matrix[:3, :3] @ matrix[:3, :3].T, np.eye(3), atol=1e-15)
    assert np.linalg.det(matrix[:3, :3]) == pytest.approx(1)
    assert matrix[2, 1] > 0


@pytest.mark.parametrize("target", [(0, 0, 0), (0, 0, 5)])
def test_a_view_without_an_up_is_refused(target):
    with pytest.raises(ValueError, match="no view from"):
        transforms.look_at((0, 0, 0), target)
