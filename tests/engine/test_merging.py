"""Parts that were rendered apart are the picture that is rendered in one go (catalogue H4)."""

import itertools

import numpy as np
import pytest

from glanz.engine import SceneError, render_image, write_exr
from glanz.engine.io.exr import read_image
from glanz.engine.merging import Part, merged
from glanz.tests import helpers as h, scenes
from glanz.tests.renders.test_standard_error import lamp

PASSES = ("Combined", "Depth", "Normal", "Diffuse Color", "Diffuse Direct", "Sample Count", "CryptoObject00", "CryptoObject01")
SETTINGS = {"width": 24, "height": 20, "samples": 24, "max_depth": 2, "passes": PASSES}
RANGES = ((0, 5), (5, 16), (16, 24))


def parts_of(scene, ranges=RANGES, **changes):
    settings = h.settings(**SETTINGS | changes)
    return [Part.of(f"{first}.exr", render_image(scene, h.replaced(settings, sample_range=(first, end)))) for first, end in ranges]


@pytest.fixture(scope="module")
def parts():
    return parts_of(scenes.everything())


def test_parts_are_the_whole_in_any_order(parts):
    """Of 24 samples in three parts: to the rounding of their files, seven of 2^24."""
    whole = render_image(scenes.everything(), h.settings(**SETTINGS)).passes
    for order in itertools.permutations(parts):
        image = merged(order)
        assert not image.warnings
        assert image.metadata["glanz.sample_range"] == "0,24"
        assert list(image.passes) == list(whole)
        for key in ("Combined", "Depth", "Normal", "Diffuse Color", "Diffuse Direct", "Sample Count"):
            scale = np.abs(whole[key]).max(axis=-1, keepdims=True)
            assert (np.abs(image.passes[key] - whole[key]) <= 4e-7 * scale + 1e-7).all(), key


def test_what_covers_a_pixel_is_gathered_by_name(parts):
    """Every thing with the share that it has in the whole."""
    whole, image = render_image(scenes.everything(), h.settings(**SETTINGS)).passes, merged(parts)

    def shares(passes):
        pairs = np.concatenate([passes[key] for key in PASSES[-2:]], axis=-1).reshape(-1, 4, 2)
        return [{float(number): float(share) for number, share in pixel if share} for pixel in pairs]

    for one, other in zip(shares(whole), shares(image.passes)):
        assert one.keys() == other.keys()
        assert all(other[number] == pytest.approx(share, abs=1e-6) for number, share in one.items())


def test_a_mean_that_does_not_weigh_by_samples_is_noticed(parts, monkeypatch):
    monkeypatch.setattr(Part, "samples", property(lambda self: 8))
    with pytest.raises(AssertionError):
        test_parts_are_the_whole_in_any_order(parts)


def test_errors_of_independent_parts_add_up():
    """Of a picture whose truth is known: the stated against the true mean squared error of 4,096 pixels, as for one render."""
    scene, truth = lamp()
    changes = {"width": 64, "height": 64, "samples": 64, "max_depth": 0, "replicates": 8, "passes": ("Combined", "Standard Error")}
    image = merged(parts_of(scene, ((0, 24), (24, 64)), **changes))
    away = image.passes["Combined"][..., 0] - truth[0]
    stated = np.square(image.passes["Standard Error"][..., 0], dtype=np.float64).mean()
    assert stated == pytest.approx(np.square(away, dtype=np.float64).mean(), rel=0.15)


def test_what_is_missing_is_told(parts):
    image = merged(parts[::2])
    assert image.warnings == ("samples 5 to 15 are in no file",)
    assert image.metadata["glanz.sample_range"] == "13 of 0,24"
    with pytest.raises(SceneError, match=r"'a' does not say which samples it has: .* or has been merged already"):
        Part.of("a", image)


def test_files_give_back_what_is_merged(parts, tmp_path):
    image = merged(parts)
    write_exr(tmp_path / "a.exr", image)
    again = read_image(tmp_path / "a.exr")
    assert again.passes.keys() == image.passes.keys()
    assert all(h.same_bits(again.passes[key], image.passes[key]) for key in image.passes)
    assert image.metadata.items() <= again.metadata.items()


def changed(part, **facts):
    return Part.of(part.name, h.replaced(part.image, metadata=part.image.metadata | {f"glanz.{k}": v for k, v in facts.items()}))


def test_parts_of_other_pictures_are_refused_by_name(parts):
    one, two, _ = parts
    with pytest.raises(SceneError, match=r"'0\.exr' and '5\.exr' are no parts of one picture: seed '0' and '1'"):
        merged([one, changed(two, seed="1")])
    with pytest.raises(SceneError, match=r"'0\.exr' and '0\.exr' both have the samples 0 to 4"):
        merged([one, one])
    small = render_image(scenes.everything(), h.settings(**SETTINGS | {"width": 8, "sample_range": (5, 16)}))
    with pytest.raises(SceneError, match="24x20 and 8x20 pixels"):
        merged([one, Part.of("small", small)])
    fewer = h.replaced(two.image, passes={key: two.image.passes[key] for key in PASSES[:-1]})
    with pytest.raises(SceneError, match="only one of them has CryptoObject01"):
        merged([one, Part.of("fewer", fewer)])
    with pytest.raises(SceneError, match=r"'0\.exr' was ended before it had all of its samples"):
        changed(one, **{"reached.ended_by": "time"})
