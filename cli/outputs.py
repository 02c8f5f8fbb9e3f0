"""Names of the files that are written, and writing them."""

import re
from pathlib import Path

SUFFIXES = (".exr", ".png")


def default_output(file):
    """The picture's name when none is given: that of the input, in the current folder."""
    return f"{Path(file).stem}.exr"


def numbered(path, frame, is_sequence):
    """`path` with the frame's number in place of its last run of #, as Blender does.

    Without # a frame of a sequence gets four digits: `out_0001.exr`. `frame` None: `path` as it is.
    """
    folder, name = str(Path(path).parent), Path(path).name
    if frame is None:
        return path
    if "#" in name:
        start, end = [match.span() for match in re.finditer("#+", name)][-1]
        name = name[:start] + f"{frame:0{end - start}d}" + name[end:]
    elif is_sequence:
        name = f"{Path(name).stem}_{frame:04d}{Path(name).suffix}"
    return str(Path(folder, name))
