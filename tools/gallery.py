"""Render the pictures of docs/gallery.md and write the page: `make gallery`, or with names of sections only these pictures.

Every picture is one command of the table below, which the page shows; nothing else goes into it.
"""

import shlex
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
IMAGES = "docs/images/gallery"


@dataclass(frozen=True)
class Picture:
    """caption, and the options of `glanz render` beside the scene and the output."""

    name: str
    caption: str
    options: str = ""


@dataclass(frozen=True)
class Section:
    """Pictures of one sample scene."""

    scene: str
    title: str
    text: str
    pictures: tuple

    def command(self, picture):
        """What makes a picture, as it is typed in the root of the repository."""
        words = ["glanz", "render", f"sample_scenes/{self.scene}.blend", "-o", f"{IMAGES}/{picture.name}.png"]
        return " ".join([*words, *([picture.options] if picture.options else [])])


def depths(scene, values):
    return tuple(Picture(f"{scene}_{d}", f"depth {d}", f"--max-depth {d}") for d in values)


SECTIONS = (
    Section(
        "metal_balls",
        "Mirrors, one recursion after the other",
        "Whitted's ray tracing. A polished ball has no colour of its own: at depth 0 it is black, and every further bounce shows what the "
        "balls in the balls reflect.",
        depths("metal_balls", (0, 1, 2, 5)),
    ),
    Section(
        "glass_balls",
        "Glass, one recursion after the other",
        "A ray needs two bounces to get through a ball, and four through two. Shadow rays pass glass, weakened by its colour: that is "
        "Whitted's model, in which glass gathers no light.",
        depths("glass_balls", (0, 1, 2, 5)),
    ),
    Section(
        "mirror_and_glass",
        "Four ways to follow light",
        "The same scene by Whitted's ray tracing, with the lecture's illumination model, by distributed ray tracing and by path tracing. "
        "The last two agree but for the noise: soft shadows, colour that walls and balls lend each other, and caustics under the glass.",
        (
            Picture("integrator_whitted", "Whitted", "--integrator whitted --samples 16 --resolution 384x216"),
            Picture(
                "integrator_whitted_phong",
                "Whitted, the lecture's illumination",
                "--integrator whitted_phong --samples 16 --resolution 384x216",
            ),
            Picture(
                "integrator_distributed",
                "distributed, 8 branches",
                "--integrator distributed --samples 16 --branches 8 --max-depth 6 --resolution 384x216",
            ),
            Picture("integrator_path", "path tracing, 256 samples", "--resolution 384x216"),
        ),
    ),
    Section(
        "cornell_box",
        "What each idea buys",
        "16 paths per pixel each: directions uniform over the hemisphere; directions by the cosine; and shadow rays to the lamp as well, "
        "shared by multiple importance sampling.",
        tuple(
            Picture(f"idea_{key}", caption, f"--integrator {key} --samples 16 --resolution 320x320")
            for key, caption in (
                ("path_naive", "naive path tracing"),
                ("path_blind", "importance sampling of the BSDF"),
                ("path", "and light sampling"),
            )
        ),
    ),
    Section(
        "soft_shadow",
        "Soft shadows",
        "A square lamp: with hard shadows by Whitted, and by distributed ray tracing, where the shadow softens "
        "with the distance from what casts it.",
        (Picture("soft_shadow_hard", "Whitted", "--integrator whitted"), Picture("soft_shadow", "distributed")),
    ),
    Section(
        "translucency",
        "Gloss and translucency",
        "Sheets of Phong exponent 0, 20, 300 and 10,000 about the way straight on, by distributed ray tracing: what stands farther behind "
        "them is seen less sharply.",
        (Picture("translucency", "distributed"),),
    ),
    Section(
        "depth_of_field",
        "Depth of field",
        "A thin lens of six blades, focused on the third ball. What is far out of focus takes the shape of the aperture.",
        (Picture("depth_of_field", "f/0.08", "--resolution 480x300"),),
    ),
    Section(
        "moving_balls",
        "Motion blur",
        "A ball that stands still, one that rolls, one in a bounce, one on a circle, and a wheel, while the shutter is open "
        "for 0.8 frames.",
        (Picture("moving_balls", "shutter 0.8"),),
    ),
    Section(
        "ring_caustic",
        "A caustic under a ring",
        "The inside of a golden ring gathers sunlight into a cusp. Only rays that are scattered at random find it: path tracing.",
        (Picture("ring_caustic", "path tracing"),),
    ),
    Section(
        "prism",
        "Dispersion",
        "Bright slits seen through prisms of Abbe number infinity, 60, 30 and 15. Every path has one wavelength; white stays white.",
        (Picture("prism", "path tracing"), Picture("prism_whitted", "Whitted: three rays", "--integrator whitted --samples 16")),
    ),
    Section(
        "glass_of_water",
        "Media inside media",
        "Glass, water that overlaps it, ice and a bubble of air in the water: at every boundary the media that really meet are found by "
        "priority, and light is absorbed on its way through each.",
        (Picture("glass_of_water", "path tracing"),),
    ),
    Section(
        "stained_glass",
        "Coloured shadows",
        "Panes that let light pass straight on weaken shadow rays by their colour.",
        (Picture("stained_glass", "path tracing"),),
    ),
    Section(
        "phong_exponents",
        "Phong exponents",
        "One lobe from dull to polished: exponents 1, 3, 10, 30, 100, 300 and 1000.",
        (Picture("phong_exponents", "path tracing", "--resolution 768x240"),),
    ),
    Section(
        "phong_lobes",
        "Three normalisations of Phong's lobe",
        "The modified lobe of Lafortune and Willems, the lecture's, which is divided by the cosine of incidence, and Blinn's about the "
        "half vector; above with exponent 10, below with 100. They differ at the rims.",
        (Picture("phong_lobes", "path tracing"),),
    ),
    Section(
        "lights",
        "Lights",
        "Sun, point, spot, glowing mesh; area lights: square, rectangle, disk, ellipse.",
        (Picture("lights", "path tracing", "--resolution 480x240"),),
    ),
    Section(
        "environment",
        "Light from a picture",
        "A sky of 128 x 64 pixels with a small sun, sampled in proportion to its light.",
        (Picture("environment", "path tracing"),),
    ),
    Section(
        "many_lights",
        "A thousand lights",
        "Every shadow ray chooses one of 1,024 lamps, in proportion to what it is likely to give.",
        (Picture("many_lights", "path tracing"),),
    ),
    Section(
        "checkerboard",
        "A checkerboard to the horizon",
        "One sample per pixel: textures are filtered over the footprint of the ray, so nothing aliases.",
        (
            Picture("checkerboard", "1 sample", "--samples 1 --pixel-filter box"),
            Picture("checkerboard_many", "256 samples", "--samples 256"),
        ),
    ),
    Section(
        "textures",
        "Textures, bump and normal maps",
        "A picture, a checker, noise and gradients as colours; noise as bumps, and a picture as normals.",
        (Picture("textures", "path tracing"),),
    ),
    Section(
        "materials",
        "Twelve materials from nodes",
        "Wood, brick, tiles, brushed metal; car paint, glass with dirt, leaves with alpha, skin; fabric, marble, water, neon: node trees "
        "as users have them, rendered as they are. How each node compares with Cycles is in [nodes](nodes.md).",
        (Picture("materials", "path tracing, 128 samples"),),
    ),
)
FOOTER = """
## The twelve materials in Cycles

The same file with the same number of samples, rendered by Cycles in Blender 5.0, for comparison with the picture above.

![The twelve materials by Cycles](images/materials_cycles.png)

## Sampling

How the zone plate cos(64 r^2) looks under each sampler and pixel filter is in [images/zone_plate.png](images/zone_plate.png), made by
`python -m benchmarks.zone_plate`; how fast the error falls is in [convergence](convergence.md).

![The zone plate under each sampler and filter](images/zone_plate.png)
"""


def page():
    """docs/gallery.md."""
    parts = [
        "# Gallery\n\nWhat Glanz computes, one picture for each idea. Every picture is made by the command above it, in the root of the "
        "repository with `.venv/bin` in the path; `make gallery` makes them all, and this page.\n"
    ]
    for section in SECTIONS:
        parts.append(f"\n## {section.title}\n\n{section.text} The scene: [{section.scene}](../sample_scenes/{section.scene}.py).\n\n")
        parts.append("\n".join(f"    {section.command(picture)}" for picture in section.pictures) + "\n\n")
        parts += [f"![{section.title}: {picture.caption}](images/gallery/{picture.name}.png)\n" for picture in section.pictures]
    return "".join(parts) + FOOTER


def main(names):
    unknown = set(names) - {section.scene for section in SECTIONS}
    if unknown:
        raise SystemExit(f"unknown: {', '.join(sorted(unknown))}; known: {', '.join(section.scene for section in SECTIONS)}")
    (ROOT / IMAGES).mkdir(parents=True, exist_ok=True)
    for section in SECTIONS:
        for picture in section.pictures if not names or section.scene in names else ():
            command = section.command(picture)
            print(command, flush=True)
            subprocess.run([sys.executable, "-m", "glanz.cli", *shlex.split(command)[1:], "--quiet"], cwd=ROOT, check=True)
    (ROOT / "docs/gallery.md").write_text(page(), encoding="utf-8")


if __name__ == "__main__":
    main(sys.argv[1:])
