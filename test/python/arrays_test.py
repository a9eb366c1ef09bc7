"""The Python module: arrays in and out, and what it does with input that cannot be used."""
import os
import re
import subprocess
import sys
import threading

import numpy
import pytest
from conftest import ROOT

import fast_edi

CONTRAST = {"contrast_threshold_on": 0.25, "contrast_threshold_off": 0.25}
SIZE = (16, 12)


def test_package_of_dynamic_reconfigure_is_beside():
    from fast_edi.cfg import DeblurConfig
    assert "contrast_threshold_on" in DeblurConfig.defaults


def test_version_is_the_packages():
    assert f"<version>{fast_edi.__version__}</version>" in (ROOT / "package.xml").read_text()


def events(count=200, dtype=numpy.int64):
    """In the order of time, on SIZE, within 20 ms of t = 1 s."""
    index = numpy.arange(count)
    return ((index % SIZE[0]).astype(dtype), (index % SIZE[1]).astype(dtype),
            1_000_000 + index * 100, (index % 3 == 0).astype(dtype))


def frame(dtype=numpy.uint8, *samples):
    pixels = numpy.arange(SIZE[0] * SIZE[1] * int(numpy.prod(samples, dtype=int)))
    return (pixels * 7 % 200 + 20).astype(dtype).reshape(SIZE[1], SIZE[0], *samples)


def sharp(image, columns, **options):
    return fast_edi.deblur(image, columns, 1_002_000, 1_012_000, 0.25, 0.25, **options)


def test_one_frame_changes_by_its_events_alone():
    image = frame()
    out = sharp(image, events(), filter=False)
    assert out.dtype == image.dtype and out.shape == image.shape
    assert not numpy.array_equal(out, image)
    x, y, t, p = events()
    inside = (t >= 1_002_000) & (t < 1_012_000)
    columns = tuple(column[inside] for column in (x, y, t, p))
    level = {"filter": False, "level_ramp_ms": 0}
    assert numpy.array_equal(sharp(image, events(), **level), sharp(image, columns, **level))


def test_no_events_leave_a_frame_as_it_is():
    none = tuple(numpy.empty(0, int) for _ in range(4))
    assert numpy.array_equal(sharp(frame(), none, filter=False), frame())


@pytest.mark.parametrize("dtype", ["i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", ">i4"])
def test_any_integer_type_of_events(dtype):
    x, y, t, p = events()
    columns = (x.astype(dtype), y.astype(dtype), t.astype(">i8"), p.astype(dtype))
    assert numpy.array_equal(sharp(frame(), columns), sharp(frame(), events()))


@pytest.mark.parametrize("names", ["x y t p", "x y timestamp polarity", "p x y ts"])
def test_structured_arrays_and_strides(names):
    columns = dict(zip(("x", "y", "t", "p"), events()))
    alias = {"timestamp": "t", "ts": "t", "polarity": "p"}
    packed = numpy.zeros(400, [(name, "i8" if alias.get(name, name) == "t" else "i1")
                               for name in names.split()])[::2]
    for name in names.split():
        packed[name] = columns[alias.get(name, name)]
    assert numpy.array_equal(sharp(frame(), packed), sharp(frame(), events()))


def test_negative_polarity_is_darker():
    x, y, t, p = events()
    assert numpy.array_equal(sharp(frame(), (x, y, t, 2 * p - 1)), sharp(frame(), events()))


@pytest.mark.parametrize("kind", [(numpy.uint8,), (numpy.uint8, 1), (numpy.uint8, 3),
                                  (numpy.uint8, 4), (numpy.uint16,), (numpy.uint16, 3)])
def test_images_come_out_as_they_came_in(kind):
    image = frame(*kind)
    out = sharp(image, events())
    assert out.dtype == image.dtype and out.shape == image.shape
    assert numpy.array_equal(sharp(numpy.asfortranarray(image), events()), out)
    assert numpy.array_equal(sharp(image[::-1][::-1], events()), out)


def test_bayer_frames():
    assert sharp(frame(), events(), bayer=True).shape == frame().shape


def changed(column, value, at=10):
    columns = [array.copy() for array in events()]
    columns["xytp".index(column)][at] = value
    return columns


BAD_EVENTS = {
    "lengths": (lambda: [array[:n] for array, n in zip(events(), (9, 8, 9, 9))],
                ValueError, "y has 8 elements, expected 9 as in x"),
    "x": (lambda: changed("x", 16), ValueError, r"x\[10\] is 16, expected 0..15"),
    "negative": (lambda: changed("y", -1), ValueError, r"y\[10\] is -1, expected 0..11"),
    "late": (lambda: changed("t", 5), ValueError, r"t\[10\] is 5, expected no less than 1000900"),
    "before 1970": (lambda: changed("t", -5, 0), ValueError, r"t\[0\] is -5, expected 0.."),
    "far": (lambda: changed("t", 2**62, 199), ValueError, r"t\[199\] is"),
    "polarity": (lambda: changed("p", 2), ValueError, r"p\[10\] is 2, expected 0 or 1"),
    "float": (lambda: [numpy.full(4, numpy.nan)] * 4, TypeError, "x has dtype float64, expected an"),
    "shape": (lambda: [array.reshape(2, -1) for array in events()], ValueError,
              "x has 2 dimensions, expected 1"),
    "fields": (lambda: [numpy.zeros(3, [("x", int), ("y", int), ("t", int)])], TypeError,
               "has the fields x, y, t, expected p among them"),
    "three": (lambda: events()[:3], TypeError, "3 arrays of events are given"),
    "text": (lambda: [numpy.array(["a"])] * 4, TypeError, "x has dtype <U1"),
    "objects": (lambda: [numpy.array([None])] * 4, TypeError, "x has dtype object"),
}


@pytest.mark.parametrize("name", BAD_EVENTS)
def test_bad_events_are_named_and_nothing_is_taken(name):
    make, error, message = BAD_EVENTS[name]
    deblurrer = fast_edi.Deblurrer(SIZE, **CONTRAST)
    with pytest.raises(error, match=message):
        deblurrer.add_events(*make())
    assert deblurrer.counters["events_in"] == 0
    deblurrer.add_events(*events())
    deblurrer.add_frame(frame(), 1_007_000, 10_000)
    (result,) = deblurrer.results()
    assert result.deblurred and result.events == 100
    assert result.exposure == (1_002_000, 1_012_000)


BAD_FRAMES = {
    "dtype": (lambda d: d.add_frame(frame(float), 1_007_000, 10_000), TypeError, "image has dtype float64"),
    "shape": (lambda d: d.add_frame(frame(numpy.uint8, 2), 1_007_000, 10_000), ValueError, "image has the shape"),
    "empty": (lambda d: d.add_frame(numpy.zeros((0, 4), "u1"), 1_007_000, 10_000), ValueError, "image has the shape"),
    "flat": (lambda d: d.add_frame(numpy.zeros(4, "u1"), 1_007_000, 10_000), ValueError, "image has the shape"),
    "stamp": (lambda d: d.add_frame(frame(), -1, 10_000), ValueError, "stamp is -1, expected 0.."),
    "float stamp": (lambda d: d.add_frame(frame(), 0.5, 10_000), TypeError, "stamp is 0.5, expected an integer"),
    "exposure": (lambda d: d.add_frame(frame(), 1_007_000, 0), ValueError, "exposure is 0, expected 1.."),
    "long": (lambda d: d.add_frame(frame(), 1_007_000, 10**7), ValueError, "expected 1..1000000"),
    "bayer": (lambda d: d.add_frame(frame(numpy.uint8, 3), 1_007_000, 1, bayer=True), ValueError, "bayer"),
}


@pytest.mark.parametrize("name", BAD_FRAMES)
def test_bad_frames_are_named_and_nothing_is_taken(name):
    make, error, message = BAD_FRAMES[name]
    deblurrer = fast_edi.Deblurrer(SIZE, **CONTRAST)
    deblurrer.add_events(*events())
    with pytest.raises(error, match=message):
        make(deblurrer)
    assert deblurrer.counters["frames_in"] == 0
    deblurrer.add_frame(frame(), 1_007_000, 10_000)
    assert [result.deblurred for result in deblurrer.results()] == [True]


def test_frames_without_exposure():
    """They have that of the frame before, and do not take that of the one behind."""
    deblurrer = fast_edi.Deblurrer(SIZE, **CONTRAST)
    deblurrer.add_frame(frame(), 1_001_000)
    deblurrer.add_events(*events())
    for stamp, exposure in ((1_004_000, 4_000), (1_008_000, None), (1_014_000, 6_000)):
        deblurrer.add_frame(frame(), stamp, exposure)
    assert [result.exposure for result in deblurrer.results()] == [
        None, (1_002_000, 1_006_000), (1_006_000, 1_010_000), (1_011_000, 1_017_000)]


def test_exposure_by_parameter():
    deblurrer = fast_edi.Deblurrer(SIZE, exposure_time_us=4000, **CONTRAST)
    deblurrer.add_events(*events())
    deblurrer.add_frame(frame(), 1_008_000)
    assert [result.exposure for result in deblurrer.results()] == [(1_006_000, 1_010_000)]


def test_frames_of_another_size_pass_through():
    deblurrer = fast_edi.Deblurrer(SIZE, **CONTRAST)
    deblurrer.add_events(*events())
    image = numpy.zeros((13, 16), numpy.uint8)
    deblurrer.add_frame(image, 1_007_000, 10_000)
    deblurrer.finish()
    (result,) = deblurrer.results()
    assert not result.deblurred and "size" in result.pass_reason
    assert numpy.array_equal(result.image, image)


@pytest.mark.parametrize("parameters, message", [
    ({}, "contrast_threshold_on: not given"),
    ({**CONTRAST, "weihgting": "time"}, "weighting"),
    ({**CONTRAST, "close_timeout_ms": 0}, "close_timeout_ms"),
    ({**CONTRAST, "contrast_threshold_on": float("nan")}, "contrast_threshold_on"),
    ({**CONTRAST, "time_unit": "s"}, "time_unit is 's', expected 'us' or 'ns'"),
    ({**CONTRAST, "time_unit": None}, "time_unit is None, expected 'us' or 'ns'"),
    ({**CONTRAST, "time_unit": ["us"]}, r"time_unit is \['us'\], expected 'us' or 'ns'"),
])
def test_bad_parameters_are_named(parameters, message):
    with pytest.raises(ValueError, match=message):
        fast_edi.Deblurrer(SIZE, **parameters)


@pytest.mark.parametrize("size", [(0, 3), (3, 40_000), 3, ("a", 2)])
def test_bad_sizes_are_named(size):
    with pytest.raises((TypeError, ValueError), match="sensor_size"):
        fast_edi.Deblurrer(size, **CONTRAST)


DEMO = ROOT / "bags" / "demo.bag"


def test_a_bad_unit_of_a_recording_is_named():
    for unit in ("ms", ["us"], 1):
        with pytest.raises(ValueError, match=re.escape(f"time_unit is {unit!r}, expected 'us' or 'ns'")):
            fast_edi.open(DEMO, time_unit=unit)


@pytest.mark.parametrize("of_recording, of_deblurrer", [("ns", "us"), ("us", "ns")])
def test_recordings_in_another_unit_are_refused(of_recording, of_deblurrer):
    deblurrer = fast_edi.Deblurrer((346, 260), time_unit=of_deblurrer, **CONTRAST)
    with pytest.raises(ValueError, match=re.escape(
            f"time_unit of the recording {DEMO} is '{of_recording}', expected '{of_deblurrer}' as of this Deblurrer")):
        next(deblurrer.run(fast_edi.open(DEMO, time_unit=of_recording)))
    assert deblurrer.counters["events_in"] == deblurrer.counters["frames_in"] == 0


@pytest.mark.parametrize("unit, latest", [("us", 4_294_967_295_999_999), ("ns", 4_294_967_295_999_999_999)])
def test_times_beyond_what_the_unit_allows_name_it(unit, latest):
    deblurrer = fast_edi.Deblurrer(SIZE, time_unit=unit, **CONTRAST)
    text = re.escape(f"is {latest + 1}, expected 0..{latest} (time_unit is '{unit}')")
    with pytest.raises(ValueError, match=r"^t\[0\] " + text):
        deblurrer.add_events([1], [1], [latest + 1], [1])
    with pytest.raises(ValueError, match="^stamp " + text):
        deblurrer.add_frame(frame(), latest + 1, 1_000)


def test_files_that_cannot_be_opened(tmp_path):
    with pytest.raises(FileNotFoundError):
        fast_edi.open(tmp_path / "none.aedat4")
    with pytest.raises(ValueError, match="AEDAT4"):
        fast_edi.open(tmp_path)
    with pytest.raises(IsADirectoryError):
        fast_edi.Deblurrer(SIZE, tmp_path)
    other = tmp_path / "other"
    other.write_bytes(b"nothing")
    with pytest.raises(ValueError, match="AEDAT4"):
        fast_edi.open(other)


def test_thresholds_of_biases():
    on, off = fast_edi.contrast_from_biases(ROOT / "cfg" / "davis346.yaml")
    assert (on, off) == pytest.approx((0.2609, 0.2415), abs=1e-4)


def test_import_loads_no_ros():
    code = "import fast_edi; print(any('libroscpp' in line for line in open('/proc/self/maps')))"
    assert subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True,
                          env=os.environ).stdout.strip() == "False"


def test_a_numpy_whose_arrays_cannot_be_read_is_refused():
    code = "import numpy; numpy.__version__ = '2.4.6'; import fast_edi"
    found = subprocess.run([sys.executable, "-c", code], check=False, capture_output=True, text=True, env=os.environ)
    if fast_edi._fast_edi._reads_numpy_2:
        assert found.returncode == 0, found.stderr
    else:
        assert "ImportError" in found.stderr
        assert "expected NumPy before 2, found 2.4.6" in found.stderr
