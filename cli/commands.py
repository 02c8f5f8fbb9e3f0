"""What the commands do."""

import dataclasses
import json
import os

from ..addon.settings import border as border_in_pixels
from ..engine import NO_CHECKPOINT, Checkpoint, Requirements, SceneError, __version__, render_image, validate, write_exr, write_scene
from ..engine.io.atomic import check_writable
from ..engine.io.exr import read_image
from ..engine.merging import Part, merged
from . import curve, curve_files
from .outputs import default_output, numbered
from .sources import open_source

OVERRIDES = (
    "integrator",
    "sampler",
    "samples",
    "sample_range",
    "max_depth",
    "max_transparent",
    "branches",
    "min_contribution",
    "clamp_direct",
    "clamp_indirect",
    "seed",
    "replicates",
    "error_target",
    "error_measure",
    "adaptive_sampling",
    "time_limit",
    "precision",
    "threads",
    "adaptive_threshold",
    "adaptive_levels",
    "pixel_filter",
    "film_transparent",
)
"""Arguments that stand for settings of the same name."""


def render(arguments, terminal):
    """Render every frame asked for to every output asked for."""
    outputs = arguments.output or [default_output(arguments.file)]
    frames = arguments.frames if arguments.frames is not None else (arguments.frame,)
    is_sequence = arguments.frames is not None
    for frame in frames:
        for output in outputs:
            # Before the work, not after it.
            check_writable(numbered(output, frame, is_sequence))
    source = _source(arguments, terminal)
    for frame in frames:
        shot = source.shot(frame, arguments.resolution, arguments.strict or None)
        settings = _overridden(shot.settings, arguments)
        for warning in shot.warnings:
            terminal.warn(warning)
        with terminal.stopper.orderly():
            checkpoint = NO_CHECKPOINT
            if arguments.checkpoint:
                path = numbered(arguments.checkpoint, frame, is_sequence)
                checkpoint = Checkpoint(path, shot.scene, settings, arguments.checkpoint_seconds)
                if os.path.exists(path):
                    terminal.note(f"goes on from '{path}'")
            image = _picture(shot, settings, terminal, checkpoint)
            for output in outputs:
                path = numbered(output, shot.frame, is_sequence)
                _write(image, path, source)
                terminal.wrote(path)
            checkpoint.remove()


def info(arguments, terminal):
    """Say what the scene requires and what is approximated or ignored."""
    shot = _source(arguments, terminal).shot(arguments.frame, strict=False)
    scene, warnings = validate(shot.scene, shot.settings)
    settings = dataclasses.asdict(shot.settings)
    requirements = Requirements.of(scene, shot.settings)
    notes, by_kind = [*shot.notes], dict(shot.by_kind)
    for warning in warnings:
        (datablock, name), kind = warning.datablock, "ignored" if warning.is_lost else "approximated"
        notes.append({"what": warning.what, "kind": kind, "datablock": datablock, "name": name, "node": []})
        by_kind[kind] = (*by_kind.get(kind, ()), warning)
    warnings = [*shot.warnings, *warnings]
    counts = {
        "objects": len(scene.objects),
        "triangles": sum(o.mesh.triangles.shape[1] for o in scene.objects),
        "lights": len(scene.lights),
        "warnings": len(warnings),
    }
    if arguments.json:
        content = {"file": arguments.file, "scene": scene.name, "frame": shot.frame, "counts": counts, "settings": settings}
        terminal.say(json.dumps(content | {"requirements": requirements.as_dict(), "warnings": warnings, "notes": notes}, indent=2))
        return
    frame = "" if shot.frame is None else f", frame {shot.frame}"
    terminal.say(f"scene '{scene.name}'{frame}: " + ", ".join(f"{name} {count}" for name, count in counts.items()))
    terminal.say("settings: " + ", ".join(f"{name} {value}" for name, value in settings.items()))
    terminal.say("requires:")
    terminal.say("\n".join(f"  {line}" for line in str(requirements).splitlines()))
    if not warnings:
        terminal.say("nothing is approximated or ignored")
    for kind, lines in by_kind.items():
        if lines:
            terminal.say("\n".join((f"{kind}:", *(f"  {line}" for line in lines))))


def export(arguments, terminal):
    """Write one frame as a scene file."""
    check_writable(arguments.output)
    shot = _source(arguments, terminal).shot(arguments.frame, strict=arguments.strict or None)
    for warning in shot.warnings:
        terminal.warn(warning)
    with terminal.stopper.orderly():
        write_scene(arguments.output, shot.scene, shot.settings)
    terminal.wrote(arguments.output)


def merge(arguments, terminal):
    """Make one picture of its parts."""
    check_writable(arguments.output)
    image = merged([Part.of(path, read_image(path)) for path in arguments.parts])
    for warning in image.warnings:
        terminal.warn(warning)
    with terminal.stopper.orderly():
        write_exr(arguments.output, image)
    terminal.wrote(arguments.output)


def bench(arguments, terminal):
    """Measure what accuracy costs in a scene, and write the curve."""
    source = _source(arguments, terminal)
    shot = source.shot(arguments.frame, arguments.resolution, strict=None)
    if not arguments.resolution:
        shot = source.shot(arguments.frame, curve.small(shot.settings.width, shot.settings.height), strict=None)
    for warning in shot.warnings:
        terminal.warn(warning)
    settings = shot.settings
    asked = {
        "integrators": arguments.integrators or tuple(dict.fromkeys(("path", settings.integrator))),
        "samplers": arguments.samplers or tuple(dict.fromkeys((settings.sampler, "sobol", "random"))),
        "depths": arguments.depths or (settings.max_depth,),
        "precisions": arguments.precisions or (settings.precision,),
        "samples": arguments.samples,
    }
    with terminal.stopper.orderly(), terminal.progress(f"{shot.scene.name}: {settings.width}x{settings.height}") as show:

        def on_progress(done):
            show(done)
            terminal.stopper.check()

        rungs = curve.measure(shot.scene, settings, **asked, on_progress=on_progress)
    facts = {"scene": shot.scene.name, "width": settings.width, "height": settings.height, "version": __version__} | asked
    terminal.say("\n".join(curve_files.as_lines(rungs)))
    if rungs[0].flip is None:
        terminal.warn(f"FLIP is not measured without flip-evaluator; cure: {curve_files.CURE}")
    paths, missing = curve_files.write(arguments.output, rungs, facts)
    if missing:
        terminal.warn(f"{' and '.join(missing)} are not drawn without matplotlib; cure: {curve_files.CURE}")
    for path in paths:
        terminal.wrote(path)


def _source(arguments, terminal):
    return open_source(arguments.file, arguments.scene, terminal.keep_stdout_for_us, arguments.view_layer)


def _overridden(settings, arguments):
    """`settings` with what the command line says instead. Raises SceneError naming the setting."""
    values = {name: getattr(arguments, name) for name in OVERRIDES if getattr(arguments, name) is not None}
    if arguments.border:
        x0, y0, x1, y1 = arguments.border
        values["border"] = border_in_pixels((x0, x1, y0, y1), settings.width, settings.height)
    return dataclasses.replace(settings, **values)


def _picture(shot, settings, terminal, checkpoint):
    x0, y0, x1, y1 = settings.region
    title = f"{shot.scene.name}{'' if shot.frame is None else f', frame {shot.frame}'}: {x1 - x0}x{y1 - y0}, {settings.samples} samples"
    with terminal.progress(title) as show:

        def on_progress(progress):
            if shot.is_strict and (lost := [warning for warning in progress.warnings if warning.is_lost]):
                raise SceneError(f"scene '{shot.scene.name}' is strict, and something is left out: " + "; ".join(lost))
            for warning in progress.warnings:
                terminal.warn(warning)
            show(progress.done)
            terminal.stopper.check()

        image = render_image(shot.scene, settings, on_progress, checkpoint)
    terminal.note(_reached(image.metadata))
    if not image.passes:
        raise SceneError("no picture came out: the settings name no passes")
    more = {"glanz.version": __version__} | ({} if shot.frame is None else {"glanz.frame": str(shot.frame)})
    return dataclasses.replace(image, metadata=image.metadata | more)


def _reached(facts):
    """What a picture says of its end, as a line."""
    samples, error, cause = (facts[f"glanz.reached.{name}"] for name in ("samples", "error", "ended_by"))
    measured = "" if error == "not measured" else f", error {100 * float(error):.2g} %"
    return f"{samples} samples{measured}; ended by the {_CAUSES[cause]}"


_CAUSES = {"samples": "number of samples", "error": "error target", "time": "time limit"}


def _write(image, path, source):
    if path.lower().endswith(".exr"):
        write_exr(path, image)
        return
    source.save_png(image, path)
