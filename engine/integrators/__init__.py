"""The integrators: one file each, found by looking into this folder."""

from ..registry import INTEGRATORS as registry

registry.discover(__name__, __path__)
