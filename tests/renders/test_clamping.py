"""Clamping is off, cuts what is above a limit and nothing else, and says what it took away (catalogue H10)."""

import numpy as np
import pytest

from glanz.engine import SceneError, Settings, render_image
from glanz.engine.io.checkpoint import Checkpoint
from glanz.engine.rendering import gathered, render
from glanz.engine.wavefront.clamping import ClampedFilm
from glanz.tests import helpers as h, scenes

SETTINGS = {"width": 16, "height": 12, "samples": 16, "max_depth": 4}
LIGHT = ("Combined", "Diffuse Direct", "Diffuse Indirect")


def room(emission=10.0):
    """The inside of a closed box with a lamp on its ceiling, and colours."""
    lamp = h.thing(h.quad((0, 0, 0.95), (0.5, 0, 0), (0, -0.5, 0), name="lamp"), h.lambert(0.0, "lamp", (emission, emission / 2, 0.0)))
    walls = h.thing(h.box((-1, -1, -1), (1, 1, 1)), h.lambert((0.8, 0.7, 0.6)))
    return h.scene([walls, lamp], camera=h.PerspectiveCamera.look_at((-0.8, -0.7, 0.2), (0.6, 0.5, 0.1), fov=1.2))


def rendered(scene, **changes):
    return render_image(scene, h.settings(**SETTINGS | changes))


def mean(image, key="Combined"):
    return image.passes[key][..., :3].mean(dtype=np.float64)


def test_light_is_not_clamped_unless_it_is_asked_for():
    """Limits that nothing reaches change no bit, and say nothing."""
    plain, high = rendered(scenes.everything()), rendered(scenes.everything(), clamp_direct=1e6, clamp_indirect=1e6)
    assert (Settings().clamp_direct, Settings().clamp_indirect) == (0, 0)
    assert h.same_bits(plain.passes["Combined"], high.passes["Combined"])
    assert plain.warnings == high.warnings == () and "glanz.reached.clamped" not in high.metadata


def test_what_is_seen_itself_keeps_its_colour():
    """Emission (10, 5, 0) by a limit of 3: (3, 1.5, 0), to float32."""
    lamp = h.thing(h.quad((0, 0, 0), (99, 0, 0), (0, 99, 0)), h.lambert(0.0, "lamp", (10.0, 5.0, 0.0)))
    image = rendered(h.scene([lamp], camera=h.PerspectiveCamera.look_at((0, 0, 1), (0, 0.1, 0), fov=0.5)), clamp_direct=3.0)
    assert np.abs(image.passes["Combined"][..., :3] - (3, 1.5, 0)).max() <= 1e-6
    assert float(image.metadata["glanz.reached.clamped"]) == pytest.approx(0.7, rel=1e-3)


@pytest.mark.parametrize("integrator", ["path", "path_blind", "distributed", "whitted"])
@pytest.mark.parametrize("limits", [(0.5, 0.0), (0.0, 0.05), (1.0, 0.1)], ids=str)
def test_the_share_that_is_told_is_what_the_picture_lacks(integrator, limits):
    """By the same paths, of which one and all count alike by the box filter: equal to 5e-4 of it, as it is told to four digits."""
    changes = dict(zip(("clamp_direct", "clamp_indirect"), limits, strict=True))
    plain, clamped = rendered(room(), integrator=integrator), rendered(room(), integrator=integrator, **changes)
    lacking = 1 - mean(clamped) / mean(plain)
    is_met = lacking > 0.01 or (integrator == "whitted" and not limits[0])
    assert is_met and abs(float(clamped.metadata.get("glanz.reached.clamped", 0)) - lacking) <= 5e-4 * max(lacking, 0.01)
    assert (clamped.passes["Combined"][..., :3] <= plain.passes["Combined"][..., :3] * (1 + 1e-6)).all()


def test_direct_and_indirect_light_have_limits_of_their_own():
    """What is beyond the limit of the one leaves all bits of the other; parts still add up to the picture."""
    plain = rendered(room(), passes=(*LIGHT, "Diffuse Color"))
    direct, indirect = (rendered(room(), passes=(*LIGHT, "Diffuse Color"), **{name: 0.05}) for name in ("clamp_direct", "clamp_indirect"))
    assert h.same_bits(plain.passes["Diffuse Indirect"], direct.passes["Diffuse Indirect"])
    assert h.same_bits(plain.passes["Diffuse Direct"], indirect.passes["Diffuse Direct"])
    assert mean(direct, "Diffuse Direct") < 0.5 * mean(plain, "Diffuse Direct")
    assert mean(indirect, "Diffuse Indirect") < 0.9 * mean(plain, "Diffuse Indirect")


def test_a_sample_is_never_brighter_than_its_contributions_allow():
    """By one path of two surfaces after the lamp is cut: two contributions at most, each within the limit."""
    image = rendered(room(1e6), samples=1, max_depth=2, clamp_direct=0.25, clamp_indirect=0.125)
    assert 0.25 <= image.passes["Combined"][..., :3].max() <= (0.25 * 3 + 0.125 * 2) * (1 + 1e-6)


def test_a_limit_that_is_passed_on_to_the_wrong_light_is_noticed(monkeypatch):
    """The mutant: the limits are mixed up."""
    init = ClampedFilm.__init__

    def swapped(self, *others, limits, **more):
        init(self, *others, limits=limits[::-1], **more)

    monkeypatch.setattr(ClampedFilm, "__init__", swapped)
    with pytest.raises(AssertionError):
        test_direct_and_indirect_light_have_limits_of_their_own()


@pytest.mark.parametrize("power", [1e-30, 1.0, 1e30])
def test_it_is_in_proportion_at_every_power(power):
    """Limits that grow with the lamp take the same share away."""
    one, other = (rendered(room(10 * p), clamp_direct=0.5 * p, clamp_indirect=0.05 * p) for p in (1.0, power))
    shares = [float(image.metadata["glanz.reached.clamped"]) for image in (one, other)]
    assert shares[1] == pytest.approx(shares[0], rel=1e-3)


def test_it_says_how_much_darker_the_picture_is():
    image = rendered(room(), clamp_direct=0.5)
    share = 100 * float(image.metadata["glanz.reached.clamped"])
    assert image.warnings == (f"clamping has taken away {share:.2g} % of the light: the picture is darker than the scene by so much",)
    assert (image.metadata["glanz.clamp_direct"], image.metadata["glanz.clamp_indirect"]) == ("0.5", "0")


def test_a_render_that_goes_on_tells_of_all_that_was_taken_away(tmp_path):
    settings = h.settings(**SETTINGS | {"tile_size": 0, "clamp_direct": 0.5})
    _, _, whole = gathered(render(room(), settings, (4, 8)), settings)
    checkpoint = Checkpoint(tmp_path / "a.checkpoint", room(), settings, 1e-6)
    for progress in render(room(), settings, (4, 8), checkpoint):
        if progress.reached.samples == 8:
            break
    _, _, reached = gathered(render(room(), settings, (4, 8), Checkpoint(tmp_path / "a.checkpoint", room(), settings, 1e-6)), settings)
    assert reached.clamped == pytest.approx(whole.clamped, rel=1e-12) and whole.clamped > 0.1


@pytest.mark.parametrize("name", ["clamp_direct", "clamp_indirect"])
@pytest.mark.parametrize("value", [-1.0, np.inf, np.nan, "much", True])
def test_a_limit_is_a_radiance(name, value):
    with pytest.raises(SceneError, match=f"setting {name} is .* W m\\^-2 sr\\^-1, allowed: from 0"):
        Settings(**{name: value})
