"""How far the picture may be from the truth."""

from ..wavefront.recording import OfError
from . import registry


@registry.add
class StandardError(OfError):
    """Standard deviation of the pixel's radiance about what infinitely many samples would give [W m^-2 sr^-1]; infinite where unknown."""

    key = "Standard Error"
    label = "Standard Error"

    @staticmethod
    def of(replicates):
        """(3, P), of the radiances of replicates."""
        return replicates.standard_error()
