"""Sheets that scatter what passes, from paper to nearly clear: what stands behind them is seen the less sharply the farther it is."""

import common
from mathutils import Matrix
from phong_lobes import lecture

EXPONENTS = (0.0, 20.0, 300.0, 10000.0)
WIDTH, HEIGHT, GAP = 0.8, 1.3, 0.08


def build():
    """The scene."""
    scene = common.new_scene("Translucency", 520, 320, samples=16, max_depth=4)
    scene.glanz.integrator = "distributed"
    scene.glanz.branches = 16
    for number, exponent in enumerate(EXPONENTS):
        sheet = lecture(f"Sheet n={exponent:g}", k_d=(0.05,) * 3, k_s=(0.0,) * 3, k_t=(0.9,) * 3, is_sheet=True, sheet_exponent=exponent)
        x = (number - 0.5 * len(EXPONENTS)) * (WIDTH + GAP) + 0.5 * GAP
        common.add(scene, sheet.name, common.quad(sheet.name, (x, 0.0, 0.0), (WIDTH, 0, 0), (0, 0, HEIGHT), sheet))
        ball = common.sphere(f"Ball {number}", 0.2, common.diffuse(f"Ball {number}", (0.7, 0.12, 0.08)), segments=32, rings=16)
        common.add(scene, f"Ball {number}", ball, Matrix.Translation((x + 0.25, 0.24, 0.2)))
        post = common.box(f"Post {number}", (0.14, 0.14, 1.1), common.diffuse(f"Post {number}", (0.08, 0.2, 0.5)))
        common.add(scene, f"Post {number}", post, Matrix.Translation((x + 0.6, 0.9, 0.0)))
    common.add(scene, "Floor", common.quad("Floor", (-6, -6, 0), (12, 0, 0), (0, 12, 0), common.diffuse("Birch", (0.6, 0.52, 0.42))))
    common.add(scene, "Wall", common.quad("Wall", (-6, 2.4, 0), (12, 0, 0), (0, 0, 5), common.diffuse("Wall", (0.6, 0.6, 0.58))))
    common.light(scene, "Lamp", "AREA", (1.4, 1.4, 3.0), (0.0, 0.6, 0.3), 150.0, shape="DISK", size=0.8)
    common.light(scene, "Front", "AREA", (-2.0, -3.0, 3.0), (0.0, 0.0, 0.5), 45.0, shape="SQUARE", size=1.5)
    common.camera(scene, (0.0, -4.4, 1.5), (0.0, 0.4, 0.55), lens=42.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
