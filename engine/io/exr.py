"""Pictures as OpenEXR files, linear and without loss; the only file that imports OpenEXR.

Combined is stored as R, G, B, A, which every program shows; other passes as `Depth.Z`, `Normal.X`, ..., which Blender
reads as passes of one layer and others as layers. All channels are float32, ZIP compressed (OpenEXR documentation,
*Technical Introduction*: channel names, layers).
"""

import numpy as np

from ..errors import FileError
from ..registry import PASSES
from ..rendering import Image
from .atomic import cause, replacing

PLAIN = "Combined"
"""The pass whose channels go without its name in front."""


def write_exr(path, image):
    """Write `image`, an `Image`, with its metadata as strings in the header.

    The file appears whole or not at all. Raises FileError, naming `path` and the cause.
    """
    openexr = _openexr()
    channels = channels_of(image.passes)
    header = {"compression": openexr.ZIP_COMPRESSION, "type": openexr.scanlineimage}
    header |= {str(name): str(value) for name, value in image.metadata.items()}
    with replacing(path) as temporary:
        try:
            # OpenEXR writes into the dictionaries that it is given, so it gets a copy.
            with openexr.File(header, dict(channels)) as file:
                file.write(str(temporary))
            with openexr.File(str(temporary), separate_channels=True, header_only=True) as file:
                written = {channel.name for channel in file.header()["channels"]}
        except (RuntimeError, ValueError, TypeError) as error:
            raise FileError(f"cannot write '{path}': {error}") from error
        if written != set(channels):
            raise FileError(f"cannot write '{path}': after writing, it holds the channels {sorted(written)}, not {sorted(channels)}")


def read_exr(path):
    """All channels of the first part of an EXR file, {name: (height, width) array}, row 0 at the top.

    Raises FileError, naming `path` and the cause.
    """
    with _opened(path) as file:
        return {name: np.array(channel.pixels) for name, channel in file.channels().items()}


def read_exr_metadata(path):
    """The strings in the header of an EXR file, {name: str}. Raises FileError, naming `path` and the cause."""
    with _opened(path, header_only=True) as file:
        return {name: value for name, value in file.header().items() if isinstance(value, str)}


def read_image(path):
    """The `Image` of a file as `write_exr` writes it: the passes that are known, with their metadata.

    Raises FileError, naming `path` and the cause: no EXR, or one without such passes.
    """
    channels, passes = read_exr(path), {}
    for name in dict.fromkeys(channel.rpartition(".")[0] or PLAIN for channel in channels):
        if name not in PASSES:
            raise FileError(f"cannot read '{path}': its pass '{name}' is none of Glanz's; files that Blender has written cannot be merged")
        letters = [letter if name == PLAIN else f"{name}.{letter}" for letter in PASSES[name].channels]
        if not set(letters) <= channels.keys():
            raise FileError(f"cannot read '{path}': of its pass '{name}' channels are missing")
        passes[name] = np.stack([channels[letter] for letter in letters], axis=-1)
    if not passes:
        raise FileError(f"cannot read '{path}': it has no channels")
    height, width, _ = next(iter(passes.values())).shape
    return Image(width, height, passes, read_exr_metadata(path))


def channels_of(passes):
    """{channel name: (height, width) float32} of passes {name: (height, width, channels)}."""
    channels = {}
    for name, values in passes.items():
        for index, letter in enumerate(PASSES[name].channels):
            channel = letter if name == PLAIN else f"{name}.{letter}"
            channels[channel] = np.ascontiguousarray(values[..., index], np.float32)
    return channels


def _opened(path, **options):
    openexr = _openexr()
    try:
        # OpenEXR's own errors do not say why a file cannot be opened.
        with open(path, "rb"):
            pass
        return openexr.File(str(path), separate_channels=True, **options)
    except OSError as error:
        raise FileError(f"cannot read '{path}': {cause(error)}") from error
    except (RuntimeError, ValueError, TypeError) as error:
        raise FileError(f"cannot read '{path}': it is not an OpenEXR file ({error})") from error


def check():
    """Raise FileError, with the cause, where OpenEXR cannot be loaded."""
    _openexr()


def _openexr():
    try:
        import OpenEXR
    except Exception as error:  # whatever a library raises that was built for another system
        raise FileError(f"EXR files need the module OpenEXR, which cannot be loaded ({error}); cure: pip install OpenEXR") from error
    return OpenEXR
