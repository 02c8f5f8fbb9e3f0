"""Everything that Glanz renders can be edited while Glanz is the engine."""

from types import SimpleNamespace

import bpy
import pytest

from glanz.addon import builtin_panels, light_panels, panels, pass_panels, passes, properties, requirements_panel
from glanz.tests.addon import blender

OWN = {panel.__name__: panel for module in (panels, light_panels, pass_panels, requirements_panel) for panel in module._CLASSES}


class Layout:
    """Stands for a layout: remembers what was drawn, refuses properties that do not exist."""

    def __init__(self):
        self.drawn = []

    def prop(self, owner, name, **options):
        assert name in owner.bl_rna.properties, f"{owner} has no property {name}"
        self.drawn.append(name)

    def prop_search(self, owner, name, *source, **options):
        self.prop(owner, name)

    def template_list(self, list_type, ui_id, owner, name, active_owner, active, **options):
        assert hasattr(bpy.types, list_type)
        self.prop(owner, name)
        self.prop(active_owner, active)

    def label(self, **options):
        self.drawn.append(options["text"])

    def template_node_view(self, tree, node, socket):
        assert socket in node.inputs.values()
        self.drawn.append(socket.identifier)

    def separator(self):
        pass

    def operator(self, idname, **options):
        self.drawn.append(idname)

    def column(self, **options):
        return self

    row = column


def _context(ob=None):
    scene = bpy.context.scene
    light = ob.data if ob and ob.type == "LIGHT" else None
    camera = ob.data if ob and ob.type == "CAMERA" else None
    layer = bpy.context.view_layer
    region = {"region": SimpleNamespace(width=400), "preferences": bpy.context.preferences}
    shown = region | {"light": light, "camera": camera, "material": getattr(ob, "active_material", None), "world": scene.world}
    return SimpleNamespace(engine=scene.render.engine, scene=scene, view_layer=layer, object=ob, **shown)


def _drawn(name, ob=None):
    """What the panel draws; it is polled first."""
    context, kind = _context(ob), OWN[name]
    assert kind.poll(context)
    panel = SimpleNamespace(layout=Layout(), **{a: getattr(kind, a) for a in ("list_type", "what", "about") if hasattr(kind, a)})
    panel.column = lambda: panels.GlanzPanel.column(panel)
    kind.draw(panel, context)
    return panel.layout.drawn


def test_settings_are_drawn():
    panels_of_render = ("sampling", "viewport", "light_paths", "film", "motion_blur", "performance", "requirements")
    names = []
    for integrator in ("path", "distributed", "whitted_phong"):
        bpy.context.scene.glanz.integrator = integrator
        names += [name for panel in panels_of_render for name in _drawn(f"GLANZ_RENDER_PT_{panel}")]
    own = {name for name in bpy.context.scene.glanz.bl_rna.properties.keys() if name not in ("rna_type", "name")}  # noqa: SIM118
    assert own <= set(names)
    assert {"threads", "threads_mode"} <= set(names)


@pytest.mark.parametrize(
    ("integrator", "names"),
    [("path", set()), ("distributed", {"branches", "min_contribution"}), ("whitted_phong", {"min_contribution", "light_falloff"})],
)
def test_settings_of_another_integrator_are_not_drawn(integrator, names):
    bpy.context.scene.glanz.integrator = integrator
    assert set(_drawn("GLANZ_RENDER_PT_light_paths")) == {"max_depth", "max_transparent", "clamp_direct", "clamp_indirect"} | names


def test_panoramas_can_be_edited():
    ob = blender.add_camera(type="PANO")
    ranges = {"latitude_min", "latitude_max", "longitude_min", "longitude_max"}
    assert set(_drawn("GLANZ_CAMERA_PT_panorama", ob)) == {"panorama_type", *ranges}
    ob.data.type = "ORTHO"
    assert not OWN["GLANZ_CAMERA_PT_panorama"].poll(_context(ob))


def test_passes_are_drawn():
    drawn = _drawn("GLANZ_VIEWLAYER_PT_passes")
    assert sorted(drawn) == sorted({row.flag.rpartition(".")[2] for row in passes.TABLE.values() if row.flag})
    assert {"use_pass_z", "use_pass_glossy_direct", "use_pass_sample_count"} <= {*drawn}
    assert "material_override" in _drawn("GLANZ_VIEWLAYER_PT_override")


def test_what_passes_are_made_of_is_drawn():
    assert _drawn("GLANZ_VIEWLAYER_PT_cryptomatte")[-1] == "pass_cryptomatte_depth"
    blender.set_world((1, 1, 1))
    ob = blender.add_plane()
    ob.data.materials.append(bpy.data.materials.new("A"))
    for name, expected in (
        ("GLANZ_OBJECT_PT_in_passes", ["pass_index", "lightgroup"]),
        ("GLANZ_MATERIAL_PT_in_passes", ["pass_index"]),
        ("GLANZ_WORLD_PT_in_passes", ["lightgroup", "distance", "start", "depth", "falloff"]),
        ("GLANZ_VIEWLAYER_PT_aovs", ["aovs", "active_aov_index", "scene.view_layer_add_aov", "scene.view_layer_remove_aov"]),
        (
            "GLANZ_VIEWLAYER_PT_light_groups",
            ["lightgroups", "active_lightgroup_index", "scene.view_layer_add_lightgroup", "scene.view_layer_remove_lightgroup"],
        ),
    ):
        assert _drawn(name, ob) == expected


def test_which_rays_see_what_can_be_edited():
    kinds = ["camera", "diffuse", "glossy", "transmission"]
    of_objects = [f"visible_{kind}" for kind in kinds]
    assert _drawn("GLANZ_OBJECT_PT_ray_visibility", blender.add_plane()) == [*of_objects, "visible_shadow", "is_holdout"]
    lamp = blender.link("Light", bpy.data.lights.new("Light", "POINT"))
    assert _drawn("GLANZ_OBJECT_PT_ray_visibility", lamp) == of_objects
    assert not OWN["GLANZ_OBJECT_PT_ray_visibility"].poll(_context(blender.add_camera()))
    assert not OWN["GLANZ_WORLD_PT_ray_visibility"].poll(_context())
    blender.set_world((1, 1, 1))
    assert _drawn("GLANZ_WORLD_PT_ray_visibility") == kinds


@pytest.mark.parametrize("name", [name for name, panel in OWN.items() if panel.about])
def test_panels_hide_where_there_is_nothing_that_they_are_about(name):
    assert not OWN[name].poll(_context())


@pytest.mark.parametrize(
    ("kind", "names"),
    [
        ("POINT", {"shadow_soft_size", "use_soft_falloff"}),
        ("SPOT", {"shadow_soft_size", "spot_size", "spot_blend", "characteristic"}),
        ("SUN", {"angle"}),
        ("AREA", {"shape", "size", "spread"}),
    ],
)
def test_lights_can_be_edited(kind, names):
    ob = blender.link("Light", bpy.data.lights.new("Light", kind))
    drawn = _drawn("GLANZ_LIGHT_PT_light", ob)
    assert names | {"type", "energy", "color", "visible_camera"} <= set(drawn)
    assert "size_y" not in drawn
    if kind == "AREA":
        ob.data.shape = "ELLIPSE"
        assert "size_y" in _drawn("GLANZ_LIGHT_PT_light", ob)


def test_what_a_light_shines_through_can_be_edited():
    ob = blender.link("Light", bpy.data.lights.new("Light", "POINT"))
    if ob.data.node_tree is None:
        assert _drawn("GLANZ_LIGHT_PT_nodes", ob) == ["use_nodes"]
        ob.data.use_nodes = True
    assert _drawn("GLANZ_LIGHT_PT_nodes", ob) == ["Surface"]
    ob.data.node_tree.nodes.clear()
    assert _drawn("GLANZ_LIGHT_PT_nodes", ob) == ["There is no Light Output"]


def test_a_spot_shows_the_cone_or_the_exponent():
    ob = blender.link("Light", bpy.data.lights.new("Light", "SPOT"))
    assert "exponent" not in _drawn("GLANZ_LIGHT_PT_light", ob)
    ob.data.glanz.characteristic = "COSINE"
    drawn = _drawn("GLANZ_LIGHT_PT_light", ob)
    assert {"exponent", "shadow_soft_size"} <= set(drawn)
    assert not {"spot_size", "spot_blend"} & set(drawn)


def test_the_lectures_parameters_can_be_edited():
    """What the way through a body needs is drawn where light gets in."""
    ob = blender.add_plane()
    assert not OWN["GLANZ_MATERIAL_PT_lecture"].poll(_context(ob))
    ob.data.materials.append(bpy.data.materials.new("Ball"))
    opaque = ["k_a", "k_d", "k_s", "exponent", "normalisation", "k_r", "k_t"]
    assert _drawn("GLANZ_MATERIAL_PT_lecture", ob) == opaque
    ob.data.materials[0].glanz.k_t = (0, 0.5, 0)
    drawn = _drawn("GLANZ_MATERIAL_PT_lecture", ob) + _drawn("GLANZ_MATERIAL_PT_medium", ob)
    assert {"ior", "absorption_colour", "abbe"} <= set(drawn)
    ob.data.materials[0].glanz.is_sheet = True
    assert "ior" not in _drawn("GLANZ_MATERIAL_PT_lecture", ob)
    drawn += _drawn("GLANZ_MATERIAL_PT_lecture", ob)
    own = {name for name in ob.data.materials[0].glanz.bl_rna.properties.keys() if name not in ("rna_type", "name")}  # noqa: SIM118
    assert own - {"use_lecture"} <= set(drawn)
    header = SimpleNamespace(layout=Layout())
    OWN["GLANZ_MATERIAL_PT_lecture"].draw_header(header, _context(ob))
    assert header.layout.drawn == ["use_lecture"]


def _tooltips(settings):
    """{name: (property, its tooltip, those of its choices among it)} of the settings of Glanz."""
    own = ((name, prop) for name, prop in settings.bl_rna.properties.items() if name not in ("rna_type", "name"))
    items = {"integrator": "INTEGRATORS", "sampler": "SAMPLERS", "pixel_filter": "FILTERS"}
    found = {}
    for name, prop in own:
        choices = [item[2] for item in properties.enum_items(items[name])] if name in items else []
        choices += [item.description for item in getattr(prop, "enum_items", ())]
        found[name] = prop, " ".join((prop.description, *choices))
    return found


UNITS = (
    "unit",
    "w/(m",
    "metre",
    "white",
    "pixel",
    "bounces",
    "from 0 to 1",
    "is 1 %",
    "seconds",
    "parts",
    "rays that",
    "shapes that",
    "sets that",
)
NUMBERS_OF_NO_UNIT = {"seed", "priority", "max_transparent"}


def test_tooltips_say_what_a_number_does_and_its_unit():
    """Counts say what they count."""
    scene, layer = bpy.context.scene, bpy.context.view_layer
    for owner in (bpy.data.materials.new("M"), bpy.data.lights.new("L", "SPOT"), scene, layer):
        for name, (prop, tooltip) in _tooltips(owner.glanz).items():
            assert len(prop.description) > 30, name
            is_number = prop.type in ("FLOAT", "INT") and name not in NUMBERS_OF_NO_UNIT
            assert not is_number or any(word in tooltip.lower() for word in UNITS), name


def test_tooltips_of_scenes_say_what_a_setting_costs():
    """In time or in memory, and be it nothing."""
    for owner in (bpy.context.scene, bpy.context.view_layer):
        for name, (_, tooltip) in _tooltips(owner.glanz).items():
            assert any(word in tooltip.lower() for word in ("time", "memory")), name


def test_what_is_inside_of_a_material_can_be_edited():
    ob = blender.add_plane()
    assert not OWN["GLANZ_MATERIAL_PT_medium"].poll(_context(ob))
    ob.data.materials.append(bpy.data.materials.new("Glass"))
    assert _drawn("GLANZ_MATERIAL_PT_medium", ob) == ["priority", "abbe"]


@pytest.mark.parametrize("name", OWN)
def test_panels_hide_from_other_engines(name):
    bpy.context.scene.render.engine = "BLENDER_WORKBENCH"
    assert not OWN[name].poll(_context(blender.link("Light", bpy.data.lights.new("Light", "POINT"))))


def test_a_problem_is_shown_only_where_there_is_one(monkeypatch):
    assert not OWN["GLANZ_RENDER_PT_problem"].poll(_context())
    monkeypatch.setattr("glanz.addon.backend._load", lambda: (None, "no Embree"))
    assert "no Embree" in " ".join(_drawn("GLANZ_RENDER_PT_problem"))


@pytest.mark.parametrize(
    "name",
    [
        "DATA_PT_camera",
        "DATA_PT_camera_dof",
        "DATA_PT_camera_dof_aperture",
        "DATA_PT_lens",
        "DATA_PT_preview",
        "EEVEE_MATERIAL_PT_context_material",
        "EEVEE_MATERIAL_PT_surface",
        "EEVEE_WORLD_PT_surface",
        "MATERIAL_PT_preview",
        "OBJECT_PT_visibility",
        "RENDER_PT_color_management",
        "RENDER_PT_format",
        "RENDER_PT_output",
        "WORLD_PT_context_world",
    ],
)
def test_blenders_panels_are_there(name):
    assert "GLANZ" in getattr(bpy.types, name).COMPAT_ENGINES


def test_panels_of_what_is_not_rendered_are_not_there():
    for panel in builtin_panels.shared_panels():
        assert "freestyle" not in panel.__name__.lower()
        assert "lightprobe" not in panel.__name__
