"""What may stand on the command line. Nothing here imports the engine, so that help and mistakes come at once."""

import argparse
import re

from .outputs import SUFFIXES


class _Parser(argparse.ArgumentParser):
    def error(self, message):
        self.exit(2, f"glanz: error: {message} (see: {self.prog} --help)\n")


def parser(version):
    """The parser of all commands; the name of the chosen one is in `command`."""
    top = _Parser(prog="glanz", description="Render Blender scenes with Glanz.", allow_abbrev=False)
    top.add_argument("--version", action="version", version=f"glanz {version}")
    commands = top.add_subparsers(dest="command", required=True, metavar="COMMAND", parser_class=_Parser)
    _add_render(commands)
    _add_info(commands)
    _add_export(commands)
    _add_merge(commands)
    _add_bench(commands)
    return top


def _add_render(commands):
    command = commands.add_parser(
        "render",
        allow_abbrev=False,
        help="render a scene to EXR or PNG files",
        description="Render FILE. What is not given here is as the file says. A frame number replaces the # in the names of the outputs.",
    )
    _add_file(command)
    command.add_argument(
        "-o", "--output", action="append", default=[], metavar="OUT", help="file to write, .exr or .png; may be given more than once"
    )
    _add_scene(command)
    frames = command.add_mutually_exclusive_group()
    _add_frame(frames)
    told = "frames A to B, in steps of STEP; from a negative one: --frames=-5-5"
    frames.add_argument("--frames", type=frame_range, metavar="A-B[:STEP]", help=told)
    for name, kind, text in (
        ("integrator", str, "how light is followed: path, distributed, whitted, whitted_phong, path_blind, path_naive"),
        ("sampler", str, "random numbers: sobol, stratified, blue_noise, multijitter, random, grid"),
        ("samples", int, "paths per pixel"),
        ("max-depth", int, "bounces; 0 is direct light only"),
        ("max-transparent", int, "transparent surfaces that light passes between two bounces"),
        ("branches", int, "rays that distributed ray tracing splits into at the first hit"),
        ("min-contribution", float, "what a ray must count at least to be followed in whitted and distributed, 0 to 1"),
        ("clamp-direct", float, "scale light down that is brighter [W m^-2 sr^-1], seen itself or off one surface; 0: none"),
        ("clamp-indirect", float, "the same for light off more surfaces: less noise, a picture that is too dark by what is told"),
        ("seed", int, "another number, other noise"),
        ("replicates", int, "independent sets of samples, which tell the error; 0: 8 where it is asked for, else 1"),
        ("error-target", float, "end where the standard error of the picture is this small, such as 0.01; 0: none"),
        ("error-measure", str, "of what: relative, radiance relative to its mean, or lightness, as a share of that of white"),
        ("time-limit", float, "end after so many seconds of rendering, each pixel with a sample at least; 0: none"),
        ("precision", str, "fast, single precision, or exact, double precision, for about a third more time"),
        ("threads", int, "worker threads; 0: one per processor"),
        ("adaptive-threshold", float, "divide pixels where colours differ by more, from 0, never, to 1"),
        ("adaptive-levels", int, "how often, from 1 to 6, in four parts each time"),
        ("pixel-filter", str, "pixel filter: blackman_harris, gaussian, tent, mitchell, box"),
    ):
        command.add_argument(f"--{name}", type=kind, metavar=name[0].upper() if kind is str else "N", help=text)
    command.add_argument(
        "--adaptive-sampling",
        action=argparse.BooleanOptionalAction,
        help="reach an error target with more samples where they lower the error more; else with as many everywhere",
    )
    command.add_argument(
        "--film-transparent",
        action=argparse.BooleanOptionalAction,
        help="leave the film clear where the camera would see the world: alpha is what is covered",
    )
    command.add_argument(
        "--checkpoint",
        metavar="FILE",
        help="keep what is rendered so far in this file, and go on from it where it exists: to the same picture as in one go. "
        "It is deleted when all is written. A frame number replaces its #",
    )
    command.add_argument(
        "--checkpoint-seconds", type=seconds, default=60.0, metavar="S", help="about how often it is written: what a crash may cost; 60"
    )
    command.add_argument(
        "--sample-range",
        type=sample_range,
        metavar="FIRST,END",
        help="render these samples only, END excluded: the mean of parts of equal size is the whole picture",
    )
    command.add_argument("--resolution", type=resolution, metavar="WxH", help="size of the full frame in pixels")
    command.add_argument(
        "--border", type=border, metavar="X0,Y0,X1,Y1", help="render this part only: fractions of the frame from the bottom left"
    )
    _add_strict(command)
    command.add_argument("--quiet", action="store_true", help="print warnings and errors only")


def _add_info(commands):
    command = commands.add_parser(
        "info",
        allow_abbrev=False,
        help="what a scene requires, and what is approximated or ignored",
        description="Look at FILE, render nothing.",
    )
    _add_file(command)
    _add_scene(command)
    _add_frame(command)
    command.add_argument("--json", action="store_true", help="print JSON")


def _add_export(commands):
    command = commands.add_parser(
        "export",
        allow_abbrev=False,
        help="write a scene that renders without Blender",
        description="Write one frame of a .blend file as a scene file.",
    )
    _add_file(command)
    command.add_argument("-o", "--output", required=True, metavar="SCENE", help="scene file to write")
    _add_scene(command)
    _add_frame(command)
    _add_strict(command)


def _add_merge(commands):
    command = commands.add_parser(
        "merge",
        allow_abbrev=False,
        help="make one picture of parts that were rendered apart",
        description="Merge EXR files of different samples of one picture (glanz render --sample-range), weighed by their samples.",
    )
    command.add_argument("parts", nargs="+", metavar="PART", help=".exr file of a part")
    command.add_argument("-o", "--output", required=True, metavar="OUT", help=".exr file to write")


def _add_bench(commands):
    command = commands.add_parser(
        "bench",
        allow_abbrev=False,
        help="what accuracy costs in a scene: error against time, as a table and plots",
        description=(
            "Render a reference of FILE, and all combinations of what is given here, three times each; write curve.csv, curve.json, "
            "curve.png and curve.svg. Errors are told apart into noise and bias."
        ),
    )
    _add_file(command)
    command.add_argument("-o", "--output", default="glanz_bench", metavar="FOLDER", help="where to write; glanz_bench if not given")
    _add_scene(command)
    _add_frame(command)
    told = "size of the frame in pixels; 256 along its longer side if not given"
    command.add_argument("--resolution", type=resolution, metavar="WxH", help=told)
    for name, kind, text in (
        ("integrators", str, "path and the file's if not given"),
        ("samplers", str, "the file's, sobol and random if not given"),
        ("depths", int, "bounces; the file's if not given"),
        ("precisions", str, "fast or exact; the file's if not given"),
    ):
        command.add_argument(f"--{name}", type=list_of(kind), default=(), metavar="A,B", help=text)
    told = "paths per pixel; 1,4,16,64 if not given"
    command.add_argument("--samples", type=list_of(int), default=(1, 4, 16, 64), metavar="A,B", help=told)
    command.add_argument("--quiet", action="store_true", help="print results, warnings and errors only")


def list_of(kind):
    """A parser of words or numbers of one `kind` with commas between them, as a tuple without repetitions."""

    def parsed(text):
        try:
            return tuple(dict.fromkeys(kind(part) for part in text.split(",")))
        except ValueError:
            raise argparse.ArgumentTypeError(f"'{text}' is not a list of numbers, such as 1,4,16") from None

    return parsed


def _add_file(command):
    command.add_argument("file", metavar="FILE", help="a .blend file, or a scene file written by glanz export")


def _add_scene(command):
    command.add_argument("--scene", metavar="S", help="name of the scene in the .blend file; the active one if not given")
    command.add_argument("--view-layer", metavar="L", help="name of the view layer in the .blend file; the first that is used if not given")


def _add_strict(command):
    command.add_argument("--strict", action="store_true", help="fail if anything of the scene would be left out or is missing")


def _add_frame(command):
    command.add_argument("--frame", type=int, metavar="N", help="frame number; the file's current one if not given")


def frame_range(text):
    """The frames of `A-B` or `A-B:STEP`, as a range; numbers may be negative."""
    match = re.fullmatch(r"(-?\d+)-(-?\d+)(?::(\d+))?", text)
    first, last, step = (int(group or 1) for group in match.groups()) if match else (1, 0, 1)
    if first > last or step < 1:
        raise argparse.ArgumentTypeError(f"'{text}' is not a range of frames, such as 1-250 or 1-250:10")
    return range(first, last + 1, step)


def sample_range(text):
    """(first, end) of `FIRST,END`."""
    match = re.fullmatch(r"(\d+),(\d+)", text)
    if not match or int(match[1]) >= int(match[2]):
        raise argparse.ArgumentTypeError(f"'{text}' is not a range of samples, such as 0,16 and then 16,32")
    return int(match[1]), int(match[2])


def seconds(text):
    """A time above 0 [s]."""
    try:
        value = float(text)
    except ValueError:
        value = 0.0
    if not 0 < value < float("inf"):
        raise argparse.ArgumentTypeError(f"'{text}' is not a time in seconds above 0, such as 60")
    return value


def resolution(text):
    """(width, height) of `WxH`."""
    match = re.fullmatch(r"([1-9]\d*)x([1-9]\d*)", text)
    if not match:
        raise argparse.ArgumentTypeError(f"'{text}' is not a size in pixels, such as 1920x1080")
    return int(match[1]), int(match[2])


def border(text):
    """(x0, y0, x1, y1) of four fractions with commas between them."""
    try:
        x0, y0, x1, y1 = (float(part) for part in text.split(","))
    except ValueError:
        x0, y0, x1, y1 = 1, 1, 0, 0
    if not (0 <= x0 < x1 <= 1 and 0 <= y0 < y1 <= 1):
        raise argparse.ArgumentTypeError(f"'{text}' is not left,bottom,right,top in fractions of the frame, such as 0,0,0.5,0.5")
    return x0, y0, x1, y1


def check_outputs(arguments):
    """Raises ValueError, with a text for users, unless the outputs are names of pictures, each a different one."""
    if arguments.command == "export" and arguments.output.lower().endswith(".blend"):
        raise ValueError(f"output '{arguments.output}' would be taken for a .blend file; give it another ending, such as .glanz")
    if arguments.command == "merge" and not arguments.output.lower().endswith(".exr"):
        raise ValueError(f"output '{arguments.output}' is not .exr: what is merged stays linear")
    if arguments.command == "render":
        for path in arguments.output:
            if not path.lower().endswith(SUFFIXES):
                raise ValueError(f"output '{path}' is neither .exr nor .png")
        if len(set(arguments.output)) < len(arguments.output):
            raise ValueError("an output is given twice")
