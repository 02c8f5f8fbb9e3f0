"""embreex calls its own Embree, function by function, in a Blender that holds another one for all to see."""

import ctypes
import importlib
import os
import shutil
import sys
from pathlib import Path

import bpy
import harness as ui
import symbols


def main():
    if not sys.platform.startswith("linux"):
        print("only Linux binds functions of one name to the first library that has them")
        return
    yield 0.1
    accel = importlib.import_module(f"{ui.package}.engine.world.accel")
    rtcore, rtcore_scene, mesh_construction = accel._embreex()
    own = Path(rtcore_scene.__file__).parents[1]
    assert Path(bpy.utils.user_resource("EXTENSIONS")).resolve() in own.resolve().parents
    for module in (rtcore, rtcore_scene, mesh_construction):
        bound = symbols.bindings(module.__file__, "rtc")
        for function, path in sorted(bound.items()):
            print(f"{Path(module.__file__).name}: {function} -> {path}")
            assert path.startswith(f"{own.resolve()}/"), f"{function} is bound to {path}"
        print(f"measured: {len(bound)} functions of Embree in {Path(module.__file__).name.partition('.')[0]} are the wheel's own")
    assert {"rtcNewScene", "rtcIntersect1"} <= set(symbols.bindings(rtcore_scene.__file__, "rtc"))
    shared_buffers = importlib.import_module(f"{ui.package}.engine.world.shared_buffers")
    shares = shared_buffers.library_of(rtcore_scene).rtcSetSharedGeometryBuffer
    path = symbols.file_of(ctypes.cast(shares, ctypes.c_void_p).value, symbols.mappings())
    assert path.startswith(f"{own.resolve()}/"), f"meshes would be shared with {path}"
    tell_blenders(rtcore_scene)


def tell_blenders(rtcore_scene):
    """That this Blender can tell: the same library, loaded as Python loads any, is bound to what Blender holds."""
    try:
        everyones = ctypes.CDLL(None).rtcNewScene
    except AttributeError:
        print("measured: this Blender shows no Embree of its own to others")
        return
    blenders = symbols.file_of(ctypes.cast(everyones, ctypes.c_void_p).value, symbols.mappings())
    source = Path(rtcore_scene.__file__)
    copy = ui.out / "plain" / source.parent.name / source.name
    copy.parent.mkdir(parents=True)
    shutil.copy2(source, copy)
    for libraries in source.parents[1].glob("embreex*.libs"):
        (ui.out / "plain" / libraries.name).symlink_to(libraries)
    ctypes.CDLL(str(copy), os.RTLD_NOW)
    assert symbols.bindings(copy, "rtc")["rtcNewScene"] == blenders
    print(f"measured: loaded without care they are those of {blenders}")
