"""The clip range of the camera: the other rays know none."""


def clip_row(camera, scale):
    """The clip range of `camera` in render space of `scale` [m^-1], as {column: number}; both along the axis."""
    return {"clip_start": camera.clip_start * scale, "clip_length": (camera.clip_end - camera.clip_start) * scale}


def start_in_range(plan, rays):
    """Camera rays start where the clip range does; what is nearer is behind them."""
    k = plan.camera_k
    rays.o[...] += rays.d * (k.clip_start * plan.camera.ray_per_depth(k, rays.d))


def to_the_end_of_range(plan, rays):
    """How far rays go, (N,): camera rays end where the clip range does, the others (None) nowhere."""
    return None if rays.depth else range_along(plan, rays.d)


def range_along(plan, d):
    """How far camera rays along d (3, N), of a camera at rest, reach from where the range starts: (N,)."""
    k = plan.camera_k
    limit = k.clip_length * plan.camera.ray_per_depth(k, d)
    return limit.astype(d.dtype, copy=False)
