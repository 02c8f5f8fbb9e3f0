"""A scene and its settings in one file: a zip of `scene.json` and NumPy arrays; see docs/scene_file.md.

What is read is never executed: values are built from a fixed list of types, arrays are read without pickle and only
as large as the file itself. Writing and reading gives back the same numbers, bit for bit, and what was shared stays
shared.
"""

import json
import os
import stat
import struct
import zipfile
import zlib

from ..errors import FileError, GlanzError
from .arrays import ArrayReader, ArrayWriter
from .atomic import cause, replacing
from .records import Decoder, Encoder

FORMAT = "glanz scene"
VERSION = 1
DOCUMENT = "scene.json"
FIXED_DATE = (1980, 1, 1, 0, 0, 0)
"""Equal scenes give equal files."""
DAMAGED = (zipfile.BadZipFile, zlib.error, struct.error, ValueError, KeyError, EOFError, RuntimeError, MemoryError, OverflowError)
"""What Python's zip and JSON readers raise for bytes that are no zip or no JSON (RuntimeError includes RecursionError)."""


def write_scene(path, scene, settings):
    """Write a `Scene` and its `Settings` to one file, whole or not at all.

    Raises FileError, naming `path` and the cause: an unwritable path, or a value of a type that the file cannot hold.
    """
    with replacing(path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_STORED, allowZip64=True) as file:
        try:
            encoder = Encoder(ArrayWriter(lambda name, data: add_entry(file, name, data)))
            content = {"scene": encoder.encode(scene), "settings": encoder.encode(settings)}
            document = {"format": FORMAT, "version": VERSION, "shared": encoder.shared, **content}
            add_entry(file, DOCUMENT, json.dumps(document, indent=1, allow_nan=False).encode())
        except (TypeError, ValueError, RecursionError) as error:
            raise FileError(f"cannot write '{path}': {error}") from error


def read_scene(path):
    """(scene, settings) of a file written by `write_scene`.

    Raises FileError, naming `path` and the cause, for whatever is not such a file, whole and of a known version.
    """
    try:
        size = os.stat(path).st_size
        if not stat.S_ISREG(os.stat(path).st_mode):
            # Pipes and devices could be read without end.
            raise FileError("it is not a regular file")
        with zipfile.ZipFile(path) as file:
            check_entries(file, size)
            document = _parsed(file.read(DOCUMENT))
            decoder = Decoder(ArrayReader(file.read), document.get("shared", []))
            return decoder.decode(document["scene"], "Scene"), decoder.decode(document["settings"], "Settings")
    except GlanzError as error:
        raise FileError(f"cannot read '{path}': {error}") from error
    except OSError as error:
        raise FileError(f"cannot read '{path}': {cause(error)}") from error
    except RecursionError as error:
        raise FileError(f"cannot read '{path}': its values stand in each other too deep, which shared values need not") from error
    except DAMAGED as error:
        raise FileError(f"cannot read '{path}': it is not a Glanz scene, or damaged ({type(error).__name__}: {error})") from error


def add_entry(file, name, data):
    """Write `data` as the entry `name` of a zip, the same bytes whenever."""
    entry = zipfile.ZipInfo(name, FIXED_DATE)
    entry.external_attr = 0o644 << 16
    file.writestr(entry, data)


def check_entries(file, size):
    """Entries must be stored as they are and side by side, so that they cannot unpack to more than the file's `size`."""
    if sum(entry.file_size for entry in file.infolist()) > size:
        raise FileError("its entries claim more bytes than the file has")
    for entry in file.infolist():
        if entry.compress_type != zipfile.ZIP_STORED or entry.file_size != entry.compress_size:
            raise FileError(f"its entry '{entry.filename}' is compressed, allowed: stored")


def _parsed(text):
    document = json.loads(text)
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise FileError("it is not a Glanz scene")
    if document.get("version") != VERSION:
        raise FileError(f"it has version {document.get('version')!r} of the format, this Glanz reads {VERSION}")
    return document
