"""How far the picture may be from the truth."""

from . import registry


@registry.add
class StandardError:
    """Standard deviation of the pixel's radiance about what infinitely many samples would give [W m^-2 sr^-1]; infinite where unknown."""

    key = "Standard Error"
    label = "Standard Error"
    channels = "RGB"
    records = ""
    reduction = "replicates"
    divided_by = ""

    @staticmethod
    def gather(film):
        return film.radiance

    @staticmethod
    def of(replicates):
        """(3, P), of the radiances of replicates."""
        return replicates.standard_error()
