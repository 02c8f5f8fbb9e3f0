"""An interval around each pixel that holds the truth."""

from ..maths.student import quantile_975
from ..wavefront.recording import OfError
from . import registry


@registry.add
class Confidence(OfError):
    """Half the width of the interval about the pixel's radiance that holds the truth with 95 % [W m^-2 sr^-1]; infinite where unknown."""

    key = "Confidence"
    label = "Confidence (95 %)"

    @staticmethod
    def of(replicates):
        """(3, P), of the radiances of replicates."""
        # By Student's distribution, for the error is an estimate from few replicates itself.
        return replicates.standard_error() * quantile_975(replicates.freedom())
