"""The lights: one file each, found by looking into this folder."""

from ..registry import LIGHTS as registry

registry.discover(__name__, __path__)
