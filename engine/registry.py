"""Plug-ins are found by looking into their folder: to add one is to add a file."""

import importlib
import pkgutil


class Registry(dict):
    """Name -> plug-in class, in the order of their files' names.

    A plug-in is a class decorated with `@registry.add`; its `key` is the name that settings and files use, `label`
    and the first line of its docstring are what people read.
    """

    def __init__(self, kind):
        super().__init__()
        self.kind = kind

    def add(self, plugin):
        """Class decorator, outermost (a slotted dataclass is a new class)."""
        self[plugin.key] = plugin
        return plugin

    def __missing__(self, name):
        raise KeyError(f"unknown {self.kind} '{name}'; known: {', '.join(self)}")

    def discover(self, package, path):
        """Import every module of the plug-in folder `package` (its `__name__` and `__path__`)."""
        for module in sorted(module.name for module in pkgutil.iter_modules(path)):
            importlib.import_module(f"{package}.{module}")
        return self


class GraphRegistry(Registry):
    """Of plug-ins that are made of others of their kind."""

    def add(self, plugin):
        """See `Registry.add`; they are shown by their labels alone, as what they share would be written wherever it is used."""
        plugin.__repr__ = lambda self: f"<{self.label}>"
        return super().add(plugin)


BSDFS = Registry("BSDF")
LIGHTS = Registry("light")
CAMERAS = Registry("camera")
TEXTURES = GraphRegistry("texture")
SAMPLERS = Registry("sampler")
FILTERS = Registry("pixel filter")
INTEGRATORS = Registry("integrator")
PASSES = Registry("pass")
