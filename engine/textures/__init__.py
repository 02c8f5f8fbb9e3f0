"""The textures: one file each, found by looking into this folder."""

from ..registry import TEXTURES as registry

registry.discover(__name__, __path__)
