"""Which things cover a pixel, by their names, for mattes with soft edges: Friedman and Jones, *Cryptomatte specification* 1.2."""

import json
import re
from dataclasses import dataclass

import numpy as np

from ..maths.murmur import id_bits, id_of
from ..wavefront.passing import opacity
from ..wavefront.recording import FirstHit
from . import registry

_NAMES = {
    "Object": lambda scene: (o.name for o in scene.objects),
    "Material": lambda scene: (m.name for o in scene.objects for m in o.materials),
    "Asset": lambda scene: (o.asset or o.name for o in scene.objects),
}


@registry.add_family
@dataclass(frozen=True)
class Cryptomatte(FirstHit):
    """Two of the objects, materials or assets that cover most of a pixel: the number of each name, and its share of the pixel.

    A transparent surface covers what it does not let pass. Where pixels are divided, the shares are those of whole pixels.

    kind   "Object", "Material" or "Asset"
    level  0 for the first two, 1 for the next, ...
    """

    pattern = "CryptoObject00, CryptoMaterial00, CryptoAsset00 and so on"
    channels = "rgba"
    rows = 2
    reduction = "ranks"
    covers = True

    kind: str
    level: int

    @classmethod
    def of(cls, key):
        """The pass of that name, or None."""
        found = re.fullmatch(r"Crypto(Object|Material|Asset)([0-9][0-9])", key)
        return found and cls(found[1], int(found[2]))

    @property
    def key(self):
        """Its name."""
        return f"Crypto{self.kind}{self.level:02}"

    label = key

    @property
    def attributes(self):
        """See `interfaces.Pass`."""
        return () if self.kind == "Material" else ((f"name of {self.kind.lower()}", ""),)

    def values(self, plan, rays, surface, reflection):
        """See `interfaces.Pass`."""
        if self.kind == "Material":
            ids = np.array([id_of(name) for name in plan.world.materials.names], np.float32).take(surface.material)
        else:
            ids = plan.world.attributes[self.attributes[0]].at(surface.prim, surface.u, surface.v)[0][0]
        return np.stack((ids, opacity(plan, rays, surface)))

    def facts(self, scene, layer):
        """What files must say of it {name: str}; `layer` stands in front of the names of their channels."""
        name = f"{layer}.Crypto{self.kind}" if layer else f"Crypto{self.kind}"
        head = f"cryptomatte/{_hash_of_layer(name)}"
        manifest = {known: f"{id_bits(known):08x}" for known in _NAMES[self.kind](scene)}
        facts = {"name": name, "hash": "MurmurHash3_32", "conversion": "uint32_to_float32"}
        facts["manifest"] = json.dumps(manifest, separators=(",", ":"), ensure_ascii=False)
        return {f"{head}/{key}": value for key, value in facts.items()}


def _hash_of_layer(name):
    return f"{id_bits(name):08x}"[:7]
