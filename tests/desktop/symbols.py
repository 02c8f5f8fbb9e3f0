"""Which file each imported function of a loaded library was bound to: read from its relocations, and the memory that they point at.

Source: Tool Interface Standard, Executable and Linking Format 1.2, with the 64-bit sizes of its x86-64 supplement.
"""

import ctypes
import struct
from pathlib import Path

RELA, DYNSYM = 4, 11
GLOB_DAT, JUMP_SLOT = 6, 7
"""x86-64: the address of a function in a table, filled in by the dynamic linker."""


def mappings():
    """[(first address, end, file offset, path)] of the files in this process's memory."""
    found = []
    for line in Path("/proc/self/maps").read_text().splitlines():
        fields = line.split(maxsplit=5)
        if len(fields) == 6 and fields[5].startswith("/"):
            first, _, end = fields[0].partition("-")
            found.append((int(first, 16), int(end, 16), int(fields[2], 16), fields[5]))
    return found


def file_of(address, mapped):
    """The file that `address` belongs to; empty: none."""
    return next((path for first, end, _, path in mapped if first <= address < end), "")


def bindings(library, prefix):
    """{function: file that it is bound to} of the functions that the loaded `library` imports under a `prefix`."""
    mapped = mappings()
    library = str(Path(library).resolve())
    base = next(first for first, _, offset, path in mapped if path == library and offset == 0)
    found = {}
    for name, where in slots(Path(library).read_bytes()):
        if name.startswith(prefix):
            found[name] = file_of(ctypes.c_uint64.from_address(base + where).value, mapped)
    return found


def slots(data):
    """(function, where its address is kept, counted from the library's base) for the ELF file `data`."""
    if data[:6] != b"\x7fELF\x02\x01":
        raise ValueError("not a 64-bit little-endian ELF file")
    (table,) = struct.unpack_from("<Q", data, 40)
    size, count = struct.unpack_from("<HH", data, 58)
    sections = [struct.unpack_from("<IIQQQQIIQQ", data, table + size * n) for n in range(count)]
    for _, kind, _, _, offset, length, link, *_ in sections:
        if kind != RELA or sections[link][1] != DYNSYM:
            continue
        symbols, strings = sections[link][4], sections[sections[link][6]][4]
        for start in range(offset, offset + length, 24):
            where, info, _ = struct.unpack_from("<QQq", data, start)
            if info & 0xFFFFFFFF in (GLOB_DAT, JUMP_SLOT):
                (name,) = struct.unpack_from("<I", data, symbols + 24 * (info >> 32))
                yield data[strings + name : data.index(b"\0", strings + name)].decode(), where
