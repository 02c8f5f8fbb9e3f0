"""What materials ask about objects: numbers that are the same all over an instance."""

import bpy
import numpy as np

from .hashes import unit_of, unit_of_hash, unit_of_name

_NONE = 2**31 - 1


def object_values(instance, names, depsgraph):
    """`Object.values` of a `DepsgraphObjectInstance`, of the `names` that are asked for and are not 0."""
    values = ((name, _value(instance, name, depsgraph)) for name in names)
    return tuple((name, value) for name, value in values if value is not None)


def _value(instance, name, depsgraph):
    if name in _OF_INSTANCES:
        return _OF_INSTANCES[name](instance)
    kind, _, rest = name.partition(" ")
    if kind == "particle":
        particle = _particle(instance)
        if rest == "random":
            return _number(unit_of(np.array([instance.persistent_id[0] if particle else 0]), np.zeros(1))[0])
        return particle and _OF_PARTICLES[rest](particle, instance, depsgraph.scene_eval)
    return _PROPERTIES[kind](instance, rest, depsgraph) if kind in _PROPERTIES else None


def _number(x):
    return (float(x),) * 3 + (1.0,)


def _vector(v):
    return (*map(float, v), *(0.0,) * (3 - len(v)), 1.0)


def _random(instance):
    # Blender numbers instances alone; what is but itself is known by its name.
    return unit_of_hash(instance.random_id % 2**32) if instance.is_instance else unit_of_name(instance.object.name)


_OF_INSTANCES = {
    # Instances wear the colour of who makes them.
    "colour": lambda instance: tuple(((instance.is_instance and instance.parent) or instance.object).color),
    "index": lambda instance: _number(instance.object.pass_index),
    "random": lambda instance: _number(_random(instance)),
    "instancer generated": lambda instance: _vector([0.5 * x - 0.5 for x in instance.orco]) if instance.is_instance else None,
    "instancer uv": lambda instance: _vector(instance.uv) if instance.is_instance else None,
}


def _particle(instance):
    system = instance.particle_system if instance.is_instance else None
    index = instance.persistent_id[0] if system else 0
    return system.particles[index] if system and 0 <= index < len(system.particles) else None


_OF_PARTICLES = {
    "index": lambda particle, instance, scene: _number(instance.persistent_id[0]),
    "age": lambda particle, instance, scene: _number(scene.frame_current + scene.frame_subframe - particle.birth_time),
    "lifetime": lambda particle, instance, scene: _number(particle.lifetime),
    "location": lambda particle, instance, scene: _vector(particle.location),
    "size": lambda particle, instance, scene: _number(particle.size),
    "velocity": lambda particle, instance, scene: _vector(particle.velocity),
    "angular velocity": lambda particle, instance, scene: _vector(particle.angular_velocity),
}


def _of_object(instance, name, depsgraph):
    return _property((instance.object, instance.object.data), name)


def _of_instancer(instance, name, depsgraph):
    if not instance.is_instance:
        return _of_object(instance, name, depsgraph)
    owners = instance.parent, instance.parent and instance.parent.data, instance.object, instance.object.data
    return _of_geometry(instance, name) or _property(owners, name)


def _of_geometry(instance, name):
    """The attribute that geometry nodes have given to an instance, as far as this version of Blender tells."""
    parent = instance.parent
    if getattr(parent, "data", None) is None or not hasattr(parent, "evaluated_geometry"):
        return None
    # The points live as long as the geometry does.
    geometry = parent.evaluated_geometry()
    points = geometry.instances_pointcloud()
    attribute = points and points.attributes.get(name)
    # The outermost of nested instances comes last.
    index = [i for i in instance.persistent_id if i != _NONE][-1:]
    if not attribute or not index or index[0] >= len(attribute.data):
        return None
    value = attribute.data[index[0]]
    return _four(next(getattr(value, prop) for prop in ("value", "vector", "color") if hasattr(value, prop)))


def _of_view_layer(instance, name, depsgraph):
    return _property((depsgraph.view_layer_eval, depsgraph.scene_eval, depsgraph.scene_eval.world), name)


_PROPERTIES = {"object": _of_object, "instancer": _of_instancer, "layer": _of_view_layer}


def _property(owners, name):
    """The custom property called `name`, or the one of Blender's at that path, of the first of `owners` that has it."""
    for owner in owners:
        if owner is None or not name:
            continue
        for path in (f'["{bpy.utils.escape_identifier(name)}"]', name):
            try:
                value = owner.path_resolve(path)
            except ValueError:
                continue
            found = _four(value)
            if found:
                return found
    return None


def _four(value):
    """A number, or an array of up to four, as four numbers; None for anything else."""
    if isinstance(value, (bool, int, float)):
        return _number(value)
    try:
        numbers = [float(x) for x in value]
    except (TypeError, ValueError):
        return None
    return (*numbers, *(0.0, 0.0, 0.0, 1.0)[len(numbers) :]) if 3 <= len(numbers) <= 4 else None
