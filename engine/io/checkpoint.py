"""Checkpoints: what a render has come to in a file, whole or not at all, from which it goes on to the same bits."""

import hashlib
import io
import json
import time
import zipfile
from dataclasses import asdict
from pathlib import Path

import numpy as np

from ..ending import Reached
from ..errors import FileError
from ..saved import Saved
from .arrays import ArrayWriter
from .atomic import cause, check_writable, replacing
from .records import Encoder
from .scene_file import DAMAGED, add_entry, check_entries

FORMAT = "glanz checkpoint"
VERSION = 2
HEAD = "checkpoint.json"
SECONDS = 60.0
"""Between two of them: what a crash may cost."""


class Checkpoint:
    """The file at `path` for a render of `scene` by `settings`, written about every so many `seconds`.

    on_other  if given, is called with the FileError that there is where the file is of another render, which is begun anew then
    Raises FileError if it cannot be written there.
    """

    def __init__(self, path, scene, settings, seconds=SECONDS, on_other=None):
        check_writable(path)
        self.seconds = seconds
        self._on_other = on_other
        self._path = path
        self._identity = identity(scene, settings)
        self._saved_at = time.monotonic()

    def load(self):
        """The `Saved` of the file, or of nothing where there is none.

        Raises FileError, naming the path and the cause: a damaged file, or one of another scene, other settings or another version.
        """
        if not Path(self._path).exists():
            return Saved()
        try:
            return self._read()
        except FileError as error:
            if not self._on_other:
                raise
            self._on_other(error)
            return Saved()

    def _read(self):
        try:
            with zipfile.ZipFile(self._path) as file:
                check_entries(file, Path(self._path).stat().st_size)
                head = json.loads(file.read(HEAD))
                if not isinstance(head, dict) or (head.get("format"), head.get("version")) != (FORMAT, VERSION):
                    raise FileError(f"it is no checkpoint of version {VERSION}")
                if head["identity"] != self._identity:
                    raise FileError("it is of another scene, or of other settings; delete it to begin anew, or name another file")
                return _saved(head, lambda name: np.load(io.BytesIO(file.read(name)), allow_pickle=False))
        except FileError as error:
            raise FileError(f"cannot go on from '{self._path}': {error}") from None
        except OSError as error:
            raise FileError(f"cannot go on from '{self._path}': {cause(error)}") from error
        except (*DAMAGED, TypeError) as error:
            raise FileError(f"cannot go on from '{self._path}': it is damaged ({type(error).__name__}: {error}); delete it") from error

    def is_due(self):
        """Whether it is time to save."""
        return time.monotonic() - self._saved_at >= self.seconds

    def save(self, saved):
        """Write a `Saved` in the place of the last one, whole or not at all. Raises FileError, after which it is not due for a while."""
        self._saved_at = time.monotonic()
        head = {"format": FORMAT, "version": VERSION, "identity": self._identity, "bad": saved.bad, "ending": saved.ending}
        head["light"] = saved.light
        # JSON has no infinity.
        head["reached"] = asdict(saved.reached) | {"error": repr(saved.reached.error)}
        with replacing(self._path) as temporary, zipfile.ZipFile(temporary, "w", zipfile.ZIP_STORED, allowZip64=True) as file:
            for kind in ("tiles", "finished"):
                parts = getattr(saved, kind)
                head[kind] = [[list(place), list(arrays)] for place, arrays in parts.items()]
                for number, arrays in enumerate(parts.values()):
                    for place, values in enumerate(arrays.values()):
                        data = io.BytesIO()
                        np.save(data, values, allow_pickle=False)
                        add_entry(file, f"{kind}/{number}/{place}.npy", data.getvalue())
            add_entry(file, HEAD, json.dumps(head, allow_nan=False).encode())
        # Writing may take long, and is no work that could be lost.
        self._saved_at = time.monotonic()

    def remove(self):
        """Delete the file, as of a render that is done."""
        Path(self._path).unlink(missing_ok=True)


def identity(scene, settings):
    """What tells renders apart that do not go on from each other: a hash of the scene and of all settings but `threads`."""
    digest = hashlib.sha256()
    encoder = Encoder(ArrayWriter(lambda name, data: digest.update(data)))
    content = [encoder.encode(scene), encoder.encode(settings)]
    content[1].pop("threads", None)
    digest.update(json.dumps([content, encoder.shared]).encode())
    return digest.hexdigest()


def _saved(head, read):
    reached = Reached(**head["reached"] | {"error": float(head["reached"]["error"])})
    parts = {
        kind: {
            tuple(place): {name: read(f"{kind}/{number}/{i}.npy") for i, name in enumerate(names)}
            for number, (place, names) in enumerate(head[kind])
        }
        for kind in ("tiles", "finished")
    }
    return Saved(reached, head["ending"], head["bad"], tuple(head["light"]), **parts)
