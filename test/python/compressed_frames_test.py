"""Frames that were recorded in PNG or JPEG (sensor_msgs/CompressedImage)."""
import io
import struct
import sys
import zlib

import numpy
import PIL.Image
import pytest
import rosbag
import sensor_msgs.msg
from conftest import ROOT

import fast_edi
from fast_edi import _pictures

RECORDINGS = ROOT / "test" / "data" / "recordings"


def frames(recording):
    return [item for item in recording if isinstance(item, fast_edi.Frame)]


@pytest.fixture(params=["OpenCV", "Pillow"])
def decoder(request, monkeypatch):
    """With the part of the module that has OpenCV, and as `pip` builds it, without that."""
    if request.param == "Pillow":
        monkeypatch.setitem(sys.modules, "fast_edi._bags", None)
    return request.param


def test_of_rosbag2(decoder):
    recording = fast_edi.open(RECORDINGS / "rosbag2" / "png")
    found = frames(recording)
    expected = frames(fast_edi.open(RECORDINGS / "vendor_none.aedat4"))
    assert recording.damage == []
    assert [frame.stamp for frame in found] == [frame.stamp for frame in expected]
    assert [frame.encoding for frame in found] == ["mono8"] * 3
    assert all(numpy.array_equal(a.image, b.image) for a, b in zip(found, expected))


def test_of_16_bits(decoder):
    recording = fast_edi.open(RECORDINGS / "rosbag2" / "room_png")
    found = frames(recording)
    assert recording.damage == []
    assert [(frame.encoding, frame.image.dtype, frame.image.shape) for frame in found] == [
        ("mono16", numpy.uint16, (40, 48))] * 2
    raw = frames(fast_edi.open(RECORDINGS / "rosbag2" / "room_big_endian"))
    assert all(numpy.array_equal(a.image, b.image) for a, b in zip(found, raw))


def test_of_a_bag(tmp_path):
    raw = frames(fast_edi.open(RECORDINGS / "room.bag"))
    path = tmp_path / "compressed.bag"
    with rosbag.Bag(str(RECORDINGS / "room.bag")) as bag, rosbag.Bag(str(path), "w") as compressed:
        for topic, message, time in bag.read_messages():
            if topic == "/dvs/image_raw":
                picture = io.BytesIO()
                PIL.Image.frombytes("I;16", (message.width, message.height), message.data).save(picture, "PNG")
                topic += "/compressed"
                message = sensor_msgs.msg.CompressedImage(message.header, "mono16; png compressed ",
                                                          picture.getvalue())
            compressed.write(topic, message, time)
    found = frames(fast_edi.open(path))
    assert len(found) == 3
    assert all(numpy.array_equal(a.image, b.image) for a, b in zip(found, raw))


COLOURS = numpy.arange(4 * 5 * 3, dtype=numpy.uint8).reshape(4, 5, 3)


def encoded(pixels, kind="PNG"):
    picture = io.BytesIO()
    PIL.Image.fromarray(pixels).save(picture, kind)
    return picture.getvalue()


@pytest.mark.parametrize("text, encoding, reverses", [
    ("png", "bgr8", True),
    ("rgb8; png compressed bgr8", "rgb8", False),
    ("bgr8; png compressed bgr8", "bgr8", True),
    ("rgb8; png compressed rgb8", "rgb8", True),  # stored as if red were blue
    ("mono8; png compressed ", "bgr8", True),  # three channels all the same
])
def test_order_of_channels(decoder, text, encoding, reverses):
    pixels, found = _pictures.decode(text, encoded(COLOURS))
    assert found == encoding
    assert numpy.array_equal(pixels, COLOURS[..., ::-1] if reverses else COLOURS)


def test_bayer_and_alpha(decoder):
    pixels, encoding = _pictures.decode("bayer_rggb8; png compressed ", encoded(COLOURS[..., 0]))
    assert encoding == "bayer_rggb8" and numpy.array_equal(pixels, COLOURS[..., 0])
    alpha = numpy.dstack([COLOURS, COLOURS[..., :1] + 100])
    pixels, encoding = _pictures.decode("png", encoded(alpha))
    assert encoding == "bgra8" and numpy.array_equal(pixels, alpha[..., [2, 1, 0, 3]])


def test_jpeg(decoder):
    smooth = numpy.add.outer(numpy.arange(40), numpy.arange(48)).astype(numpy.uint8)
    pixels, encoding = _pictures.decode("jpeg", encoded(smooth, "JPEG"))
    assert encoding == "mono8"
    assert numpy.abs(pixels.astype(int) - smooth).max() <= 4


def test_what_is_no_picture(decoder):
    for data in (b"", b"GIF89a", encoded(COLOURS)[:30], encoded(COLOURS, "GIF")):
        assert isinstance(_pictures.decode("png", data), str), data


def png(width, height, depth, colour, rows=b""):
    """A PNG with that head; no library is asked whether it fits."""
    chunks = ((b"IHDR", struct.pack(">IIBBBBB", width, height, depth, colour, 0, 0, 0)),
              (b"IDAT", zlib.compress(rows)), (b"IEND", b""))
    return b"\x89PNG\r\n\x1a\n" + b"".join(
        struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
        for name, data in chunks)


def test_colours_of_16_bits_are_not_cut_to_8(decoder):
    pixels = (numpy.arange(2 * 3 * 3).reshape(2, 3, 3) * 1000).astype(">u2")
    decoded = _pictures.decode("png", png(3, 2, 16, 2, b"".join(b"\0" + row.tobytes() for row in pixels)))
    if decoder == "Pillow":
        assert "16 bits, which Pillow cuts" in decoded
    else:
        assert decoded[1] == "bgr16" and numpy.array_equal(decoded[0], pixels[..., ::-1])


def test_pictures_that_claim_too_much(decoder):
    for side, claim in ((5_000, "5000x5000"), (100_000, "pixels")):
        assert claim in _pictures.decode("png", png(side, side, 8, 2))


def test_without_a_decoder_they_are_damage(monkeypatch):
    monkeypatch.setitem(sys.modules, "fast_edi._bags", None)
    monkeypatch.setitem(sys.modules, "PIL.Image", None)
    recording = fast_edi.open(RECORDINGS / "rosbag2" / "png")
    assert not frames(recording)
    assert len(recording.damage) == 3
    assert "install Pillow" in recording.damage[0][1]
