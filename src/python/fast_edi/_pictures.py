"""Decodes frames that were recorded in PNG or JPEG (sensor_msgs/CompressedImage).

By OpenCV where the module was built with ROS, otherwise by Pillow, which is loaded with the first such frame.
"""
from __future__ import annotations

import importlib
import io
from typing import TYPE_CHECKING, Any, Union

import numpy

if TYPE_CHECKING:
    Array = numpy.ndarray[Any, Any]
    Decoded = Union[tuple[Array, str], str]

# As in src/pictures/picture.hpp: a small file may claim gigabytes.
_MAX_PIXELS = 1 << 24
_PNG_MAGIC = b"\x89PNG\r\n\x1a\n"
# Of a PNG's head: bits of a sample, and its kind of colour (0: grey).
_PNG_DEPTH = 24
_PNG_COLOUR = 25
# Of Pillow's modes: those that are given out as they are, and what the others become.
_MODES = {"L": "mono8", "I": "mono16", "I;16": "mono16", "I;16B": "mono16", "RGB": "bgr8", "RGBA": "bgra8"}
_CONVERTED = {"1": "L", "LA": "RGBA", "PA": "RGBA", "P": "RGB", "CMYK": "RGB"}


def decode(compressed_format: str, data: bytes) -> Decoded:
    """
    The pixels, with their encoding as in sensor_msgs/image_encodings.h, or what is wrong.

    compressed_format: "png", "jpeg", or as image_transport writes it: "ENCODING; png compressed ORDER"
    """
    try:
        from ._bags import decode_picture
    except ImportError:
        return _decode_by_pillow(compressed_format, data)
    return decode_picture(compressed_format, data)


def _decode_by_pillow(compressed_format: str, data: bytes) -> Decoded:
    try:
        pillow = importlib.import_module("PIL.Image")
    except ImportError:
        return "a frame in PNG or JPEG, which is not decoded: install Pillow (pip install pillow)"
    try:
        picture = pillow.open(io.BytesIO(data), formats=("PNG", "JPEG"))
    except pillow.DecompressionBombError as error:
        return f"a picture of too many pixels: {error}"
    except (OSError, SyntaxError, ValueError):
        return "no picture in PNG or JPEG"
    claim = f"{picture.width}x{picture.height} pixels"
    if picture.width * picture.height > _MAX_PIXELS:
        return f"a picture of {claim}, expected at most {_MAX_PIXELS}"
    if data.startswith(_PNG_MAGIC) and data[_PNG_DEPTH] == 16 and data[_PNG_COLOUR] != 0:
        return "a PNG in colour of 16 bits, which Pillow cuts to 8"
    try:
        if picture.mode not in _MODES:
            picture = picture.convert(_CONVERTED[picture.mode])
        pixels = numpy.asarray(picture)
    except (KeyError, OSError, SyntaxError, ValueError):
        return f"a picture of {claim} that cannot be decoded, expected PNG or JPEG of 8 or 16 bits"
    encoding = _MODES[picture.mode]
    if encoding == "mono16":
        pixels = pixels.astype(numpy.uint16)
    return _reordered(pixels, encoding, compressed_format)


def _reordered(pixels: Array, encoding: str, compressed_format: str) -> tuple[Array, str]:
    """From red, green, blue to the order that was compressed; as convertPicture() in src/pictures does it."""
    wanted, _, stored = compressed_format.partition(";")
    if pixels.ndim == 2:
        single = wanted.startswith(("mono", "bayer_")) or wanted in ("8UC1", "16UC1")
        fits = bool(stored) and single and ("16" in wanted) == (encoding == "mono16")
        return numpy.ascontiguousarray(pixels), wanted if fits else encoding
    reverses = True
    names = {3: ("rgb8", "bgr8"), 4: ("rgba8", "bgra8")}[pixels.shape[2]]
    if stored and wanted in names:
        encoding = wanted
        reverses = wanted.startswith("rgb") == ("compressed rgb" in stored)
    if reverses:
        pixels = numpy.concatenate([pixels[..., 2::-1], pixels[..., 3:]], axis=2)
    return numpy.ascontiguousarray(pixels), encoding
