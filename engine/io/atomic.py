"""Files appear whole or not at all: written under a temporary name beside the target, then renamed."""

import contextlib
import os
import tempfile
from pathlib import Path

from ..errors import FileError


@contextlib.contextmanager
def replacing(path):
    """A context whose value is a temporary path, with the suffix of `path`, to write to; leaving it puts the file in place.

    The file is flushed to the disk before it is renamed. Whatever goes wrong, no partial file is left and an older
    file stays as it was. Raises FileError, naming `path` and the cause, for every OSError.
    """
    path = Path(path)
    temporary = None
    try:
        _refuse_directory(path)
        temporary = _new_file(path)
        yield temporary
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())
        os.replace(temporary, path)
        temporary = None
    except OSError as error:
        raise FileError(f"cannot write '{path}': {cause(error)}") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def check_writable(path):
    """Raises FileError now if `path` could not be written later: no such folder, no permission, a folder itself."""
    path = Path(path)
    try:
        _refuse_directory(path)
        _new_file(path).unlink()
    except OSError as error:
        raise FileError(f"cannot write '{path}': {cause(error)}") from error


def cause(error):
    """The reason of an OSError in words, without number and path."""
    return error.strerror or str(error) or type(error).__name__


def _refuse_directory(path):
    # os.replace would notice only after the work is done.
    if path.is_dir():
        raise IsADirectoryError(None, "it is a folder")


def _new_file(path):
    """An empty file beside `path` with the permissions that a file opened there would have."""
    handle, name = tempfile.mkstemp(prefix=f".{path.stem[:32]}-", suffix=path.suffix, dir=path.parent)
    try:
        os.fchmod(handle, 0o666 & ~_umask())
    finally:
        os.close(handle)
    return Path(name)


def _umask():
    # There is no way to ask for it but to set it.
    current = os.umask(0o022)
    os.umask(current)
    return current
