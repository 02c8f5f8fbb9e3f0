"""The passes: one file each, found by looking into this folder."""

from ..registry import PASSES as registry

registry.discover(__name__, __path__)
