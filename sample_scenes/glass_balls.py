"""Glass balls that bend what is behind them: each ball takes two bounces, so a pyramid takes many."""

import balls
import common


def build():
    """The scene."""
    return balls.build("Glass balls", lambda: [common.glass("Glass", (1.0, 1.0, 1.0), 1.5)], max_depth=10)


if __name__ == "__main__":
    common.save(build(), __file__)
