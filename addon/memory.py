"""How much memory this process has used, for the status line."""

import sys

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
