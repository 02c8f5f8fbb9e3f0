"""Embree reads meshes where they lie: embreex copies them number by number, with the GIL held, which takes longer than to build the tree.

That wants Embree's own functions, and the pointer to its scene, which embreex keeps in an object and tells nobody. The declarations that
come with embreex (rtcore_scene.pxd) say how that object is laid out, for C code that uses it. Nothing here trusts that: the pointer is
read only where all of the object but the pointer holds what Python, too, says that it holds. Elsewhere, such as in an embreex that is
laid out otherwise, or on a system that does not find Embree's functions through embreex, embreex copies.
"""

import ctypes
import sys

import numpy as np

# Embree's rtcore_common.h and rtcore_buffer.h.
_INDEX_BUFFER, _VERTEX_BUFFER = 0, 1
_UINT3, _FLOAT3 = 0x5003, 0x9003
_WORD = ctypes.sizeof(ctypes.c_void_p)
_PROOF = 0x5EED
"""What the object's number is set to for a moment."""


def library_of(module):
    """Embree's functions as embreex's `module` finds them, None where it finds none."""
    try:
        library = ctypes.CDLL(module.__file__)
        for name, (result, *arguments) in _FUNCTIONS.items():
            function = getattr(library, name)
            function.restype, function.argtypes = result, arguments
    except (AttributeError, OSError):
        return None
    return library


_POINTER, _SIZE = ctypes.c_void_p, ctypes.c_size_t
_FUNCTIONS = {
    "rtcGetGeometry": (_POINTER, _POINTER, ctypes.c_uint),
    "rtcSetSharedGeometryBuffer": (None, _POINTER, ctypes.c_int, ctypes.c_uint, ctypes.c_int, _POINTER, _SIZE, _SIZE, _SIZE),
    "rtcCommitGeometry": (None, _POINTER),
    "rtcCommitScene": (None, _POINTER),
    "rtcGetSceneDevice": (_POINTER, _POINTER),
    "rtcSetDeviceErrorFunction": (None, _POINTER, _POINTER, _POINTER),
    "rtcGetDeviceError": (ctypes.c_int, _POINTER),
    "rtcReleaseDevice": (None, _POINTER),
}
"""Name -> (type of the result, types of the arguments)."""


def scene_pointer(scene, device):
    """Embree's scene in embreex's `scene`, which was made with `device`; None where that is not laid out as is known.

    Five words: how often it is referred to, its type, the pointer, a number that may be written, the device.
    """
    kind = type(scene)
    if sys.implementation.name != "cpython" or kind.__basicsize__ != 5 * _WORD or not hasattr(scene, "is_committed"):
        return None
    words = (_SIZE * 5).from_address(id(scene))
    if words[1] != id(kind) or words[4] != id(device):
        return None
    before = scene.is_committed
    try:
        scene.is_committed = _PROOF
        is_there = ctypes.c_int.from_address(ctypes.addressof(words) + 3 * _WORD).value == _PROOF
    finally:
        scene.is_committed = before
    return words[2] if is_there else None


def share(library, pointer, vertices, triangles):
    """Let the only mesh of Embree's scene at `pointer` consist of what lies in two arrays, and build the tree without the GIL.

    vertices   (V + 1, 3) float32, of which the last is never used: Embree reads 16 bytes of each
    triangles  (F, 3) int32
    Both have to stay as long as the scene. Returns Embree's number of an error, 0 where all went well.
    """
    for array, dtype in ((vertices, np.float32), (triangles, np.int32)):
        if array.dtype != dtype or not array.flags.c_contiguous or array.shape[1:] != (3,):
            raise ValueError(f"arrays to share must be {dtype.__name__} (N, 3) in C order, not {array.dtype} {array.shape}")
    device = library.rtcGetSceneDevice(pointer)
    try:
        # embreex would be told of errors, and call Python without the GIL.
        library.rtcSetDeviceErrorFunction(device, None, None)
        geometry = library.rtcGetGeometry(pointer, 0)
        buffers = ((_INDEX_BUFFER, _UINT3, triangles, len(triangles)), (_VERTEX_BUFFER, _FLOAT3, vertices, len(vertices) - 1))
        for kind, form, array, count in buffers:
            library.rtcSetSharedGeometryBuffer(geometry, kind, 0, form, array.ctypes.data, 0, array.strides[0], count)
        if error := library.rtcGetDeviceError(device):
            return error
        library.rtcCommitGeometry(geometry)
        library.rtcCommitScene(pointer)
        return library.rtcGetDeviceError(device)
    finally:
        library.rtcReleaseDevice(device)
