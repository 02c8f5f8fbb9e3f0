"""Two versions side by side: the first is in use, the second stands back until asked; both are removed without a trace."""

import os
import re
import zipfile
from pathlib import Path

import bpy
import harness as ui

SECOND = "bl_ext.second.glanz"


def main():
    repositories = bpy.context.preferences.extensions.repos
    repositories.new(name="Second", module="second", source="USER")
    yield 0.1
    with ui.context("VIEW_3D"):
        bpy.ops.extensions.package_install_files(filepath=str(newer()), repo="second", enable_on_install=True)
    assert {ui.package, SECOND} <= set(bpy.context.preferences.addons.keys())
    ui.open_file("cornell_box")
    bpy.context.scene.render.resolution_x = bpy.context.scene.render.resolution_y = 32
    bpy.context.scene.glanz.samples = 1
    assert in_use() == ui.package
    first = yield from picture()
    bpy.ops.preferences.addon_disable(module=ui.package)
    bpy.ops.preferences.addon_disable(module=SECOND)
    bpy.ops.preferences.addon_enable(module=SECOND)
    assert in_use() == SECOND
    ui.redraw()
    assert ((yield from picture()) == first).all()
    bpy.ops.preferences.addon_enable(module=ui.package)
    assert in_use() == SECOND
    ui.show_preferences()
    yield 0.3
    ui.shot("first_stands_back")
    yield from removed(repositories)


def removed(repositories):
    """The second is removed while its engine is the one in use, after it rendered; the first takes over, and renders."""
    folder = Path(repositories["Second"].directory, "glanz")
    assert folder.exists()
    bpy.ops.extensions.package_uninstall(repo_index=repositories.find("Second"), pkg_id="glanz")
    ui.redraw()
    yield 0.2
    assert not folder.exists()
    assert in_use() == ""
    assert SECOND not in bpy.context.preferences.addons
    bpy.ops.preferences.addon_disable(module=ui.package)
    bpy.ops.preferences.addon_enable(module=ui.package)
    assert in_use() == ui.package
    ui.redraw()
    yield from picture()


def newer():
    """The zip with a higher version in its manifest."""
    path = ui.out / "newer.zip"
    with zipfile.ZipFile(os.environ["GLANZ_ZIP"]) as source, zipfile.ZipFile(path, "w") as target:
        for member in source.infolist():
            data = source.read(member)
            if member.filename.endswith("blender_manifest.toml"):
                data = re.sub(rb"(?m)^version = .*$", b'version = "99.0.0"', data)
            target.writestr(member, data)
    return path


def in_use():
    """The module whose panels are there."""
    panel = getattr(bpy.types, "GLANZ_RENDER_PT_sampling", None)
    return panel.__module__.removesuffix(".addon.panels") if panel else ""


def picture():
    """The Render Result of F12."""
    render = ui.start_render("NONE")
    yield lambda: render.done, 60
    assert render.finished
    return ui.saved_result()
