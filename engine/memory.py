"""How much memory there is: what a picture, a mesh or an image takes is told before it is taken.

Memory that runs out later is a crash of Embree or Blender, or the system ends the process. A limit of this process, or of the group
that it is in, as of a container, counts where it is lower than what the machine has left.
"""

from pathlib import Path

from .errors import MemoryShortage

try:
    import resource
except ImportError:  # Windows has none
    resource = None

SHARE = 0.9
"""Of free memory, what one thing may take."""
_GROUPS = Path("/sys/fs/cgroup")
# Of a group: where it is, its limit, what it uses, what of that are copies of files which the system lets go.
_KINDS = {
    "": ("", "memory.max", "memory.current", "inactive_file"),
    "memory": ("memory", "memory.limit_in_bytes", "memory.usage_in_bytes", "total_inactive_file"),
}


def require(needed, what, cure, share=SHARE):
    """Raises MemoryShortage where more than a `share` of free memory is `needed` [bytes] for `what`, a plural; the `cure` needs less."""
    available = free()
    if available is not None and needed > share * available:
        raise MemoryShortage(f"{what} need about {_words(needed)} of memory, but only {_words(available)} are free: {cure}")


def free():
    """Bytes that this process could still take, None where the system does not say."""
    known = [number for number in (_of_machine(), _of_process(), *_of_groups()) if number is not None]
    return max(min(known), 0) if known else None


def _words(number):
    return f"{number / 2**30:.1f} GiB" if number >= 2**30 / 10 else f"{number / 2**20:.1f} MiB"


def _of_machine():
    return _number_after("MemAvailable:", Path("/proc/meminfo"), 1024)


def _of_process():
    """What its limit leaves of its address space."""
    limit = resource.getrlimit(resource.RLIMIT_AS)[0] if resource else None
    if limit is None or limit == resource.RLIM_INFINITY:
        return None
    pages = _number(Path("/proc/self/statm"))
    return None if pages is None else limit - pages * resource.getpagesize()


def _of_groups():
    """What the limits of its control groups leave, and of those that they are in."""
    try:
        lines = Path("/proc/self/cgroup").read_text().split()
    except OSError:
        return
    for line in lines:
        _, kinds, path = line.split(":", 2)
        for kind in _KINDS.keys() & {*kinds.split(",")}:
            root, limit, usage, kept = _KINDS[kind]
            group = _GROUPS / root / path.lstrip("/")
            for place in (group, *group.parents):
                if not place.is_relative_to(_GROUPS / root):
                    break
                most, used = _number(place / limit), _number(place / usage)
                if most is not None and used is not None:
                    yield most - used + (_number_after(kept, place / "memory.stat") or 0)


def _number(path):
    """The first word of a file, None where that is no number."""
    try:
        return int(path.read_text().split()[0])
    except (OSError, ValueError, IndexError):
        return None


def _number_after(name, path, unit=1):
    try:
        return next(int(line.split()[1]) * unit for line in path.read_text().splitlines() if line.split()[:1] == [name])
    except (OSError, ValueError, IndexError, StopIteration):
        return None
