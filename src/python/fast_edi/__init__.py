"""Deblurring of event-camera frames by the event-based double integral, from arrays.

Times are integers in `time_unit`: "us" (the default, as in dv-processing, tonic and Prophesee's files)
or "ns" (as in ROS). Images are arrays of uint8 or uint16 of shape (height, width), or (height, width, 3
or 4) for colour, whose last sample is alpha where there are four. Parameters are those of the package's
YAML files, by the same names and in the same units.

Wrong input raises TypeError or ValueError, which name the argument, what was found and what was
expected; nothing of that input is used then, and the object works on. Methods may be called from
several threads; they work without the interpreter's lock.

The method: Pan et al., CVPR 2019, as lists per pixel by Lin et al., ICRA 2023.
"""
from __future__ import annotations

import operator
import os
from typing import TYPE_CHECKING, Any, Iterator, NamedTuple, Union

import numpy

from . import _fast_edi, _pictures
from ._fast_edi import __version__

if TYPE_CHECKING:
    Array = numpy.ndarray[Any, Any]
    Path = Union[str, os.PathLike[str]]

__all__ = ["Deblurrer", "Frame", "ImuSample", "LatentImage", "Recording", "Result", "__version__",
           "contrast_from_biases", "deblur", "open"]

_UNITS_NS = {"us": 1000, "ns": 1}
# Fields of structured arrays as they are called by others.
_FIELDS = (("x", ("x",)), ("y", ("y",)), ("t", ("t", "timestamp", "ts")), ("p", ("p", "polarity", "pol")))


class LatentImage(NamedTuple):
    """One image of the high-rate video (parameter latent_images, or latent_rate_hz)."""

    stamp: int
    image: Array


class Result(NamedTuple):
    """What became of a frame."""

    image: Array
    """Sharp image, or a copy of the frame where it was passed through; shape and dtype of the frame."""
    stamp: int
    """The instant that `image` shows (parameter reference)."""
    input_stamp: int
    """The stamp that the frame came with."""
    deblurred: bool
    pass_reason: str | None
    """Why the frame was passed through unchanged, for people; None when it was deblurred."""
    exposure: tuple[int, int] | None
    """Start and end of the exposure; None when it is not known."""
    events: int
    """Events within the exposure."""
    latent: list[LatentImage]
    """Images of the high-rate video, those since the frame before included."""


class Frame(NamedTuple):
    """A frame of a recording."""

    image: Array | None
    """None where its size contradicts its encoding."""
    stamp: int
    """As recorded; the middle of the exposure where that is known."""
    exposure: int | None
    """Length of the exposure; None when it was not recorded."""
    encoding: str
    """As in sensor_msgs/image_encodings.h, e.g. "mono8" or "bayer_rggb8"."""


class ImuSample(NamedTuple):
    """A sample of the camera's inertial sensor."""

    t: int
    acceleration: tuple[float, float, float]
    """[m/s^2]"""
    angular_velocity: tuple[float, float, float]
    """[rad/s]"""


class Deblurrer:
    """Events and frames in as they come, one result for each frame out."""

    def __init__(self, sensor_size: tuple[int, int], config: Path | None = None, *,
                 time_unit: str = "us", latent_rate_hz: int = 0, **parameters: Any) -> None:
        """
        sensor_size: (width, height) of the event pixels [px]
        config: a YAML file such as those in cfg/
        time_unit: "us" or "ns"
        latent_rate_hz: latent images at all multiples of 1 / latent_rate_hz, where events tell them;
            0: as many for each exposure as the parameter latent_images says
        parameters: keys of the YAML files, replacing those of `config`; without either, only
            contrast_threshold_on and contrast_threshold_off [natural log], or biases, must be given

        Raises ValueError for unknown keys and values out of range, and OSError or ValueError when
        `config` cannot be read.
        """
        try:
            width, height = (_integer("sensor_size", side, bits=32) for side in sensor_size)
        except (TypeError, ValueError):
            raise TypeError(f"sensor_size is {sensor_size!r}, expected (width, height)") from None
        self._deblurrer = _fast_edi.Deblurrer(width, height, _unit_ns(time_unit),
                                              _integer("latent_rate_hz", latent_rate_hz, bits=32),
                                              _readable("config", config) if config is not None else "",
                                              parameters)
        self.time_unit = time_unit
        """Of all times that go in and come out."""

    def add_events(self, x: Any, y: Any = None, t: Any = None, p: Any = None, *,
                   lost_arrays: int = 0) -> None:
        """
        Takes events in the order of time, origin top left.

        Either four arrays of shape (n,) of any integer dtype and stride: pixel (x, y), time t in
        time_unit, polarity p (0 or -1: darker, 1: brighter). Or one structured array with fields x,
        y, t (or timestamp, ts) and p (or polarity, pol). The arrays are not used after the call. An
        event older than those of earlier calls is dropped and counted (counters["events_late"]),
        unless the clock has been set back: see max_backward_jump_ms.

        lost_arrays: arrays that lie before these, but did not arrive: frames that need their events are
            passed through

        Raises TypeError or ValueError for unequal lengths, pixels outside of the sensor, times that
        decrease within the arrays and other polarities.
        """
        lost = _integer("lost_arrays", lost_arrays, bits=32)
        if lost < 0:
            raise ValueError(f"lost_arrays is {lost_arrays}, expected 0 or more")
        self._deblurrer.add_events(*_columns("x", x, y, t, p), lost)

    def add_frame(self, image: Any, stamp: int, exposure: int | None = None, *,
                  bayer: bool = False) -> None:
        """
        Takes a frame. Its pixels are copied, since it waits for the events of its exposure.

        image: uint8 or uint16 of shape (height, width), or (height, width, 3 or 4)
        stamp: the instant of the exposure that the parameter stamp_reference names (default: its
            middle), in time_unit
        exposure: its length in time_unit, 1 us to 1 s; None if it is not known, or the same for
            all frames, as the parameter exposure_time_us says
        bayer: each element of `image` is a photosite of a colour mosaic

        A frame that cannot be deblurred, for instance because its size is not the sensor's, comes
        out unchanged; Result.pass_reason says why.
        """
        self._deblurrer.add_frame(_native("image", image), _integer("stamp", stamp),
                                  None if exposure is None else _integer("exposure", exposure),
                                  bool(bayer))

    def finish(self) -> None:
        """Closes the frames that wait with the events that have come: the end of a recording."""
        self._deblurrer.finish()

    def results(self) -> Iterator[Result]:
        """What was finished since the last call, in order. A frame is finished by the first event
        behind its exposure, by close_timeout_ms (of the times that come in) or by finish()."""
        for image, stamp, input_stamp, deblurred, reason, exposure, events, latent in self._deblurrer.take():
            yield Result(image, stamp, input_stamp, deblurred, reason, exposure, events,
                         [LatentImage(*item) for item in latent])

    def run(self, recording: Recording) -> Iterator[Result]:
        """The results of a whole recording, opened with the same time_unit.

        Where the recording has the exposure of each frame, stamp_reference and exposure_source are not
        used. Raises ValueError for a recording that was opened with another time_unit."""
        if recording.time_unit != self.time_unit:
            raise ValueError(f"time_unit of the recording {recording.path} is {recording.time_unit!r}, expected "
                             f"{self.time_unit!r} as of this Deblurrer")
        if recording.knows_exposures:
            self._deblurrer.use_recorded_exposures()
        for item in recording:
            if isinstance(item, Frame):
                if item.image is not None:
                    self.add_frame(item.image, item.stamp, item.exposure,
                                   bayer=item.encoding.startswith("bayer"))
            elif not isinstance(item, ImuSample):
                self.add_events(item, lost_arrays=recording.lost_arrays)
            yield from self.results()
        self.finish()
        yield from self.results()

    @property
    def counters(self) -> dict[str, Any]:
        """Counts since construction, e.g. "events_late"; "frames_passed" counts by reason."""
        return self._deblurrer.counters()

    @property
    def status(self) -> dict[str, float]:
        """The moment's buffered_events, buffer_bytes and waiting_frames."""
        status = self._deblurrer.status()
        return {key: status[key] for key in ("buffered_events", "buffer_bytes", "waiting_frames")}

    @property
    def learned(self) -> dict[str, float]:
        """contrast_threshold_on, contrast_threshold_off [natural log] and event_delay_us in force:
        as given, or as learned since (parameters refine_contrast, refine_delay)."""
        status = self._deblurrer.status()
        return {key: status[key] for key in
                ("contrast_threshold_on", "contrast_threshold_off", "event_delay_us")}


def deblur(image: Any, events: Any, exposure_start: int, exposure_end: int,
           contrast_threshold_on: float | None = None, contrast_threshold_off: float | None = None, *,
           config: Path | None = None, time_unit: str = "us", bayer: bool = False,
           **parameters: Any) -> Array:
    """
    One frame without its blur, of the shape and dtype of `image`.

    image: as for Deblurrer.add_frame()
    events: a structured array or (x, y, t, p), as for Deblurrer.add_events(): all events of the
        exposure; those before and behind it may be among them
    exposure_start, exposure_end: the exposure [start, end), in time_unit
    contrast_threshold_on, contrast_threshold_off: [natural log]; from `config` if not given
    config, parameters: as for Deblurrer

    Raises TypeError or ValueError for what cannot be used.
    """
    start = _integer("exposure_start", exposure_start)
    exposure = _integer("exposure_end", exposure_end) - start
    if exposure <= 0:
        raise ValueError(f"exposure_end is {exposure_end}, expected later than exposure_start "
                         f"({exposure_start})")
    for name, value in (("contrast_threshold_on", contrast_threshold_on),
                        ("contrast_threshold_off", contrast_threshold_off)):
        if value is not None:
            parameters[name] = value
    for name, setting in (("stamp_reference", "start"), ("exposure_source", "topic")):
        if name in parameters:
            raise ValueError(f"{name} is given, but deblur() is told the exposure itself")
        parameters[name] = setting
    pixels = _native("image", image)
    if pixels.ndim < 2:
        raise ValueError(f"image has the shape {pixels.shape}, expected (height, width)")
    columns = _columns("events", *(events if isinstance(events, (tuple, list)) else (events,)))
    deblurrer = Deblurrer((pixels.shape[1], pixels.shape[0]), config, time_unit=time_unit, **parameters)
    first = int(columns[2][0]) if columns[2].ndim == 1 and columns[2].size else start
    inner = deblurrer._deblurrer
    inner.begin_at(max(0, min(first, start)))
    inner.add_events(*columns, 0)
    deblurrer.add_frame(pixels, start, exposure, bayer=bayer)
    inner.end_at(start + exposure)
    deblurrer.finish()
    for result in deblurrer.results():
        if result.deblurred or parameters.get("passthrough"):
            return result.image
        raise ValueError(f"the frame cannot be deblurred: {result.pass_reason}")
    raise ValueError(f"exposure_start is {exposure_start}, expected a time that fits the events")


class Recording:
    """A recording of any format that is read: an iterator of events, frames and samples.

    Items come in the order in which they were recorded: structured arrays with the fields x, y
    (uint16), t (int64, in time_unit) and p (uint8), Frame, and ImuSample. Of recordings with several
    cameras, those of the first one.
    """

    def __init__(self, recording: _fast_edi.Recording, path: str, time_unit: str) -> None:
        self._recording = recording
        self.path = path
        self.time_unit = time_unit
        """Of the times of its items."""
        self.format = recording.format()
        streams = list(enumerate(recording.streams()))
        events = next((stream for _, stream in streams if stream[0] == "events"), None)
        self.sensor_size: tuple[int, int] | None = (events[3], events[4]) if events else None
        """(width, height) of the event pixels; None without events."""
        self._streams = set()
        for kind in ("events", "frame", "imu"):
            mine = [(stream[1] != "frames", number) for number, stream in streams if stream[0] == kind
                    and (events is None or stream[2] == events[2])]
            if mine:
                # A camera's own frames come before those that programs made of its events.
                self._streams.add(min(mine)[1])
        self.lost_arrays = 0
        """Arrays right before the last events that the recorder did not get, as far as it tells."""
        self.knows_exposures = recording.knows_exposures()
        """The recording has the exposure of each frame, whose middle is then the frame's stamp."""
        self.biases = recording.biases()
        """Of the camera, where they were recorded: for Deblurrer(biases=...)."""

    def __iter__(self) -> Iterator[Array | Frame | ImuSample]:
        while (item := self._recording.next()) is not None:
            stream, kind, content = item
            if stream not in self._streams:
                continue
            if kind == "events":
                events, self.lost_arrays = content
                yield events
            else:
                yield Frame(*content) if kind == "frame" else ImuSample(*content)

    @property
    def damage(self) -> list[tuple[int, str]]:
        """(byte in the file, what is wrong) of places that could not be read, so far."""
        return self._recording.damage()


def open(path: Path, *, time_unit: str = "us") -> Recording:
    """
    Opens a recording by its content: AEDAT4, AEDAT3.1, AEDAT2 and rosbag2 (ROS 2); rosbags of ROS 1, HDF5,
    and folders or zip archives of pictures with text where the module was built with ROS. Compressed frames
    are decoded; without ROS that needs Pillow, and Recording.damage says where it is missing.

    Raises OSError when it cannot be read, ValueError when it is no recording that is read.
    """
    name = _readable("path", path, folder=True)
    unit_ns = _unit_ns(time_unit)
    recording = _fast_edi.open_recording(name, unit_ns, _pictures.decode)
    missing = ""
    if recording is None:
        try:
            from . import _bags
        except ImportError as error:
            missing = f"; rosbags of ROS 1, HDF5 and pictures need the catkin package ({error})"
        else:
            recording = _bags.open_recording(name, unit_ns)
    if recording is None:
        raise ValueError(f"{name} is no recording that is read: it is neither AEDAT4, AEDAT3.1, AEDAT2 "
                         f"nor rosbag2, nor a rosbag, HDF5, or folder or archive of pictures with text{missing}")
    return Recording(recording, name, time_unit)


def contrast_from_biases(path: Path) -> tuple[float, float]:
    """
    Contrast thresholds (on, off) [natural log] that the biases in a YAML file stand for: a
    configuration with a map `biases`, or the file of the driver davis_ros_driver.

    By Nozaki & Delbruck, 2017; see fast_edi/calibration/contrast_from_bias.hpp. Raises OSError or
    ValueError.
    """
    return _fast_edi.contrast_from_biases(_readable("path", path))


def _unit_ns(time_unit: Any) -> int:
    if not isinstance(time_unit, str) or time_unit not in _UNITS_NS:
        raise ValueError(f"time_unit is {time_unit!r}, expected 'us' or 'ns'")
    return _UNITS_NS[time_unit]


def _integer(name: str, value: Any, bits: int = 64) -> int:
    try:
        result = operator.index(value)
    except TypeError:
        raise TypeError(f"{name} is {value!r}, expected an integer") from None
    if abs(result) >= 2**(bits - 1):
        raise ValueError(f"{name} is {value!r}, expected an integer of {bits} bits")
    return result


def _readable(name: str, path: Any, folder: bool = False) -> str:
    try:
        text = os.fspath(path)
    except TypeError:
        raise TypeError(f"{name} is {path!r}, expected a path") from None
    if folder and os.path.isdir(text):
        os.listdir(text)  # as below
        return os.fsdecode(text)
    with os.fdopen(os.open(text, os.O_RDONLY), "rb") as file:
        file.read(1)  # raises OSError for what cannot be read, a folder included
    return os.fsdecode(text)


def _native(name: str, values: Any) -> Array:
    """An array in this machine's byte order; without a copy if it is one already."""
    array = numpy.asarray(values)
    if array.dtype.hasobject:
        raise TypeError(f"{name} has dtype {array.dtype}, expected an array of numbers")
    if array.dtype.isnative:
        return array
    return array.astype(array.dtype.newbyteorder("="))


def _columns(name: str, *arrays: Any) -> tuple[Array, Array, Array, Array]:
    """x, y, t and p of a structured array or of four arrays."""
    given = [array for array in arrays if array is not None]
    if len(given) == 1:
        events = numpy.asarray(given[0])
        fields = events.dtype.names
        if fields is None:
            raise TypeError(f"{name} has dtype {events.dtype}, expected a structured array with the "
                            "fields x, y, t and p, or four arrays")
        given = []
        for field, names in _FIELDS:
            found = next((known for known in names if known in fields), None)
            if found is None:
                raise TypeError(f"{name} has the fields {', '.join(fields)}, expected {field} among "
                                f"them ({' or '.join(names)})")
            given.append(events[found])
    if len(given) != len(_FIELDS):
        raise TypeError(f"{len(given)} arrays of events are given, expected one structured array or "
                        "the four x, y, t and p")
    x, y, t, p = (_native(field, array) for (field, _), array in zip(_FIELDS, given))
    return x, y, t, p
