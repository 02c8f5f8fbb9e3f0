"""What is known of textures where there are no points."""

import pytest

from glanz.engine import CheckerTexture, GradientTexture, ImageTexture, folded


@pytest.mark.parametrize(
    ("texture", "value"),
    [
        (ImageTexture(coordinates=(0.3, 1.7, -2.2)), (0.5, 0.5, 0.5)),
        (CheckerTexture((0.1, 0.2, 0.3), (1.0, 0.0, 1.0), (0.3, 0.6, 1.2)), (0.1, 0.2, 0.3)),
        (GradientTexture(coordinates=(0.3, 0.6, 1.2)), 0.3),
    ],
)
def test_a_texture_looked_up_at_a_constant_is_a_constant(texture, value):
    assert folded(texture) == pytest.approx(value)
