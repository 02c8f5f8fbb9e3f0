"""What most passes have in common, see `interfaces.Pass`: mostly the mean of what is written down along the way, 0 before."""


class FirstHit:
    """A pass of what camera rays hit."""

    records = "first hit"
    reduction = "mean"
    divided_by = ""
    background = 0.0


class OfLight:
    """A pass of a part of the light."""

    records = "light"
    reduction = "mean"
    divided_by = ""
    background = 0.0


class OfError:
    """A pass of how far the radiance of a pixel may be from the truth."""

    channels = "RGB"
    records = ""
    reduction = "replicates"
    divided_by = ""
