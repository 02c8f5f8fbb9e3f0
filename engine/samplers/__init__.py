"""The samplers: one file each, found by looking into this folder."""

from ..registry import SAMPLERS as registry

registry.discover(__name__, __path__)
