"""What a file refers to in libraries that cannot be found, or do not have it any more: Blender puts something empty in its place."""

from .findings import MISSING


def is_missing(datablock):
    """Whether a data-block only stands for one of a library."""
    return getattr(datablock.original, "is_missing", False)


def note_missing(datablock, owner, findings):
    """Note it if a data-block, called `owner` in notes, is missing."""
    if is_missing(datablock):
        library = datablock.original.library
        where = f" from the library '{library.filepath}'" if library else ""
        findings.note(f"it is missing{where}, something empty is in its place", owner, MISSING)
