"""The command line: `glanz render`, `glanz info`, `glanz export`. The outermost layer; nothing imports it."""

from .main import main, run

__all__ = ["main", "run"]
