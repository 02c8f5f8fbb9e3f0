"""What would take more memory than there is is refused with the number before it is taken: pictures, geometry, images (faults J8, J9)."""

import resource
import subprocess
import sys
import textwrap
import tracemalloc
from types import SimpleNamespace

import numpy as np
import pytest

from glanz.engine import (
    Bitmap,
    Checkpoint,
    Dielectric,
    EnvironmentMap,
    Material,
    MemoryShortage,
    Mesh,
    PointLight,
    WhiteNoiseTexture,
    World,
    memory,
    prepare,
    render,
    render_image,
    render_plan,
    room,
)
from glanz.engine.rendering import gathered
from glanz.engine.scene import environment
from glanz.engine.scene.settings import PRECISIONS
from glanz.engine.world import room as world_room
from glanz.tests import helpers as h

MANY = ("Combined", "Normal", "Depth", "Diffuse Direct", "Diffuse Color", "CryptoObject00", "Standard Error", "Position")
WAYS = {
    "tiles": ({}, ()),
    "one tile": ({"tile_size": 0}, ()),
    "rounds": ({"samples": 2}, (1, 2)),
    "time limit": ({"samples": 2, "time_limit": 1e3}, ()),
    "passes": ({"passes": MANY}, ()),
    "rounds of passes": ({"samples": 2, "passes": MANY}, (1, 2)),
}


def lit(*things):
    return h.scene([h.thing(h.quad()), *things], [PointLight(position=(0, 0, 2))], world=0.5)


# How much is free


@pytest.fixture
def system(tmp_path, monkeypatch):
    """A function that says what the system tells: files by their paths, and the limit of the process."""

    def tell(files, limit=resource.RLIM_INFINITY):
        for name, text in files.items():
            path = tmp_path / name.lstrip("/")
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_text(text)
        monkeypatch.setattr(memory, "Path", lambda name: tmp_path / str(name).lstrip("/"))
        monkeypatch.setattr(memory, "_GROUPS", tmp_path / "sys/fs/cgroup")
        own = {"getrlimit": lambda which: (limit, limit), "getpagesize": lambda: 4096}
        monkeypatch.setattr(memory, "resource", SimpleNamespace(**{**vars(resource), **own}))

    return tell


MACHINE = {"/proc/meminfo": "MemTotal: 9 kB\nMemAvailable:  8000 kB\n", "/proc/self/statm": "1000 500 1 1 0 1 0\n"}
LIMIT = "/sys/fs/cgroup/a/memory.max"
GROUP = {
    "/proc/self/cgroup": "0::/a/b\n",
    "/sys/fs/cgroup/a/b/memory.max": "max\n",
    "/sys/fs/cgroup/a/b/memory.current": "7000000\n",
    LIMIT: "7500000\n",
    "/sys/fs/cgroup/a/memory.current": "7000000\n",
    "/sys/fs/cgroup/a/memory.stat": "file 5\ninactive_file 1000000\n",
}
OLD_GROUP = {
    "/proc/self/cgroup": "5:cpu,cpuacct:/x\n4:memory:/c\n0::/\n",
    "/sys/fs/cgroup/memory/c/memory.limit_in_bytes": "3000000\n",
    "/sys/fs/cgroup/memory/c/memory.usage_in_bytes": "1000000\n",
}


@pytest.mark.parametrize(
    ("files", "limit", "expected"),
    [
        (MACHINE, resource.RLIM_INFINITY, 8000 * 1024),
        (MACHINE, 5_000_000, 5_000_000 - 4_096_000),
        (MACHINE, 4_000_000, 0),
        (MACHINE | GROUP, resource.RLIM_INFINITY, 1_500_000),
        (MACHINE | OLD_GROUP, resource.RLIM_INFINITY, 2_000_000),
        (MACHINE | OLD_GROUP, 5_000_000, 5_000_000 - 4_096_000),
        ({"/proc/meminfo": "nothing\n", "/proc/self/cgroup": "\n"}, resource.RLIM_INFINITY, None),
        ({}, resource.RLIM_INFINITY, None),
    ],
    ids=["machine", "limit", "beyond the limit", "group", "group of version 1", "the least of all", "nothing told", "no files"],
)
def test_what_is_free_is_the_least_that_any_limit_leaves(system, files, limit, expected):
    system(files, limit)
    assert memory.free() == expected


def test_a_share_of_what_is_free_may_be_taken_and_not_a_byte_more(monkeypatch):
    monkeypatch.setattr(memory, "free", lambda: 1000)
    memory.require(900, "things", "fewer")
    with pytest.raises(MemoryShortage, match=r"things need about 0\.0 MiB of memory, but only 0\.0 MiB are free: fewer"):
        memory.require(901, "things", "fewer")
    monkeypatch.setattr(memory, "free", lambda: None)
    memory.require(1e30, "things", "fewer")


# What things take


@pytest.mark.parametrize("way", WAYS)
def test_a_picture_takes_what_is_told_of_it(way):
    """By how much the peak grows from 256^2 pixels, which fill a batch, to 512^2: never more than is told, and not much less."""
    changes, ends = WAYS[way]
    peaks, told = [], []
    for side in (256, 512):
        settings = h.settings(**{"width": side, "height": side, "samples": 1, "tile_size": 64, "max_depth": 0, **changes})
        plan, _ = prepare(lit(), settings)
        tracemalloc.start()
        gathered(render_plan(plan, ends), settings)
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        told.append(room.needed(plan, keeps=bool(ends or settings.time_limit), saves=False))
    grown = (told[1] - told[0]) / (peaks[1] - peaks[0])
    assert 1 <= grown < 3
    assert peaks[1] <= told[1]


@pytest.mark.parametrize("way", WAYS)
def test_a_picture_in_double_precision_takes_no_more_than_is_told_of_it(way):
    changes, ends = WAYS[way]
    settings = h.settings(**{"width": 256, "height": 256, "samples": 16, "tile_size": 64, "precision": "exact", **changes})
    plan, _ = prepare(lit(), settings)
    tracemalloc.start()
    gathered(render_plan(plan, ends), settings)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    told = room.needed(plan, keeps=bool(ends or settings.time_limit), saves=False)
    assert 0.05 * told < peak <= told


@pytest.mark.parametrize("precision", PRECISIONS)
@pytest.mark.parametrize("samples", [1, 16])
def test_rays_that_branch_at_every_depth_take_no_more_than_is_told_of_them(samples, precision):
    """Behind every pixel are six panes of glass, and each of their rays is divided: batches of all depths are there at once."""
    panes = [
        h.thing(h.quad((0, 0, -0.1 * number), (4, 0, 0), (0, 4, 0)), Material(name="pane", lobes=(Dielectric(1.5),))) for number in range(6)
    ]
    settings = h.settings(width=64, height=64, samples=samples, tile_size=64, max_depth=12, integrator="whitted", precision=precision)
    plan, _ = prepare(lit(*panes), settings)
    gathered(render_plan(plan), settings)
    tracemalloc.start()
    gathered(render_plan(plan), settings)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert 0.1 * room.needed(plan, keeps=False, saves=False) < peak <= room.needed(plan, keeps=False, saves=False)


@pytest.mark.parametrize("passes", [("Combined",), ("Combined", "Normal", "Depth", "Diffuse Direct", "CryptoObject00")], ids=len)
def test_a_picture_whose_pixels_are_all_divided_takes_what_is_told_of_it(passes):
    """Noise that no division evens out."""
    noisy = Material(name="noisy", emission=WhiteNoiseTexture())
    settings = h.settings(width=128, height=128, tile_size=128, samples=1, adaptive_threshold=1e-6, adaptive_levels=3, passes=passes)
    plan, _ = prepare(h.scene([h.thing(h.quad((0, 0, 0), (9, 0, 0), (0, 9, 0)), noisy)]), settings)
    tracemalloc.start()
    gathered(render_plan(plan), settings)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    told = room.needed(plan, keeps=False, saves=False)
    assert 0.5 * told < peak <= told


def grid(count):
    """A rough ground of 2 count^2 triangles."""
    y, x = np.mgrid[: count + 1, : count + 1] / count
    corner = (np.arange(count)[:, None] * (count + 1) + np.arange(count)).ravel()
    triangles = [np.stack((corner, corner + 1, corner + count + 1)), np.stack((corner + 1, corner + count + 2, corner + count + 1))]
    height = np.random.default_rng(1).random(x.shape)
    return Mesh(name="ground", vertices=np.stack((x, y, height)).reshape(3, -1), triangles=np.concatenate(triangles, axis=1))


@pytest.mark.parametrize("precision", ["fast", "exact"])
@pytest.mark.parametrize("emission", [0.0, 1.0])
@pytest.mark.parametrize("is_smooth", [False, True])
def test_geometry_takes_what_is_told_of_it(is_smooth, emission, precision):
    """By how much the peak grows from 20,000 triangles to 180,000. Python does not know of Embree's tree: 60 to 70 bytes for each."""
    peaks, triangles = [], []
    for count in (100, 300):
        mesh = grid(count).smoothed() if is_smooth else grid(count)
        scene = lit(h.thing(mesh, h.lambert(emission=emission)))
        tracemalloc.start()
        prepare(scene, h.settings(precision=precision))
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
        triangles.append(mesh.triangles.shape[1])
    taken = (peaks[1] - peaks[0]) / (triangles[1] - triangles[0]) + 70
    told = world_room.bytes_per_triangle(emission > 0, PRECISIONS[precision])
    assert 0.5 * told < taken <= told


# What is refused


def refused_at(monkeypatch, limit, call, told):
    """`call` is refused with the line `told` where a byte less is free than the `limit` which it needs."""
    monkeypatch.setattr(memory, "free", lambda: limit / memory.SHARE + 1)
    call()
    monkeypatch.setattr(memory, "free", lambda: (limit - 1) / memory.SHARE)
    with pytest.raises(MemoryShortage, match=told):
        call()


@pytest.mark.parametrize(
    ("ends", "cure"),
    [((), "lower the resolution, render a border, or ask for fewer passes$"), ((1, 2), "or do without an error target, a time limit")],
    ids=["tiles", "rounds"],
)
def test_a_picture_is_refused_where_it_would_not_fit(monkeypatch, ends, cure):
    settings = h.settings(width=64, height=48, samples=2, passes=("Combined", "Depth"))
    plan, _ = prepare(lit(), settings)
    limit = room.needed(plan, keeps=bool(ends), saves=False)
    told = rf"^64x48 px with 5 channels need about .* of memory, but only .* are free: .*{cure}"
    refused_at(monkeypatch, limit, lambda: list(render_plan(plan, ends)), told)


def test_a_checkpoint_counts(monkeypatch, tmp_path):
    settings = h.settings(width=64, height=48)
    plan, _ = prepare(lit(), settings)
    checkpoint = Checkpoint(tmp_path / "a", lit(), settings)
    limit = room.needed(plan, keeps=True, saves=True)
    refused_at(monkeypatch, limit, lambda: list(render_plan(plan, checkpoint=checkpoint)), "a checkpoint")


def test_a_frame_of_too_many_tiles_is_refused_before_they_are_listed():
    with pytest.raises(MemoryShortage, match="65536x65536 px with 4 channels need about"):
        list(render(h.scene(world=0.5), h.settings(width=65536, height=65536, tile_size=1)))


def test_a_border_makes_it_fit(monkeypatch):
    big = h.settings(width=65536, height=65536, border=(7, 9, 15, 17), samples=1)
    assert render_image(h.scene(world=0.5), big).passes["Combined"].shape == (8, 8, 4)


def test_geometry_is_refused_by_object(monkeypatch):
    things = [h.thing(h.icosphere(1, name=f"ball {i}")) for i in range(3)]
    limit = world_room.BYTES_PER_TRIANGLE * (2 + 3 * 80) + world_room.BYTES_PER_VERTEX * (3 + 3 * 2)
    told = r"scene 'Scene': its 242 triangles, most of them 80 of object 'ball 2', need about .*: simplify or leave out objects"
    refused_at(monkeypatch, limit, lambda: world_room.require_room(lit(*things), 0), told)


def test_an_image_is_refused_by_name(monkeypatch):
    pixels = np.zeros((3, 100, 200), np.uint8)
    told = "the pixels of image 'big', 200x100 of them, and their mip maps need about .*: scale it down"
    refused_at(monkeypatch, 100 * 200 * (4 + 6), lambda: Bitmap(name="big", pixels=pixels), told)


def test_an_environment_is_refused_by_name_and_takes_what_is_told(monkeypatch):
    """By how much the peak grows from 64 rows to 256, of pixels that are converted, too."""
    peaks, pixels = [], [np.random.default_rng(1).random((3, rows, 2 * rows)) for rows in (64, 256)]
    for values in pixels:
        tracemalloc.start()
        prepare(h.replaced(lit(), world=World(environment=EnvironmentMap(pixels=values))), h.settings())
        peaks.append(tracemalloc.get_traced_memory()[1])
        tracemalloc.stop()
    taken = (peaks[1] - peaks[0]) / (pixels[1][0].size - pixels[0][0].size)
    told = environment._BYTES
    assert 0.5 * told < taken <= told
    words = "the pixels of environment 'sky', 512x256 of them, and .* need about .*: scale it down"
    refused_at(monkeypatch, 512 * 256 * told, lambda: EnvironmentMap(name="sky", pixels=pixels[1]), words)


PRELUDE = """
import resource, sys
import numpy as np
from glanz.engine import GlanzError, Object, prepare, render_image
from glanz.engine.scene.settings import PRECISIONS
from glanz.tests import helpers as h
prepare(h.scene([h.thing(h.quad())]), h.settings())
def limited(megabytes):
    used = int(open("/proc/self/statm").read().split()[0]) * resource.getpagesize()
    resource.setrlimit(resource.RLIMIT_AS, (used + megabytes * 2**20,) * 2)
def tell(call):
    try:
        call()
    except GlanzError as error:
        print(type(error).__name__, error)
        sys.exit(3)
"""
LIMITED = {
    "picture": """
        limited(500)
        tell(lambda: render_image(h.scene(world=0.5), h.settings(width=16384, height=16384, samples=1)))
        """,
    "geometry": """
        ball = h.icosphere(5)
        many = [Object(name=f"ball {i}", mesh=ball) for i in range(200)]
        limited(500)
        tell(lambda: prepare(h.scene(many), h.settings()))
        """,
}


@pytest.mark.parametrize(("what", "told"), [("picture", "16384x16384 px"), ("geometry", "its 4096000 triangles")])
def test_a_process_with_a_limit_ends_with_a_message_and_not_by_a_signal(what, told):
    done = subprocess.run([sys.executable, "-c", PRELUDE + textwrap.dedent(LIMITED[what])], capture_output=True, text=True)
    assert done.returncode == 3, done.stderr
    assert done.stdout.startswith("MemoryShortage")
    assert told in done.stdout
