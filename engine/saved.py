"""What a render has come to, as numbers: enough to go on from there to the same bits."""

from dataclasses import dataclass, field

from .ending import NOT_BEGUN, Reached


@dataclass(frozen=True, slots=True, eq=False)
class Saved:
    """A render that may go on.

    reached   how far the whole frame is
    ending    {name: number} of what the `Ending` has learned, and how long it took
    bad       {name of an object: samples that were not finite}
    light     what there would be without clamping, and what that has taken away, sums of all pixels
    tiles     {place: {name: array}} of tiles that are begun, see `Film.state`
    finished  {place: {pass: (C, P) float32}} of those that are done
    """

    reached: Reached = NOT_BEGUN
    ending: dict = field(default_factory=dict)
    bad: dict = field(default_factory=dict)
    light: tuple = (0.0, 0.0)
    tiles: dict = field(default_factory=dict)
    finished: dict = field(default_factory=dict)


class NoCheckpoint:
    """Nothing is saved; what `render_plan` asks of a checkpoint, see `io.checkpoint.Checkpoint`."""

    seconds = 0.0
    """About how much time [s] may be lost; 0: rounds are as long as they would be."""

    def load(self):
        """The `Saved` to go on from."""
        return Saved()

    def is_due(self):
        """Whether it is time to save."""
        return False

    def save(self, saved):
        """Keep a `Saved`."""

    def remove(self):
        """Forget it, as of a render that is done."""


NO_CHECKPOINT = NoCheckpoint()
"""For renders that are not saved on the way."""
