"""How much memory this process has used, for the status line."""

import sys
from pathlib import Path

try:
    import resource
except ImportError:  # Windows has none
    resource = None


def peak_megabytes():
    """The most memory that was resident at once [MB], or None where the system does not tell."""
    if resource is None:
        return None
    peak = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return peak / (2**20 if sys.platform == "darwin" else 2**10)


def used_megabytes():
    """The memory that is resident now [MB]; the most of it where only Linux would tell, or None."""
    try:
        return int(Path("/proc/self/statm").read_text().split()[1]) * resource.getpagesize() / 2**20
    except OSError:
        return peak_megabytes()
