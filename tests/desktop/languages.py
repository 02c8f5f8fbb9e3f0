"""In a Blender that speaks German or Chinese, where new things have names in that language, pictures are those of an English one."""

import bpy
import harness as ui
import numpy as np
import views

LANGUAGES = ("en_US", "de_DE", "zh_HANS")


def main():
    found = {}
    for language in LANGUAGES:
        speak(language)
        names = build()
        render = ui.start_render()
        yield lambda render=render: render.done, 60
        assert render.finished and not render.cancelled
        yield 0.5
        ui.shot(f"f12_{language}")
        found[language] = names, ui.saved_result()
        yield from shown(language)
    english, picture = found["en_US"]
    assert 0.05 < picture[..., :3].mean() < 10 and picture[..., :3].std() > 0.05
    for language, (names, other) in found.items():
        translated = sum(a != b for a, b in zip(names, english))
        print(f"measured: {language}: {translated} of {len(names)} names are translated, such as {names[0]}")
        assert np.array_equal(picture, other), language
        assert (translated > len(names) / 2) == (language != "en_US"), names


def speak(language):
    view = bpy.context.preferences.view
    view.language = language
    view.use_translate_interface = view.use_translate_tooltips = view.use_translate_new_dataname = True


def build():
    """A new file, in which everything is made as users make it; the names that it all got."""
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True, load_ui=True)
    scene = bpy.context.scene
    scene.render.engine = "GLANZ"
    scene.render.resolution_x = scene.render.resolution_y = 64
    scene.glanz.samples, scene.glanz.viewport_samples, scene.render.preview_pixel_size = 4, 1, "8"
    with ui.context("VIEW_3D"):
        bpy.ops.object.camera_add(location=(0, -6, 2), rotation=(1.25, 0, 0))
        scene.camera = bpy.context.object
        bpy.ops.object.light_add(type="AREA", radius=2, location=(2, -2, 4))
        bpy.context.object.data.energy = 200
        bpy.ops.mesh.primitive_plane_add(size=20)
        plane = bpy.context.object
        bpy.ops.mesh.primitive_uv_sphere_add(location=(0, 0, 1))
        ball = bpy.context.object
        bpy.ops.world.new()
    scene.world = bpy.data.worlds[-1]
    for ob, fill in ((plane, chequered), (ball, grouped)):
        ob.data.materials.append(bpy.data.materials.new(bpy.app.translations.pgettext_data("Material")))
        if ob.active_material.node_tree is None:
            ob.active_material.use_nodes = True
        fill(ob.active_material.node_tree)
    trees = [*(owner.node_tree for owner in (*bpy.data.materials, *bpy.data.worlds)), *bpy.data.node_groups]
    return [node.name for tree in trees for node in tree.nodes] + [thing.name for thing in (*bpy.data.objects, *bpy.data.worlds)]


def chequered(tree):
    """Chequers with a rough half, found by coordinates, through a muted node and a reroute."""
    principled = next(node for node in tree.nodes if node.type == "BSDF_PRINCIPLED")
    names = ("TexCoord", "Mapping", "TexChecker", "ValToRGB", "Gamma")
    coordinates, mapping, chequer, ramp, muted = (tree.nodes.new(f"ShaderNode{name}") for name in names)
    muted.mute = True
    reroute = tree.nodes.new("NodeReroute")
    link(tree, coordinates, "UV", mapping, "Vector")
    link(tree, mapping, "Vector", chequer, "Vector")
    link(tree, chequer, "Color", muted, "Color")
    tree.links.new(muted.outputs[0], reroute.inputs[0])
    tree.links.new(reroute.outputs[0], socket(principled.inputs, "Base Color"))
    link(tree, chequer, "Fac", ramp, "Fac")
    link(tree, ramp, "Color", principled, "Roughness")


def grouped(tree):
    """Glass and a diffuse colour, mixed by noise in a group."""
    group = bpy.data.node_groups.new("Group", "ShaderNodeTree")
    group.interface.new_socket("Color", in_out="INPUT", socket_type="NodeSocketColor")
    group.interface.new_socket("Shader", in_out="OUTPUT", socket_type="NodeSocketShader")
    start, end = group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")
    mix, glass, diffuse, noise = (group.nodes.new(f"ShaderNode{name}") for name in ("MixShader", "BsdfGlass", "BsdfDiffuse", "TexNoise"))
    link(group, noise, "Fac", mix, "Fac")
    group.links.new(glass.outputs[0], mix.inputs[1])
    group.links.new(diffuse.outputs[0], mix.inputs[2])
    group.links.new(start.outputs[0], diffuse.inputs[0])
    group.links.new(mix.outputs[0], end.inputs[0])
    node = tree.nodes.new("ShaderNodeGroup")
    node.node_tree = group
    node.inputs[0].default_value = (0.1, 0.3, 0.8, 1)
    output = next(n for n in tree.nodes if n.type == "OUTPUT_MATERIAL")
    tree.links.new(node.outputs[0], socket(output.inputs, "Surface"))


def link(tree, start, output, end, to):
    tree.links.new(socket(start.outputs, output), socket(end.inputs, to))


def socket(sockets, identifier):
    return next(one for one in sockets if one.identifier == identifier)


def shown(language):
    """The rendered view beside the settings."""
    ui.area().type = "VIEW_3D"
    ui.shading("RENDERED")
    views.free_view("CAMERA")
    yield views.complete, views.SOON
    ui.shot(f"view_{language}")
    ui.shading("SOLID")
