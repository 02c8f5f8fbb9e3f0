"""What can go wrong: exceptions that name the cause and the cure, and warnings of what is rendered otherwise than asked for."""


class GlanzError(Exception):
    """Base of every error that Glanz raises on purpose; its text is one line, fit for a user."""


class SceneError(GlanzError):
    """A scene or setting that cannot be rendered; the text names the object and the value."""


class MemoryShortage(SceneError):
    """What would take more memory than there is; the text names it, both numbers and the cure."""


class FileError(GlanzError):
    """A file that cannot be read or written; the text names the path and the cause."""


class AccelError(GlanzError):
    """Input that Embree would answer with a crash, a hang or a lie."""


class SceneWarning(str):
    """A line for people, such as "its transform is not finite, so it is left out: object 'Cube'", that knows whom it is about.

    what        happened
    datablock   (kind, name) of whom it concerns, such as ("object", "Cube"); ("", ""): the line says it
    is_lost     whether something is left out of the picture
    """

    __slots__ = ("datablock", "is_lost", "what")

    def __new__(cls, what, kind="", name="", is_lost=False):
        line = super().__new__(cls, f"{what}: {kind} '{name}'" if kind else what)
        line.what, line.datablock, line.is_lost = what, (kind, name), is_lost
        return line

    @property
    def owner(self):
        """Whom it concerns, such as "object 'Cube'", or nothing."""
        kind, name = self.datablock
        return kind and f"{kind} '{name}'"
