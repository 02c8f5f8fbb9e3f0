"""The bsdfs: one file each, found by looking into this folder."""

from ..registry import BSDFS as registry

registry.discover(__name__, __path__)
