"""Embree reads meshes where they lie only where the scene is found without doubt; what rays meet does not depend on it."""

import sys

import numpy as np
import pytest

from glanz.engine.errors import AccelError
from glanz.engine.world import accel as module, shared_buffers
from glanz.engine.world.accel import Accel
from glanz.tests import helpers as h
from glanz.tests.engine.world.test_accel import random_rays, random_triangles


def _made():
    rtcore, rtcore_scene, _ = module._embreex()
    device = rtcore.EmbreeDevice()
    return rtcore_scene.EmbreeScene(device, robust=True), device, rtcore_scene


@pytest.mark.parametrize("count", [1, 2, 1000])
def test_what_is_shared_is_met_as_what_is_copied(count, monkeypatch):
    vertices, triangles = random_triangles(count)
    o, d = random_rays(5_000)
    shared = Accel(vertices, triangles)
    monkeypatch.setattr(shared_buffers, "library_of", lambda module: None)
    copied = Accel(vertices, triangles)
    found, expected = shared.closest(o, d), copied.closest(o, d)
    for name in ("prim", "t", "u", "v"):
        assert h.same_bits(getattr(found, name), getattr(expected, name))
    limit = np.full(5_000, 1.0, np.float32)
    assert h.same_bits(shared.occluded(o, d, limit), copied.occluded(o, d, limit))
    assert (found.prim >= 0).any()


@pytest.mark.skipif(sys.platform == "win32", reason="Embree's functions are not found through embreex there")
def test_this_embreex_is_laid_out_as_is_known(monkeypatch):
    """Else all is copied, which takes longer and shows nowhere."""
    asked = []
    share = shared_buffers.share
    monkeypatch.setattr(shared_buffers, "share", lambda *arguments: asked.append(arguments) or share(*arguments))
    Accel(*random_triangles(3))
    assert len(asked) == 1


def test_no_pointer_is_read_from_what_is_laid_out_otherwise():
    scene, device, _ = _made()
    assert shared_buffers.scene_pointer(scene, device)
    assert scene.is_committed == 0

    class Other:
        __slots__ = ("a", "is_committed", "z")

    other = Other()
    other.is_committed = 0
    assert type(other).__basicsize__ == type(scene).__basicsize__
    assert shared_buffers.scene_pointer(scene, object()) is None
    assert shared_buffers.scene_pointer(other, device) is None
    assert shared_buffers.scene_pointer(object(), device) is None
    other.z = device  # now all but the number is where it should be
    assert shared_buffers.scene_pointer(other, device) is None


def test_functions_that_are_missing_are_no_library():
    import math

    assert shared_buffers.library_of(math) is None
    assert shared_buffers.library_of(sys.modules["glanz.engine"]) is None


@pytest.mark.parametrize("vertices", [np.zeros((4, 3)), np.zeros((4, 2), np.float32), np.zeros((3, 4), np.float32).T])
def test_arrays_of_another_form_are_not_shared(vertices):
    with pytest.raises(ValueError, match="arrays to share"):
        shared_buffers.share(None, None, vertices, np.zeros((1, 3), np.int32))


def test_errors_of_embree_are_told(monkeypatch):
    monkeypatch.setattr(shared_buffers, "share", lambda *arguments: 4)
    if sys.platform != "win32":
        with pytest.raises(AccelError, match="3 triangles: its error 4"):
            Accel(*random_triangles(3))


def test_embree_tells_of_what_it_cannot_share():
    """A number of bytes that is no multiple of four is refused by Embree itself."""
    scene, device, rtcore_scene = _made()
    library = shared_buffers.library_of(rtcore_scene)
    if library is None:
        pytest.skip("Embree's functions are not found through embreex here")
    module._embreex()[2].TriangleMesh(scene, np.zeros((1, 3), np.float32), np.zeros((1, 3), np.int32))
    memory = np.zeros(4 * 12 + 1, np.uint8)[1:].view(np.float32).reshape(4, 3)
    pointer = shared_buffers.scene_pointer(scene, device)
    assert shared_buffers.share(library, pointer, memory, np.zeros((1, 3), np.int32)) != 0
