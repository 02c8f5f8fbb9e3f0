"""What can go wrong, as exceptions that name the cause and the cure."""


class GlanzError(Exception):
    """Base of every error that Glanz raises on purpose; its text is one line, fit for a user."""


class SceneError(GlanzError):
    """A scene or setting that cannot be rendered; the text names the object and the value."""


class FileError(GlanzError):
    """A file that cannot be read or written; the text names the path and the cause."""


class AccelError(GlanzError):
    """Input that Embree would answer with a crash, a hang or a lie."""
