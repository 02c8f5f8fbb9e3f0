"""Three normalisations of Phong's lobe: Lafortune and Willems', the lecture's, and Blinn's; sharp behind, dull in front."""

import common
from mathutils import Matrix

NORMALISATIONS = ("phong", "phong_lecture", "blinn_phong")
EXPONENTS = (6.0, 60.0)
RADIUS, SPACING = 0.5, 1.3


def lecture(name, **parameters):
    """A material of the lecture's parameters instead of nodes."""
    made = common.diffuse(name, (0.5, 0.5, 0.5))
    made.glanz.use_lecture = True
    for key, value in parameters.items():
        setattr(made.glanz, key, value)
    return made


def build():
    """The scene."""
    scene = common.new_scene("Phong lobes", 560, 360, samples=128, max_depth=4)
    scene.glanz.sampler = "sobol"
    for column, normalisation in enumerate(NORMALISATIONS):
        for row, exponent in enumerate(EXPONENTS):
            # Blinn's lobe is as wide as the others with four times the exponent.
            n = 4 * exponent if normalisation == "blinn_phong" else exponent
            red = lecture(
                f"{normalisation} {exponent:g}", k_d=(0.16, 0.03, 0.02), k_s=(0.7, 0.7, 0.7), exponent=n, normalisation=normalisation
            )
            ball = common.sphere(red.name, RADIUS, red, segments=48, rings=24)
            place = (SPACING * (column - 1), 1.25 * row, RADIUS)
            common.add(scene, red.name, ball, Matrix.Translation(place))
    common.add(scene, "Floor", common.quad("Floor", (-9, -9, 0), (18, 0, 0), (0, 18, 0), common.diffuse("Felt", (0.16, 0.19, 0.2))))
    common.light(scene, "Key", "AREA", (-2.5, -2.5, 4.5), (0, 0.6, 0.4), 260.0, shape="SQUARE", size=1.0)
    common.light(scene, "Rim", "AREA", (3.0, 4.6, 1.6), (0, 0.6, 0.4), 260.0, shape="RECTANGLE", size=0.8, size_y=1.6)
    scene.world = common.world((0.6, 0.7, 0.9), 0.15)
    common.camera(scene, (0.0, -5.4, 2.7), (0.0, 0.5, 0.45), lens=46.0)
    return scene


if __name__ == "__main__":
    common.save(build(), __file__)
