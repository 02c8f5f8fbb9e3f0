"""The lights: one file each, found by looking into this folder."""

from ..registry import lights as registry

registry.discover(__name__, __path__)
