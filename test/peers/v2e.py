#!/usr/bin/env python3
"""Sequences of a sensor model that is not ours: v2e (SensorsINI), with frames and truth beside its events.

    /usr/bin/python3 test/peers/v2e.py simulate CHECKOUT OUT.npz [--kind ideal|real] [--seed N] [--frames N]
    build/peers/bin/python test/peers/v2e.py bag IN.npz OUT.bag

CHECKOUT is a clone of https://github.com/SensorsINI/v2e. `simulate` needs Debian's python3-torch,
python3-h5py and python3-numba; what v2e imports for windows and files of its own is left out. The camera
shakes before a picture of rectangles, discs and stripes. Every 125 us v2e's emulator gets a rendering; the
mean of those of an exposure, with read noise, is the frame. `ideal`: 2 % mismatch, no noise, no bandwidth;
`real`: 3 % mismatch, 200 Hz, leak and shot noise. Thresholds are 0.2.

`bag` writes events, frames (stamped with the middle of the exposure) and exposures on the driver's topics,
and true frames of the start and of the middle of each exposure, stamped with these, on
/dvs/ground_truth/image_raw.
"""
import argparse
import pathlib
import struct
import sys
from unittest import mock

import numpy

WIDTH, HEIGHT = 346, 260
STEP_US = 125
PERIOD_US, EXPOSURE_US, LEAD_US = 40000, 20000, 20000
START_US = 1700000000 * 10**6
READ_NOISE_DN = 1.5
THRESHOLD = 0.2
KINDS = {"ideal": {"sigma_thres": 0.02 * THRESHOLD, "cutoff_hz": 0, "leak_rate_hz": 0.0, "shot_noise_rate_hz": 0.0},
         "real": {"sigma_thres": 0.03 * THRESHOLD, "cutoff_hz": 200, "leak_rate_hz": 0.1, "shot_noise_rate_hz": 1.0}}
EVENT_ARRAY = """std_msgs/Header header
uint32 height
uint32 width
dvs_msgs/Event[] events
================================================================================
MSG: dvs_msgs/Event
uint16 x
uint16 y
time ts
bool polarity
"""


def picture(random, side=700):
    """Shapes in DN, smoothed as by a lens."""
    y, x = numpy.mgrid[:side, :side].astype(numpy.float32)
    dn = numpy.full((side, side), 110.0, numpy.float32)
    for _ in range(160):
        cx, cy = random.uniform(0, side, 2)
        a, b = random.uniform(8, 60, 2)
        turn = random.uniform(0, numpy.pi)
        u = (x - cx) * numpy.cos(turn) + (y - cy) * numpy.sin(turn)
        v = (y - cy) * numpy.cos(turn) - (x - cx) * numpy.sin(turn)
        level = random.uniform(25, 210)
        kind = random.integers(3)
        inside = (u / a)**2 + (v / b)**2 < 1.0 if kind == 0 else (abs(u) < a) & (abs(v) < b)
        shade = level if kind < 2 else level * (0.6 + 0.4 * (numpy.sin(u) > 0.0))
        dn = numpy.where(inside, shade, dn)
    weights = numpy.exp(-numpy.arange(-3, 4)**2 / (2.0 * 0.7**2))
    for axis in (0, 1):
        dn = numpy.apply_along_axis(numpy.convolve, axis, dn, weights / weights.sum(), mode="same")
    return dn.astype(numpy.float32)


class Camera:
    """Renders the picture as it is seen at an instant [us]."""

    def __init__(self, torch, random):
        self.torch = torch
        self.image = torch.from_numpy(picture(random))[None, None]
        self.side = self.image.shape[-1]
        rows, columns = torch.meshgrid(torch.arange(HEIGHT, dtype=torch.float32),
                                       torch.arange(WIDTH, dtype=torch.float32), indexing="ij")
        self.x, self.y = columns - WIDTH / 2, rows - HEIGHT / 2
        # Amplitude, frequency [Hz] and phase of shift along x and y [px], and of the turn [rad].
        self.swings = [[(amplitude * random.uniform(0.5, 1.0), random.uniform(1.0, 6.0), random.uniform(0.0, 6.3))
                        for _ in range(3)] for amplitude in (22.0, 22.0, 0.05)]

    def at(self, t_us):
        dx, dy, turn = (sum(a * numpy.sin(2e-6 * numpy.pi * hz * t_us + phase) for a, hz, phase in swings)
                        for swings in self.swings)
        c, s = numpy.cos(turn), numpy.sin(turn)
        grid = self.torch.stack([c * self.x - s * self.y + dx, s * self.x + c * self.y + dy], -1) * 2.0 / self.side
        return self.torch.nn.functional.grid_sample(self.image, grid[None], align_corners=False)[0, 0].numpy()


def emulator(checkout, kind, seed):
    """v2e's, without windows."""
    for name in ("cv2", "screeninfo", "easygui", "tkinter", "engineering_notation", "dv_processing"):
        sys.modules[name] = mock.MagicMock()
    sys.path.insert(0, str(checkout))
    from v2ecore.emulator import EventEmulator
    return EventEmulator(pos_thres=THRESHOLD, neg_thres=THRESHOLD, seed=seed, device="cpu",
                         refractory_period_s=0.0, **KINDS[kind])


def simulate(arguments):
    import torch
    random = numpy.random.default_rng(arguments.seed)
    camera = Camera(torch, random)
    v2e = emulator(arguments.checkout, arguments.kind, arguments.seed)
    events, frames, starts, middles = [], [], [], []
    total = None
    for t_us in range(0, LEAD_US + arguments.frames * PERIOD_US, STEP_US):
        seen = camera.at(t_us)
        new = v2e.generate_events(seen, t_us * 1e-6)
        if new is not None and len(new) > 0:
            events.append(numpy.asarray(new))
        since = (t_us - LEAD_US) % PERIOD_US if t_us >= LEAD_US else None
        if since == 0:
            starts.append(seen)
            total = numpy.zeros_like(seen)
        if since is not None and since <= EXPOSURE_US:
            total += seen * (0.5 if since in (0, EXPOSURE_US) else 1.0)  # by trapezoids
        if since == EXPOSURE_US // 2:
            middles.append(seen)
        if since == EXPOSURE_US:
            mean = total * STEP_US / EXPOSURE_US
            frames.append(mean + random.normal(0.0, READ_NOISE_DN, mean.shape))
    rows = numpy.concatenate(events)
    rows = rows[numpy.argsort(rows[:, 0], kind="stable")]

    def in_dn(images):
        return numpy.clip(numpy.rint(images), 0, 255).astype(numpy.uint8)
    numpy.savez(arguments.out, t_us=START_US + numpy.rint(rows[:, 0] * 1e6).astype(numpy.int64),
                x=rows[:, 1].astype(numpy.uint16), y=rows[:, 2].astype(numpy.uint16), on=rows[:, 3] > 0,
                frames=in_dn(frames), starts=in_dn(starts), middles=in_dn(middles))
    print(f"{arguments.out}: {len(frames)} frames, {len(rows)} events")


def header(t_us):
    return struct.pack("<III", 0, t_us // 10**6, t_us % 10**6 * 1000) + struct.pack("<I", 0)


def image_message(pixels, t_us):
    height, width = pixels.shape
    return (header(t_us) + struct.pack("<III", height, width, 5) + b"mono8" + struct.pack("<BII", 0, width, pixels.size)
            + pixels.tobytes())


def event_array(rows, t_us):
    return header(t_us) + struct.pack("<III", HEIGHT, WIDTH, len(rows)) + rows.tobytes()


def bag(arguments):
    from rosbags.rosbag1 import Writer
    data = numpy.load(arguments.simulated)
    rows = numpy.empty(len(data["t_us"]), numpy.dtype("<u2,<u2,<u4,<u4,u1"))
    for name, column in zip(rows.dtype.names, (data["x"], data["y"], data["t_us"] // 10**6,
                                               data["t_us"] % 10**6 * 1000, data["on"])):
        rows[name] = column
    messages = []  # record time, topic, bytes; recorded as a driver would: after what they tell
    end = START_US + LEAD_US + len(data["frames"]) * PERIOD_US
    for t_us in range(START_US, end, 10000):
        first, last = numpy.searchsorted(data["t_us"], (t_us, t_us + 10000))
        messages.append((t_us + 11000, "/dvs/events", event_array(rows[first:last], t_us)))
    for i, (frame, start, middle) in enumerate(zip(data["frames"], data["starts"], data["middles"])):
        start_us = START_US + LEAD_US + i * PERIOD_US
        middle_us, read_us = start_us + EXPOSURE_US // 2, start_us + EXPOSURE_US + 5000
        messages += [(read_us, "/dvs/image_raw", image_message(frame, middle_us)),
                     (read_us, "/dvs/ground_truth/image_raw", image_message(start, start_us)),
                     (read_us, "/dvs/ground_truth/image_raw", image_message(middle, middle_us)),
                     (read_us + 100, "/dvs/exposure", struct.pack("<i", EXPOSURE_US))]
    kinds = {"/dvs/events": ("dvs_msgs/msg/EventArray", EVENT_ARRAY, "5e8beee5a6c107e504c2e78903c224b8")}
    for topic in ("/dvs/image_raw", "/dvs/ground_truth/image_raw"):
        kinds[topic] = ("sensor_msgs/msg/Image", None, None)
    kinds["/dvs/exposure"] = ("std_msgs/msg/Int32", None, None)
    from rosbags.typesys import Stores, get_typestore
    store = get_typestore(Stores.ROS1_NOETIC)
    with Writer(arguments.out) as writer:
        connections = {topic: writer.add_connection(topic, kind, msgdef=text, md5sum=md5sum) if text
                       else writer.add_connection(topic, kind, typestore=store)
                       for topic, (kind, text, md5sum) in kinds.items()}
        for t_us, topic, message in sorted(messages, key=lambda message: message[0]):
            writer.write(connections[topic], t_us * 1000, message)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True)
    one = commands.add_parser("simulate")
    one.add_argument("checkout", type=pathlib.Path)
    one.add_argument("out")
    one.add_argument("--kind", choices=KINDS, default="real")
    one.add_argument("--seed", type=int, default=1)
    one.add_argument("--frames", type=int, default=12)
    one.set_defaults(call=simulate)
    two = commands.add_parser("bag")
    two.add_argument("simulated")
    two.add_argument("out", type=pathlib.Path)
    two.set_defaults(call=bag)
    arguments = parser.parse_args()
    arguments.call(arguments)


if __name__ == "__main__":
    main()
