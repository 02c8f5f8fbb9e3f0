"""Files appear whole or not at all: written under a temporary name beside the target, then renamed."""

import contextlib
import os
import secrets
import stat
from pathlib import Path

from ..errors import FileError


@contextlib.contextmanager
def replacing(path):
    """A context whose value is a temporary path, with the suffix of `path`, to write to; leaving it puts the file in place.

    The file is flushed to the disk before it is renamed. Whatever goes wrong, no partial file is left and an older
    file stays as it was. Raises FileError, naming `path` and the cause, for every OSError.
    """
    temporary = None
    try:
        target = _target(path)
        temporary = _new_file(target)
        yield temporary
        with open(temporary, "rb+") as file:
            os.fsync(file.fileno())
        os.replace(temporary, target)
        temporary = None
    except OSError as error:
        raise FileError(f"cannot write '{path}': {cause(error)}") from error
    finally:
        if temporary is not None:
            temporary.unlink(missing_ok=True)


def check_writable(path):
    """Raises FileError now if `path` could not be written later: no such folder, no permission, a folder itself."""
    try:
        _new_file(_target(path)).unlink()
    except OSError as error:
        raise FileError(f"cannot write '{path}': {cause(error)}") from error


def cause(error):
    """The reason of an OSError in words, without number and path."""
    return error.strerror or str(error) or type(error).__name__


def _target(path):
    """Where links lead; raises OSError for what os.replace would refuse only after the work is done."""
    if "\0" in str(path):
        raise OSError(None, "its name holds a null character")
    target = Path(os.path.realpath(path))
    with contextlib.suppress(FileNotFoundError):
        if not stat.S_ISREG(os.stat(target).st_mode):
            raise OSError(None, "it is a folder or device")
    return target


def _new_file(path):
    """An empty file with a new name beside `path`, with the permissions that any new file there gets."""
    new = path.with_name(f".{path.stem[:32]}-{secrets.token_hex(4)}{path.suffix}")
    os.close(os.open(new, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666))
    return new
