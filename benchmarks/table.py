"""The measurements as a table, with the bar that each is held to."""

ROWS = (
    # result, key, what it is, unit, bar
    ("speed", "glanz", "Cornell box 512x512, 16 samples, 2 threads: Glanz, F12", "s", None),
    ("speed", "cycles", "the same: Cycles, F12", "s", None),
    ("speed", "ratio", "Glanz / Cycles, wall time", "", 0.7),
    ("speed", "cpu_ratio", "Glanz / Cycles, processor time", "", None),
    ("speed", "core", "the same: engine alone, without Blender", "s", None),
    ("speed", "embree_share", "share of the threads' time inside Embree", "%", -55),
    ("speed", "rays", "rays traced in the picture", "M", None),
    ("speed", "rays_per_second", "rays per second of wall time", "M/s", None),
    ("error", "glanz", "RMSE against 2048 samples: Glanz, 16 samples", "", None),
    ("error", "cycles", "the same: Cycles", "", None),
    ("error", "ratio", "Glanz / Cycles, error at equal samples", "", None),
    *(
        ("many_lights", f"{key}_{count}", f"{count} lamps, 192x192, 16 samples: {what}", unit, None)
        for count in (1, 10, 100, 1000, 10_000)
        for key, what, unit in (("seconds", "processor time", "s"), ("error", "RMSE over mean", ""), ("choice", "one choice", "ns"))
    ),
    ("instances", "triangles", "instances: triangles in the depsgraph", "M", None),
    ("instances", "export", "export", "s", None),
    ("instances", "compile", "world compile", "s", None),
    ("instances", "total", "export and world compile", "s", 4.0),
    ("motion", "camera", "Cornell box in motion / at rest, processor time: camera", "", None),
    ("motion", "ball", "the same: one ball slides", "", None),
    ("motion", "balls", "the same: both balls slide", "", None),
    ("motion", "spin", "the same: both balls spin", "", None),
    ("motion", "deform", "the same: both balls deform, in 8 steps", "", None),
    *(
        ("features", key, f"Cornell box with / without, processor time: {what}", "", None)
        for key, what in (
            ("phong", "Phong on the spheres and the tall box"),
            ("mirror", "mirrors"),
            ("glass", "glass"),
            ("absorption", "glass that absorbs"),
            ("dispersion", "glass with dispersion"),
            ("transparency", "half transparent"),
            ("translucency", "translucent"),
            ("image", "a picture of 256 x 256 as reflectance"),
            ("checker", "a checker"),
            ("noise", "noise"),
            ("environment", "an environment of 128 x 64"),
            ("lamps", "1,000 lamps more"),
            ("lens", "a lens"),
            ("camera_motion", "a camera in motion"),
            ("whitted", "Whitted"),
            ("distributed", "distributed, 8 branches"),
            ("path_blind", "without light sampling"),
            ("adaptive", "adaptive supersampling, 2 levels"),
            ("sampler_sobol", "Sobol"),
            ("sampler_blue_noise", "blue noise"),
            ("sampler_multijitter", "correlated multi-jittered"),
            ("sampler_random", "random"),
        )
    ),
    ("features", "exact", "Cornell box in double / in single precision, processor time", "", 1.6),
    ("features", "principled", "Cornell box with / without: a Principled material", "", None),
    ("features", "default", "Blender's default material all over / its lobes with constants", "", 1.15),
    ("features", "pictures", "a Principled material with three pictures / with constants", "", 2.0),
    ("memory", "import_bpy", "resident after `import bpy`", "MB", None),
    ("memory", "peak", "peak, Cornell box 1920x1080 with 3 passes", "MB", None),
    ("memory", "over", "over what `import bpy` takes", "MB", 1000),
    *(
        ("extremes", f"{case}_{engine}", f"{text}: {who}", "", bar)
        for cases, bars in (
            (
                (
                    ("box_tiny", "Cornell box, 1e-6 its size / as it is, block means differ by at most"),
                    ("box_tiny_median", "the same, the median block"),
                    ("box_huge", "the same, 1e6 its size"),
                    ("box_huge_median", "the same, the median block"),
                    ("box_far", "the same, 2^20 m away"),
                ),
                (1e-4, 1e-6),
            ),
            (
                (
                    ("room", "closed white room, escapes of a million segments"),
                    ("room_tiny", "the same, 1e-6 its size"),
                    ("room_huge", "the same, 1e6 its size"),
                    ("room_far", "the same, 2^20 m away"),
                ),
                (3, 3),
            ),
            (
                (
                    ("floor_0.01", "floor, sun 1e-2 rad above it, light lacking"),
                    ("floor_0.001", "the same, 1e-3 rad"),
                    ("floor_0.0001", "the same, 1e-4 rad"),
                ),
                (None, None),
            ),
        )
        for case, text in cases
        for engine, who, bar in zip(("glanz", "exact", "cycles"), ("Glanz, fast", "Glanz, exact", "Cycles"), (*bars, None), strict=True)
    ),
    *(
        ("large", f"{shading}_{key}", text, unit, bar)
        for shading in ("smooth", "flat")
        for key, text, unit, bar in (
            ("triangles", f"one {shading} mesh in Blender, 512x512, 16 samples, F12", "M triangles", None),
            ("export", "export", "s", None),
            ("export_cpu", "the same, processor time", "s", None),
            ("build", "checks, tables and Embree's tree", "s", None),
            ("build_cpu", "the same, processor time", "s", None),
            ("render", "rendering", "s", None),
            ("render_cpu", "the same, processor time", "s", None),
            ("total", "all of it", "s", 60),
            ("total_cpu", "the same, processor time", "s", None),
            ("before", "resident before F12: Blender and its mesh", "MB", None),
            ("over", "the most above that", "MB", None),
            ("peak", "peak", "MB", 8000),
        )
    ),
)
"""A bar is an upper bound; a negative one is a lower bound."""


def show(results):
    """Print the rows that `results` {name: {key: number}} hold; in colour where rich is installed."""
    rows = [
        (text, f"{results[name][key]:.3g} {unit}".strip(), verdict(results[name][key], bar))
        for name, key, text, unit, bar in ROWS
        if name in results
    ]
    try:
        from rich.console import Console
        from rich.table import Table
    except ImportError:
        for text, value, held in rows:
            print(f"{text:62} {value:>12}  {held}")
        return
    table = Table("measured", "value", "bar")
    table.columns[1].justify = "right"
    for text, value, held in rows:
        colour = "green" if held.endswith("held") else "red" if held else ""
        table.add_row(text, value, f"[{colour}]{held}[/]" if colour else held)
    Console(width=110).print(table)


def verdict(value, bar):
    """`at most 0.7: held`, or `at least 55: missed`; nothing without a bar."""
    if bar is None:
        return ""
    holds = value <= bar if bar > 0 else value >= -bar
    return f"at {'most' if bar > 0 else 'least'} {abs(bar):g}: {'held' if holds else 'missed'}"
