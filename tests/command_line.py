"""The command line in a process of its own that stays: Blender and NumPy are loaded once, not for each command.

What happens when a command's process begins and ends is tested in `tests/cli`, with a process for each.
"""

import json
import os
import subprocess
import sys
import tempfile
from contextlib import ExitStack, contextmanager


@contextmanager
def command_line(has_blender=True):
    """A function of (folder, words after `glanz`), which gives what `subprocess.run` would of a process for this command."""
    command = [sys.executable, "-m", __name__, *([] if has_blender else ["without"])]
    with subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as process:

        def run(folder, words):
            print(json.dumps([str(folder), words.split()]), file=process.stdin, flush=True)
            answer = process.stdout.readline()
            assert answer, f"glanz {words}: its process crashed"
            return subprocess.CompletedProcess(words, *json.loads(answer))

        try:
            yield run
        finally:
            # Without the interpreter's clean-up, which some versions of Blender do not survive.
            process.kill()


def _serve(has_blender):
    answers = os.fdopen(os.dup(1), "w")
    if not has_blender:
        sys.modules["bpy"] = sys.modules["mathutils"] = None
    from glanz.cli.main import main

    for line in sys.stdin:
        folder, words = json.loads(line)
        os.chdir(folder)
        with _written(1, sys.stdout) as output, _written(2, sys.stderr) as errors:
            status = main(words)
        print(json.dumps([status, "".join(output), "".join(errors)]), file=answers, flush=True)


@contextmanager
def _written(descriptor, stream):
    """A list that holds in the end what was written to the file descriptor, by whom ever."""
    written = []
    with ExitStack() as stack:
        file = stack.enter_context(tempfile.TemporaryFile("w+"))
        before = os.dup(descriptor)
        stack.callback(os.close, before)
        os.dup2(file.fileno(), descriptor)
        try:
            yield written
        finally:
            stream.flush()
            os.dup2(before, descriptor)
        file.seek(0)
        written.append(file.read())


if __name__ == "__main__":
    _serve("without" not in sys.argv)
