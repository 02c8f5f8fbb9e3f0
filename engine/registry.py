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
        self.families = []

    def add(self, plugin):
        """Class decorator, outermost (a slotted dataclass is a new class)."""
        self[plugin.key] = plugin
        return plugin

    def add_family(self, family):
        """Class decorator of plug-ins whose names have parts that scenes choose: `family.of(name)` is the plug-in, None for other names."""
        self.families.append(family)
        return family

    def __missing__(self, name):
        found = next(filter(None, (family.of(name) for family in self.families)), None)
        if found is None:
            raise KeyError(f"unknown {self.kind} '{name}'; known: {self.known}")
        return found

    def __contains__(self, name):
        return super().__contains__(name) or any(family.of(name) for family in self.families)

    @property
    def known(self):
        """The names that there are, for people; of families, what they are like."""
        return ", ".join((*self, *(family.pattern for family in self.families)))

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
