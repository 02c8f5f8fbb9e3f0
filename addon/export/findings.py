"""What the export left out or approximated, collected so that a thousand objects give one line."""

_MOST_NAMES = 4


class Findings:
    """Notes grouped by what they say; each names who is concerned, once."""

    def __init__(self):
        self._names = {}

    def note(self, what, name):
        """Record `what` happened to `name`, such as "object 'Cube'"."""
        self._names.setdefault(what, {})[name] = True

    def add(self, others):
        """Record what is noted in other `Findings`."""
        for what, names in others._names.items():
            self._names.setdefault(what, {}).update(names)

    def lines(self):
        """One warning for each kind of note, with the first few names and the count of the others."""
        return tuple(f"{what}: {_shortened(list(names))}" for what, names in self._names.items())


def _shortened(names):
    rest = len(names) - _MOST_NAMES
    return ", ".join(names[:_MOST_NAMES]) + (f" and {rest} more" if rest > 0 else "")
