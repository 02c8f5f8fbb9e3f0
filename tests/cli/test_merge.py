"""`glanz merge`: parts from several machines become one picture."""

import numpy as np
import pytest

from glanz.engine import write_scene
from glanz.engine.io.exr import read_image
from glanz.tests import helpers as h, scenes
from glanz.tests.command_line import command_line


@pytest.fixture(scope="module")
def glanz(tmp_path_factory):
    folder = tmp_path_factory.mktemp("merge")
    write_scene(folder / "a.glanz", scenes.everything(), h.settings(width=16, height=12, samples=8, max_depth=1))
    with command_line(has_blender=False) as run:

        def succeeds(words, status=0):
            done = run(folder, words)
            assert done.returncode == status, done.stderr
            return done.stdout + done.stderr

        yield folder, succeeds


def test_parts_become_the_picture(glanz):
    folder, run = glanz
    run("render a.glanz -o whole.exr")
    for first, end in ((0, 3), (3, 8)):
        run(f"render a.glanz -o {first}.exr --sample-range {first},{end}")
    run("merge 3.exr 0.exr -o merged.exr")
    whole, parts = (read_image(folder / f"{name}.exr").passes["Combined"] for name in ("whole", "merged"))
    np.testing.assert_allclose(parts, whole, rtol=1e-6, atol=1e-7)


@pytest.mark.parametrize(
    ("words", "told"),
    [
        ("merge 0.exr a.glanz -o b.exr", "cannot read 'a.glanz': it is not an OpenEXR file"),
        ("merge 0.exr gone.exr -o b.exr", "cannot read 'gone.exr': No such file or directory"),
        ("merge 0.exr 0.exr -o b.exr", "both have the samples 0 to 2"),
        ("merge merged.exr -o no/b.exr", "cannot write 'no/b.exr'"),
    ],
)
def test_what_cannot_be_merged_is_said(glanz, words, told):
    folder, run = glanz
    assert told in run(words, status=1)
    assert not (folder / "b.exr").exists()


def test_an_output_of_another_kind_is_a_mistake_of_the_command(glanz):
    _, run = glanz
    assert "is not .exr" in run("merge 0.exr -o b.png", status=2)
