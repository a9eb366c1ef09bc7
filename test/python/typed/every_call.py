"""Calls of the whole interface, for mypy: each line with an error names the one that is expected."""
from __future__ import annotations

import pathlib

import numpy

import fast_edi

pixels = numpy.zeros((12, 16), numpy.uint8)
column = numpy.zeros(3, numpy.int64)
on, off = fast_edi.contrast_from_biases("davis346.yaml")
sharp: numpy.ndarray = fast_edi.deblur(pixels, (column, column, column, column), 0, 1000, on, off,  # type: ignore[type-arg]
                                       filter=False)
deblurrer = fast_edi.Deblurrer((16, 12), pathlib.Path("davis346.yaml"), time_unit="ns", weighting="counter")
deblurrer.add_events(column, column, column, column)
deblurrer.add_frame(pixels, 5, 1000, bayer=True)
deblurrer.finish()
for result in deblurrer.results():
    stamp: int = result.stamp
    reason: str | None = result.pass_reason
    instants: list[int] = [image.stamp for image in result.latent]
late: int = deblurrer.counters["events_late"]
waiting: float = deblurrer.status["waiting_frames"] + deblurrer.learned["event_delay_us"]
recording = fast_edi.open("demo.bag")
if recording.sensor_size is not None:
    fast_edi.Deblurrer(recording.sensor_size, latent_rate_hz=500).run(recording)
for item in recording:
    if isinstance(item, fast_edi.Frame):
        exposure: int | None = item.exposure
    elif isinstance(item, fast_edi.ImuSample):
        x, y, z = item.acceleration
    else:
        item["t"]
places: list[tuple[int, str]] = recording.damage

fast_edi.Deblurrer(16)  # type: ignore[arg-type]
fast_edi.open(5)  # type: ignore[arg-type]
deblurrer.add_frame(pixels)  # type: ignore[call-arg]
