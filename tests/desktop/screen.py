"""The screen that Blender is on: pictures of it, and keys pressed as a hand would.

On X11, by way of its own libraries, because Blender's operator for screenshots answers with a black picture on virtual
screens, and its simulated events do not stop a render. Elsewhere Blender's operator is asked, and there is no keyboard.
"""

import ctypes
import os
import struct
import sys
import zlib

KEYS = {"ESC": 0xFF1B, "F12": 0xFFC9, "RETURN": 0xFF0D}
"""X11 key symbols."""


class _Image(ctypes.Structure):
    """The public head of XImage."""

    _fields_ = (
        *((name, ctypes.c_int) for name in ("width", "height", "xoffset", "format")),
        ("data", ctypes.c_void_p),
        *((name, ctypes.c_int) for name in ("byte_order", "unit", "bit_order", "pad", "depth", "bytes_per_line", "bits_per_pixel")),
    )


class Screen:
    """An X11 display of 24 bits. Raises OSError where there is none, or a library of X11's is missing."""

    def __init__(self):
        self._x = x = ctypes.CDLL("libX11.so.6")
        self._xtest = ctypes.CDLL("libXtst.so.6")
        pointer, number = ctypes.c_void_p, ctypes.c_ulong
        x.XOpenDisplay.restype = pointer
        x.XOpenDisplay.argtypes = (ctypes.c_char_p,)
        x.XDefaultRootWindow.restype = number
        for function in (x.XDefaultRootWindow, x.XDefaultScreen, x.XFlush):
            function.argtypes = (pointer,)
        for function in (x.XDisplayWidth, x.XDisplayHeight):
            function.argtypes = (pointer, ctypes.c_int)
        x.XGetImage.restype = ctypes.POINTER(_Image)
        x.XGetImage.argtypes = (pointer, number, *(ctypes.c_int,) * 2, *(ctypes.c_uint,) * 2, number, ctypes.c_int)
        x.XDestroyImage.argtypes = (ctypes.POINTER(_Image),)
        x.XKeysymToKeycode.restype = ctypes.c_ubyte
        x.XKeysymToKeycode.argtypes = (pointer, number)
        self._xtest.XTestFakeKeyEvent.argtypes = (pointer, ctypes.c_uint, ctypes.c_int, number)
        self._xtest.XTestFakeMotionEvent.argtypes = (pointer, *(ctypes.c_int,) * 3, number)
        self._display = x.XOpenDisplay(None)
        if not self._display:
            raise OSError(f"no X11 display answers at DISPLAY={os.environ.get('DISPLAY', '')!r}")
        screen = x.XDefaultScreen(self._display)
        self.width, self.height = x.XDisplayWidth(self._display, screen), x.XDisplayHeight(self._display, screen)

    def grab(self, x, y, width, height):
        """The rectangle from (x, y), the origin top left, as rows of RGB: (height, width, 3) in bytes."""
        all_planes, z_pixmap = ctypes.c_ulong(-1).value, 2
        root = self._x.XDefaultRootWindow(self._display)
        image = self._x.XGetImage(self._display, root, x, y, width, height, all_planes, z_pixmap)
        if not image:
            raise OSError("X11 gives no picture of the screen")
        head = image.contents
        if head.bits_per_pixel != 32:
            raise OSError(f"a screen of {head.bits_per_pixel} bits per pixel is not supported, 32 are")
        raw = ctypes.string_at(head.data, head.bytes_per_line * height)
        self._x.XDestroyImage(image)
        rows = (raw[start : start + 4 * width] for start in range(0, len(raw), head.bytes_per_line))
        bgrx = b"".join(rows)
        rgb = bytearray(3 * width * height)
        rgb[0::3], rgb[1::3], rgb[2::3] = bgrx[2::4], bgrx[1::4], bgrx[0::4]
        return bytes(rgb)

    def press(self, key):
        """Press and release a key of KEYS."""
        code = self._x.XKeysymToKeycode(self._display, KEYS[key])
        for is_down in (1, 0):
            self._xtest.XTestFakeKeyEvent(self._display, code, is_down, 0)
        self._x.XFlush(self._display)

    def move(self, x, y):
        """Move the mouse; X11 without a window manager sends keys to the window below it."""
        self._xtest.XTestFakeMotionEvent(self._display, -1, x, y, 0)
        self._x.XFlush(self._display)


def open_screen():
    """A `Screen`, or None on systems that have no X11."""
    return Screen() if sys.platform.startswith("linux") else None


def write_png(path, rgb, width, height):
    """`rgb`: width * height * 3 bytes, row 0 at the top (PNG specification, third edition)."""
    rows = b"".join(b"\0" + rgb[3 * width * y : 3 * width * (y + 1)] for y in range(height))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", zlib.compress(rows, 3)) + chunk(b"IEND", b""))
