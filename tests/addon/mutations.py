"""Random .blend files: a scene with one of everything, its properties set to their limits, beyond them and to numbers that are none.

What there is to set is asked of Blender, so that what it, or Glanz, has new takes part. Each file has a seed of its own: to see one again,

    python -m glanz.tests.addon.mutations SEED NUMBER

builds the file NUMBER of SEED, says what was set, and renders it.
"""

import faulthandler
import math
import os
import random
import sys
import tempfile
import warnings
from functools import cache
from pathlib import Path

import bpy
import numpy as np

import glanz
from glanz.tests.addon import blender
from glanz.tests.addon.export import trees

HANGS = 60.0
"""Seconds, some hundred times what such a picture takes."""
SIZE = (8, 6)
MOST_CHANGES = 24
ODD = (0.0, -0.0, 1.0, -1.0, 0.5, 1e-30, 1e-6, 1e6, -1e6, 1e30, -3e38, math.nan, math.inf, -math.inf)
# What decides where files go and how large they are; what takes long by intent; what is another program's.
LEFT = {
    "Scene": {"sync_mode", "use_nodes"},
    # Blender 5.0 aborts when it evaluates such a curve that ends at NaN.
    "Curve": {"bevel_factor_start", "bevel_factor_end"},
    "RenderSettings": {
        *("resolution_x", "resolution_y", "resolution_percentage", "engine", "filepath", "use_file_extension", "use_overwrite"),
        *("use_placeholder", "use_sequencer", "use_freestyle", "display_mode", "stamp_font_size", "use_stamp", "use_stamp_note"),
        "use_lock_interface",
    },
}
FEW = ("samples", "branches", "motion_steps", "resolution_u", "resolution_v", "bevel_resolution", "levels", "render_levels", "count")
LEAST_AND_MOST = {
    **dict.fromkeys((*FEW, "render_resolution_u", "render_resolution_v", "adaptive_levels"), (1, 4)),
    "max_depth": (0, 16),
    "replicates": (0, 4),
    "time_limit": (0.0, 1.0),
    "motion_blur_steps": (1, 3),
}
# How they are drawn by editors.
_BASES = (bpy.types.ShaderNode, bpy.types.NodeSocket, bpy.types.ID)
LIGHTS = ("POINT", "SPOT", "SUN", "AREA")
MODIFIERS = ("SUBSURF", "ARRAY", "MIRROR", "SOLIDIFY", "WIREFRAME", "DISPLACE")


class Mutated:
    """The file `number` of `seed`, open, with a `log` of what was set."""

    def __init__(self, seed, number):
        self.rng = random.Random(f"{seed}:{number}")
        self.log = []
        bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
        glanz.register()
        bpy.context.scene.render.engine = "GLANZ"
        self._build()
        with warnings.catch_warnings(action="ignore"):
            for _ in range(self.rng.randint(1, MOST_CHANGES)):
                self._change()

    def _build(self):
        camera = blender.add_camera((0.5, -0.4, 5), *SIZE)
        camera.rotation_euler = (0.1, 0.1, 0.3)
        bpy.context.scene.glanz.samples = 2
        bpy.context.scene.glanz.max_depth = 3
        blender.set_world((0.5, 0.6, 0.7))
        self.things = [camera]
        for number, kind in enumerate(LIGHTS):
            self.things.append(blender.link(kind, bpy.data.lights.new(kind, kind), (number - 1.5, 1, 2)))
        self.things += [blender.add_plane("Floor", 6, (0, 0, -1)), blender.add_tetrahedron("Body")]
        curve = bpy.data.curves.new("Curve", "CURVE")
        spline = curve.splines.new("BEZIER")
        spline.bezier_points.add(1)
        spline.bezier_points[1].co = (1, 1, 1)
        curve.bevel_depth = 0.1
        self.things.append(blender.link("Curve", curve, (-1, 0, 0)))
        shaders, values = self._offered()
        for thing in self.things[-3:]:
            material = blender.new_material(f"Of {thing.name}", self.rng.choice(shaders))
            thing.data.materials.append(material)
            tree = material.node_tree
            texture = tree.nodes.new(self.rng.choice(values))
            fitting = [s for s in tree.nodes[0].inputs if s.type in ("RGBA", "VALUE") and s.enabled]
            if fitting and self.rng.random() < 0.6:
                tree.links.new(self.rng.choice([s for s in texture.outputs if s.enabled]), self.rng.choice(fitting))
        body = self.things[-2]
        for frame, place in ((0, -0.2), (2, 0.2)):
            body.location.x = place
            body.keyframe_insert("location", frame=frame)
        scene = bpy.context.scene
        for name, share in (("use_motion_blur", 0.3), ("use_multiview", 0.1), ("use_border", 0.1), ("use_persistent_data", 0.1)):
            setattr(scene.render, name, self.rng.random() < share)
        for layer in (scene.view_layers[0], scene.view_layers[0].glanz):
            for p in layer.bl_rna.properties:
                if p.identifier.startswith("use_pass_") and self.rng.random() < 0.2:
                    setattr(layer, p.identifier, True)

    @staticmethod
    @cache
    def _offered():
        found = trees.offered()
        # It has all the nodes that there are.
        bpy.data.materials.remove(bpy.data.materials["Scratch"])
        return found

    def _shading(self):
        """Nodes and their sockets."""
        for holder in (*bpy.data.materials, *bpy.data.worlds, *bpy.data.lights):
            for node in holder.node_tree.nodes if holder.node_tree else ():
                yield node
                yield from (s for s in node.inputs if hasattr(s, "default_value"))

    def _others(self):
        """Whatever else has properties to set."""
        scene = bpy.context.scene
        yield from (scene, scene.render, scene.glanz, scene.world, scene.world.mist_settings, scene.world.light_settings)
        yield from (scene.view_layers[0], scene.view_layers[0].glanz, scene.view_settings)
        for thing in self.things:
            yield from (thing, thing.data, *thing.modifiers)
        yield self.things[0].data.dof
        yield from self.things[-1].data.splines
        for holder in (*bpy.data.materials, *bpy.data.worlds, *bpy.data.lights, *bpy.data.cameras, *bpy.data.meshes, *bpy.data.objects):
            if getattr(holder, "glanz", None) is not None:
                yield holder.glanz
        yield from bpy.data.materials

    def _change(self):
        kind = self.rng.random()
        if kind < 0.05:
            return self._break_matrix()
        if kind < 0.1:
            return self._break_vertex()
        if kind < 0.15:
            thing, name = self.rng.choice(self.things[-3:]), self.rng.choice(MODIFIERS)
            self.log.append(f"{thing.name}: modifier {name}")
            return thing.modifiers.new(name, name)
        owners = list(self.rng.choice((self._shading, self._others))())
        # Each kind alike, or all would be sockets.
        chosen = self.rng.choice(sorted({type(owner).__name__ for owner in owners}))
        owner = self.rng.choice([owner for owner in owners if type(owner).__name__ == chosen])
        left = LEFT.get(chosen, set()).union(*(kind.bl_rna.properties.keys() for kind in _BASES if isinstance(owner, kind)))
        names = [p.identifier for p in owner.bl_rna.properties if self._can_set(p) and p.identifier not in left]
        return self._set(owner, self.rng.choice(names)) if names else None

    @staticmethod
    def _can_set(p):
        return not p.is_readonly and p.type in ("FLOAT", "INT", "BOOLEAN", "ENUM")

    def _set(self, owner, name):
        p = owner.bl_rna.properties[name]
        value = self._value(owner, p)
        if value is None:
            return
        try:
            setattr(owner, name, value)
        except (TypeError, ValueError, RuntimeError, AttributeError, OverflowError):
            return
        whose = getattr(owner.id_data, "name", "")
        self.log.append(f"{whose}: {type(owner).__name__} {getattr(owner, 'name', '')}.{name} = {value!r}")

    def _value(self, owner, p):
        if p.type == "ENUM":
            items = [item.identifier for item in (p.enum_items_static_ui or p.enum_items) if item.identifier] or [""]
            chosen = self.rng.choice(items)
            return {chosen} if p.is_enum_flag else chosen
        count = math.prod(n for n in getattr(p, "array_dimensions", ()) if n) if getattr(p, "is_array", False) else 0
        one = {"BOOLEAN": lambda: self.rng.random() < 0.5, "INT": lambda: self._whole(p), "FLOAT": lambda: self._number(p)}[p.type]
        if not count:
            return one()
        values = [one() for _ in range(count)]
        if p.type == "FLOAT" and self.rng.random() < 0.5:
            # One of them alone.
            values = np.asarray(getattr(owner, p.identifier), float).ravel().tolist()
            values[self.rng.randrange(len(values))] = one()
        size = p.array_dimensions[0]
        return [values[i : i + size] for i in range(0, count, size)] if p.array_dimensions[1] else values

    def _whole(self, p):
        low, high = LEAST_AND_MOST.get(p.identifier, (p.hard_min, p.hard_max))
        value = self.rng.choice((p.hard_min, p.hard_max, p.soft_min, p.soft_max, 0, 1, -1, 2, 7))
        return int(min(max(value, low), high))

    def _number(self, p):
        soft = self.rng.uniform(max(p.soft_min, -1e3), min(p.soft_max, 1e3))
        value = self.rng.choice((p.hard_min, p.hard_max, p.soft_min, p.soft_max, soft, soft, *ODD))
        if p.identifier in LEAST_AND_MOST:
            low, high = LEAST_AND_MOST[p.identifier]
            return min(max(value, low), high)
        return value

    def _break_matrix(self):
        thing, value = self.rng.choice(self.things), self.rng.choice(ODD)
        matrix = thing.matrix_world.copy()
        row, column = self.rng.randrange(3), self.rng.randrange(4)
        matrix[row][column] = value
        thing.matrix_world = matrix
        self.log.append(f"{thing.name}: matrix_world[{row}][{column}] = {value}")

    def _break_vertex(self):
        thing, value = self.rng.choice(self.things[-3:-1]), self.rng.choice(ODD)
        number, axis = self.rng.randrange(len(thing.data.vertices)), self.rng.randrange(3)
        thing.data.vertices[number].co[axis] = value
        self.log.append(f"{thing.name}: vertex {number}, {axis} = {value}")


def fault_of(folder):
    """What is wrong with how the open file renders; None: it gives a finite picture, or is refused by a reason for a user."""
    for path in Path(folder).iterdir():
        path.unlink()
    try:
        blender.render(Path(folder) / "a.exr")
    except RuntimeError as error:
        told = str(error)
        is_named = not any(sign in told for sign in ("Glanz failed", "cannot be exported", "out of memory", "Traceback"))
        return None if is_named else told
    # Each eye may have its own.
    faults = [_fault_in(path) for path in Path(folder).iterdir()]
    return next(filter(None, faults), None) if faults else "neither a file nor an error"


def _fault_in(path):
    for name, values in blender.read_exr(path).items():
        known = values[~np.isinf(values)] if "Confidence" in name or "Standard Error" in name else values
        if not np.isfinite(known).all():
            return f"{name} is not finite"
        if values.shape[1::-1] != SIZE and not bpy.context.scene.render.use_crop_to_border:
            return f"{name} has {values.shape[1]} x {values.shape[0]} px"
    return None


def run(seed, numbers):
    """Build and render the files `numbers` of `seed`; how many of them had faults, which are printed with how they came to be."""
    faults = 0
    with tempfile.TemporaryDirectory() as folder:
        for number in numbers:
            # Said before: it may be the last that is said.
            print(f"file {number} of seed {seed}", flush=True)
            faulthandler.dump_traceback_later(HANGS, exit=True)
            mutated = Mutated(seed, number)
            print("\n".join(mutated.log), flush=True)
            fault = fault_of(folder)
            faulthandler.cancel_dump_traceback_later()
            if fault:
                faults += 1
                print(f"FAULT of file {number} of seed {seed}: {fault}", flush=True)
    return faults


def main(seed, first, count=1):
    """The exit status: 1 where there was a fault."""
    faulthandler.enable()
    return int(run(int(seed), range(int(first), int(first) + int(count))) > 0)


if __name__ == "__main__":
    status = main(*sys.argv[1:])
    sys.stdout.flush()
    # After a render, bpy 4.2 crashes and bpy 4.5 hangs when Python ends.
    os._exit(status)
