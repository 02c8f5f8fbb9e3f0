"""`python -m glanz.cli`."""

from .main import run

run()
