"""Names as numbers: MurmurHash3 (Appleby 2011, the 32-bit variant of x86), and as the floats by which Cryptomatte knows things."""

import struct
from functools import lru_cache

_MASK = 0xFFFFFFFF


def murmur3(data):
    """The hash of bytes, seed 0, an integer below 2^32."""
    h = 0
    whole = len(data) & ~3
    for (k,) in struct.iter_unpack("<I", data[:whole]):
        h = (_turned(h ^ _mixed(k), 13) * 5 + 0xE6546B64) & _MASK
    h ^= _mixed(int.from_bytes(data[whole:], "little")) ^ len(data)
    h = (h ^ h >> 16) * 0x85EBCA6B & _MASK
    h = (h ^ h >> 13) * 0xC2B2AE35 & _MASK
    return h ^ h >> 16


@lru_cache(maxsize=2**16)
def id_bits(name):
    """The bits of the float32 that stands for a name: its hash, whose exponent is kept from that of 0 and of what is no number.

    Friedman and Jones, *Cryptomatte specification* 1.2, "ID generation".
    """
    h = murmur3(name.encode())
    exponent = min(max(h >> 23 & 255, 1), 254)
    return h & 0x807FFFFF | exponent << 23


def id_of(name):
    """The same as a number."""
    return struct.unpack("<f", struct.pack("<I", id_bits(name)))[0]


def _turned(x, by):
    return (x << by | x >> 32 - by) & _MASK


def _mixed(k):
    return _turned(k * 0xCC9E2D51 & _MASK, 15) * 0x1B873593 & _MASK
