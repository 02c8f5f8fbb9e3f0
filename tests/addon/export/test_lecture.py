"""The lecture's parameters of a material become the engine's, one by one."""

import math

import bpy
import pytest

from glanz.engine import BlinnPhong, Dielectric, Lambert, Mirror, Phong, PhongLecture, PhongTransmission, SceneError
from glanz.engine.interfaces import albedo_of
from glanz.engine.scene.validate import validate
from glanz.tests import helpers as h
from glanz.tests.addon import blender


def lecture(**values):
    """A material that goes by the lecture; black but for `values`."""
    material = bpy.data.materials.new("Ball")
    black = dict.fromkeys(("k_a", "k_d", "k_s", "k_r", "k_t"), (0, 0, 0))
    for name, value in {"use_lecture": True, **black, **values}.items():
        setattr(material.glanz, name, value)
    return material


def exported(material):
    """(engine material, warnings)."""
    plane = blender.add_plane()
    plane.data.materials.append(material)
    scene, warnings = blender.export()
    return next(o for o in scene.objects if o.name == plane.name).materials[0], warnings


def test_nodes_count_unless_the_lecture_is_asked_for():
    material = blender.new_material("Ball", "ShaderNodeBsdfDiffuse", Color=(0.1, 0.2, 0.3, 1))
    assert exported(material)[0].lobes[0].reflectance == pytest.approx((0.1, 0.2, 0.3))
    material.glanz.use_lecture = True
    material.glanz.k_d, material.glanz.k_s = (0.4, 0.5, 0.6), (0, 0, 0)
    (lobe,) = blender.export()[0].objects[0].materials[0].lobes
    assert type(lobe) is Lambert
    assert lobe.reflectance == pytest.approx((0.4, 0.5, 0.6))


def test_colours_and_exponent():
    material, warnings = exported(lecture(k_a=(0.1, 0.2, 0.3), k_d=(0.3, 0.2, 0.1), k_s=(0.2, 0.3, 0.4), exponent=50))
    assert warnings == ()
    assert material.ambient == pytest.approx((0.1, 0.2, 0.3))
    diffuse, glossy = material.lobes
    assert diffuse.reflectance == pytest.approx((0.3, 0.2, 0.1))
    assert glossy.reflectance == pytest.approx((0.2, 0.3, 0.4))
    assert glossy.exponent == 50
    assert material.medium is None


@pytest.mark.parametrize("bsdf", [Phong, PhongLecture, BlinnPhong])
def test_the_highlight_has_three_normalisations(bsdf):
    material, _ = exported(lecture(k_s=(0.5, 0.5, 0.5), normalisation=bsdf.key))
    assert [type(lobe) for lobe in material.lobes] == [bsdf]


def test_reflection_alone_is_a_mirror():
    (lobe,) = exported(lecture(k_r=(0.9, 0.8, 0.7)))[0].lobes
    assert type(lobe) is Mirror
    assert lobe.reflectance == pytest.approx((0.9, 0.8, 0.7))


def test_transmission_is_glass_with_constants():
    values = {"k_r": (0.1, 0.1, 0.1), "k_t": (0.8, 0.7, 0.6), "ior": 1.33, "abbe": 55}
    (lobe,) = exported(lecture(**values))[0].lobes
    assert type(lobe) is Dielectric
    assert lobe.reflectance == pytest.approx((0.1, 0.1, 0.1))
    assert lobe.transmittance == pytest.approx((0.8, 0.7, 0.6))
    assert lobe.ior == pytest.approx(1.33)
    assert lobe.abbe == 55
    assert not lobe.is_fresnel


def test_a_sheet_scatters_what_passes_and_has_no_inside():
    values = {"k_r": (0.1, 0.1, 0.1), "k_t": (0.8, 0.7, 0.6), "is_sheet": True, "sheet_exponent": 12, "absorption_colour": (0.5, 0.5, 0.5)}
    material, warnings = exported(lecture(**values))
    assert warnings == ()
    mirror, sheet = material.lobes
    assert (type(mirror), type(sheet)) == (Mirror, PhongTransmission)
    assert sheet.transmittance == pytest.approx((0.8, 0.7, 0.6))
    assert sheet.exponent == 12
    assert material.medium is None


def test_the_colour_at_a_distance_is_what_is_left():
    """exp(-sigma 0.5 m) is the colour."""
    values = {"k_t": (1, 1, 1), "absorption_colour": (1, 0.5, 0.25), "absorption_distance": 0.5, "priority": 2}
    medium = exported(lecture(**values))[0].medium
    assert [math.exp(-0.5 * c) for c in medium.absorption] == pytest.approx((1, 0.5, 0.25))
    assert medium.priority == 2
    assert exported(lecture(k_t=(1, 1, 1)))[0].medium is None
    black = exported(lecture(**(values | {"absorption_colour": (0, 1, 1)})))[0].medium
    assert black.absorption[0] > 1e20
    assert black.absorption[1:] == (0, 0)


def test_what_is_opaque_has_no_inside():
    """Light does not get in, so what is left of it does not matter."""
    assert exported(lecture(k_d=(1, 1, 1), absorption_colour=(0.5, 0.5, 0.5), priority=1))[0].medium is None


@pytest.mark.parametrize(
    ("normalisation", "total", "words"), [("phong", 1.1, "k_d + k_s + k_r"), ("phong_lecture", 1.15, "k_s (n + 2) / (n + 1)")]
)
def test_too_much_light_is_darkened_and_named_with_its_sum(normalisation, total, words):
    """n = 9: the lecture's highlight counts 11 / 10."""
    values = {"k_d": (0.4, 0.1, 0.1), "k_s": (0.5, 0.1, 0.1), "k_r": (0.2, 0, 0), "exponent": 9, "normalisation": normalisation}
    material, warnings = exported(lecture(**values))
    assert words in warnings[0]
    assert f"is {total:g}, more than 1: material 'Ball'" in warnings[0]
    assert "darkened: material 'Ball'" in warnings[1]
    assert sum(albedo_of(lobe)[0] for lobe in material.lobes) == pytest.approx(1)
    assert material.lobes[0].reflectance[0] == pytest.approx(0.4 / total)


@pytest.mark.parametrize("values", [{"exponent": float("nan")}, {"k_t": (1, 1, 1), "ior": float("nan")}])
def test_what_is_not_a_number_is_refused_by_name(values):
    """Below its range Blender stops the slider; NaN gets past it."""
    material, _ = exported(lecture(k_s=(0.1, 0.1, 0.1), **values))
    with pytest.raises(SceneError, match="material 'Ball'"):
        validate(h.scene([h.thing(h.quad(), material)]), h.settings())


@pytest.mark.parametrize(("name", "least"), [("exponent", 0), ("ior", 1e-3), ("absorption_distance", 1e-6)])
def test_senseless_numbers_cannot_be_typed(name, least):
    material = lecture(**{name: -1})
    assert getattr(material.glanz, name) == pytest.approx(least)


def test_a_saved_picture_shows_the_illumination_model(tmp_path):
    """k_a I_L + k_d I_L (n . l) + k_s I_L (r . v)^n with I_L = I / d^2 on a plane seen from above, at 4 pixels, to 0.2 %."""
    blender.add_camera(location=(0, 0, 10), width=99, height=99, type="ORTHO", ortho_scale=6.6)
    blender.add_plane(size=20).data.materials.append(lecture(k_a=(0.1, 0, 0), k_d=(0.3, 0.4, 0), k_s=(0.4, 0.2, 0.5), exponent=3))
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy, lamp.shadow_soft_size = 4 * math.pi * 100, 0
    blender.link("Lamp", lamp, (0, 0, 2))
    settings = bpy.context.scene.glanz
    settings.integrator, settings.samples, settings.pixel_filter = "whitted_phong", 16, "box"
    image = next(iter(blender.read_exr(blender.render(tmp_path / "a.exr")).values()))
    for column in (49, 64, 79, 94):
        cos = 2 / math.hypot(6.6 / 99 * (column - 49), 2)
        I_L = 100 / 4 * cos**2
        truth = [a * I_L + d * I_L * cos + s * I_L * cos**3 for a, d, s in zip((0.1, 0, 0), (0.3, 0.4, 0), (0.4, 0.2, 0.5))]
        assert image[49, column, :3] == pytest.approx(truth, rel=2e-3)


def test_a_saved_picture_shows_a_lamp_through_a_sheet(tmp_path):
    """k_t (n + 2) / (2 pi) (-v . l)^n I cos / d^2 of a lamp below a sheet that is seen from above, at 4 pixels, to 0.5 %."""
    blender.add_camera(location=(0, 0, 10), width=99, height=99, type="ORTHO", ortho_scale=6.6)
    blender.add_plane(size=20).data.materials.append(lecture(k_t=(0.9, 0.6, 0.3), is_sheet=True, sheet_exponent=3))
    lamp = bpy.data.lights.new("Lamp", "POINT")
    lamp.energy, lamp.shadow_soft_size = 4 * math.pi * 100, 0
    blender.link("Lamp", lamp, (0, 0, -2))
    settings = bpy.context.scene.glanz
    settings.max_depth, settings.samples, settings.pixel_filter = 0, 16, "box"
    image = next(iter(blender.read_exr(blender.render(tmp_path / "a.exr")).values()))
    for column in (49, 64, 79, 94):
        cos = 2 / math.hypot(6.6 / 99 * (column - 49), 2)
        seen = 5 / (2 * math.pi) * cos**3 * 100 / 4 * cos**3
        assert image[49, column, :3] == pytest.approx([k_t * seen for k_t in (0.9, 0.6, 0.3)], rel=5e-3)


def test_settings_survive_saving_and_loading(tmp_path):
    lecture(k_d=(0.25, 0.5, 0.75), exponent=7, normalisation="blinn_phong", absorption_distance=0.25).use_fake_user = True
    path = str(tmp_path / "a.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.read_homefile(use_factory_startup=True, use_empty=True)
    bpy.ops.wm.open_mainfile(filepath=path)
    settings = bpy.data.materials["Ball"].glanz
    assert settings.use_lecture
    assert tuple(settings.k_d) == (0.25, 0.5, 0.75)
    assert (settings.exponent, settings.normalisation, settings.absorption_distance) == (7, "blinn_phong", 0.25)
