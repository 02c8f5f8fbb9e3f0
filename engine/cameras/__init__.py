"""The cameras: one file each, found by looking into this folder."""

from ..registry import CAMERAS as registry

registry.discover(__name__, __path__)
