"""The filters: one file each, found by looking into this folder."""

from ..registry import FILTERS as registry

registry.discover(__name__, __path__)
