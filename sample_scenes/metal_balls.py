"""Metal balls that reflect each other: Whitted's recursion, one depth after the other."""

import balls
import common

METALS = (
    ("Silver", (0.95, 0.93, 0.88)),
    ("Gold", (1.0, 0.77, 0.34)),
    ("Copper", (0.95, 0.64, 0.54)),
)


def build():
    """The scene. Polished metal has no colour of its own: with depth 0 its balls are black."""
    return balls.build("Metal balls", lambda: [common.glossy(name, colour, 0.0) for name, colour in METALS], max_depth=5)


if __name__ == "__main__":
    common.save(build(), __file__)
