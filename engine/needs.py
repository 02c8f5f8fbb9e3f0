"""The features that a scene may ask for; what nobody asks for is not run.

Plug-ins add their own: a scene that uses the BSDF `phong` needs "bsdf phong".
"""

GEOMETRY = "geometry"
SMOOTH_NORMALS = "smooth normals"
EMISSIVE_MESHES = "emissive meshes"
LIGHT_CHOICE = "light choice"
LIGHT_HITS = "light hits"
BACKGROUND = "background"
ENVIRONMENT = "environment"
LENS = "lens"
CLIP_RANGE = "clip range"
ADAPTIVE = "adaptive supersampling"
ABSORPTION = "absorption"
NESTED_MEDIA = "nested media"
CAMERA_MOTION = "camera motion"
OBJECT_MOTION = "object motion"
TRANSPARENCY = "transparency"
TINTED_SHADOWS = "tinted shadows"
DISPERSION = "dispersion"
TEXTURES = "textures"
FOOTPRINTS = "footprints"
RELIEF = "relief"
LIGHT_PATHS = "light paths"
SPLIT_LIGHT = "split light"
TRANSPARENT_FILM = "transparent film"
RAY_VISIBILITY = "ray visibility"
HOLDOUTS = "holdouts"

MEANING = {
    GEOMETRY: "triangles to intersect",
    SMOOTH_NORMALS: "shading normals interpolated across triangles",
    EMISSIVE_MESHES: "meshes that emit, sampled by shadow rays and met by scattered ones",
    LIGHT_CHOICE: "more than one light to choose from",
    LIGHT_HITS: "light objects with a size, met by rays",
    BACKGROUND: "light from the world, the same from everywhere",
    ENVIRONMENT: "a picture around the scene, sampled by shadow rays and met by rays that escape",
    LENS: "a camera with an aperture, out of focus at other distances than one",
    CLIP_RANGE: "a camera that does not see what is too near or too far",
    ADAPTIVE: "pixels that are divided where colours differ",
    ABSORPTION: "media that weaken light on its way through",
    NESTED_MEDIA: "bodies that let light in and may share space, so that boundaries are between two media",
    CAMERA_MOTION: "a camera that moves while the shutter is open",
    OBJECT_MOTION: "objects that move or deform while the shutter is open, met at each path's own time",
    TRANSPARENCY: "surfaces that rays may pass straight on",
    TINTED_SHADOWS: "surfaces that weaken light on its straight way to others instead of blocking it",
    DISPERSION: "indices of refraction that depend on the wavelength",
    TEXTURES: "parameters of materials that vary over a surface, and lights that shine through textures",
    FOOTPRINTS: "textures with detail, averaged over what a ray stands for",
    RELIEF: "shading normals bent by textures",
    LIGHT_PATHS: "paths that know what has scattered them",
    SPLIT_LIGHT: "light that is told apart by the kinds of lobes that have sent it to the camera",
    RAY_VISIBILITY: "things that some kinds of rays do not see",
    HOLDOUTS: "surfaces that the camera sees as clear and black",
    TRANSPARENT_FILM: "a film that stays clear where the camera would see the world",
}


def of_plugin(kind, plugin):
    """The need for a plug-in class of the registry `kind`."""
    return f"{kind} {plugin.key}"
