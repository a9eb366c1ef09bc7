#!/usr/bin/env python3
"""Writes hdf5/ by h5py (python3-h5py) from vendor_none.aedat4, in the layouts of public data sets.

    . devel/setup.bash
    python3 test/data/recordings/write_hdf5.py

The chunks of blosc.h5 are compressed by libblosc (libblosc1); reading them takes HDF5's plugin for it.
"""
import ctypes
import pathlib

import h5py
import numpy

import fast_edi

FOLDER = pathlib.Path(__file__).resolve().parent
BLOSC = 32001  # number of the filter
BLOSC_CHUNK = 1024


def read():
    """Columns t [us], x, y, p and the frames."""
    blocks, frames = [], []
    for item in fast_edi.open(FOLDER / "vendor_none.aedat4", time_unit="us"):
        if isinstance(item, fast_edi.Frame):
            frames.append(item)
        elif isinstance(item, numpy.ndarray):
            blocks.append(item)
    events = numpy.concatenate(blocks)
    return events["t"], events["x"], events["y"], events["p"], frames


def write_dsec(path, t, x, y, p, **options):
    """https://dsec.ifi.uzh.ch/data-format"""
    offset = int(t[0]) // 1000 * 1000
    relative = t - offset
    with h5py.File(path, "w") as file:
        file["t_offset"] = numpy.int64(offset)
        ms = numpy.arange(relative.max() // 1000 + 1) * 1000
        file.create_dataset("ms_to_idx", data=numpy.searchsorted(relative, ms).astype("u8"), **options)
        for name, values, kind in (("t", relative, "u4"), ("x", x, "u2"), ("y", y, "u2"), ("p", p, "u1")):
            file.create_dataset(f"events/{name}", data=values.astype(kind), **options)


def write_event_utils(path, t, x, y, p, frames, **options):
    """https://github.com/TimoStoff/event_utils; with the exposures of REBlur."""
    with h5py.File(path, "w") as file:
        columns = (("ts", t / 1e6, "f8"), ("xs", x, "i2"), ("ys", y, "i2"), ("ps", p > 0, "?"))
        for name, values, kind in columns:
            file.create_dataset(f"events/{name}", data=values.astype(kind), maxshape=(None,), **options)
        for i, frame in enumerate(frames):
            start = frame.stamp - frame.exposure // 2
            image = file.create_dataset(f"images/image{i:09d}", data=frame.image)
            image.attrs["size"] = frame.image.shape
            image.attrs["timestamp"] = frame.stamp / 1e6
            image.attrs["type"] = "greyscale"
            image.attrs["exposure_start"] = start / 1e6
            image.attrs["exposure_end"] = (start + frame.exposure) / 1e6
        file.attrs["num_events"] = len(t)
        file.attrs["sensor_resolution"] = frames[0].image.shape


def write_mvsec(path, t, x, y, p, frames, **options):
    """https://daniilidis-group.github.io/mvsec"""
    rows = numpy.stack([x, y, t / 1e6, numpy.where(p > 0, 1.0, -1.0)], axis=1)
    with h5py.File(path, "w") as file:
        file.create_dataset("davis/left/events", data=rows, **options)
        file["davis/left/image_raw"] = numpy.stack([frame.image for frame in frames])
        file["davis/left/image_raw_ts"] = numpy.array([frame.stamp / 1e6 for frame in frames])


def write_v2e(path, t, x, y, p, **options):
    """https://github.com/SensorsINI/v2e: times from 0"""
    rows = numpy.stack([t - t[0] // 1000 * 1000, x, y, p], axis=1).astype("u4")
    with h5py.File(path, "w") as file:
        file.create_dataset("events", data=rows, **options)


def write_e2calib(path, t, x, y, p):
    """https://github.com/uzh-rpg/e2calib"""
    with h5py.File(path, "w") as file:
        for name, values, kind in (("x", x, "u2"), ("y", y, "u2"), ("t", t, "i8"), ("p", p, "u1")):
            file.create_dataset(name, data=values.astype(kind), compression="gzip", shuffle=True,
                                fletcher32=True)


def write_blosc(path, t, x, y, p):
    """The layout of DSEC with the filter that DSEC uses, without any need for it here."""
    blosc = ctypes.CDLL("libblosc.so.1")
    level, shuffle, overhead = 5, 1, 16

    def compressed(values):
        room = ctypes.create_string_buffer(values.nbytes + overhead)
        size = blosc.blosc_compress(level, shuffle, ctypes.c_size_t(values.itemsize),
                                    ctypes.c_size_t(values.nbytes), values.tobytes(), room,
                                    ctypes.c_size_t(len(room)))
        return room.raw[:size]

    offset = int(t[0]) // 1000 * 1000
    with h5py.File(path, "w") as file:
        file["t_offset"] = numpy.int64(offset)
        events = file.create_group("events")
        for name, values, kind in (("t", t - offset, "u4"), ("x", x, "u2"), ("y", y, "u2"), ("p", p, "u1")):
            values = values.astype(kind)
            create = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
            create.set_chunk((BLOSC_CHUNK,))
            create.set_filter(BLOSC, h5py.h5z.FLAG_OPTIONAL,
                              (2, 2, values.itemsize, BLOSC_CHUNK * values.itemsize, level, shuffle))
            column = h5py.h5d.create(events.id, name.encode(), h5py.h5t.py_create(values.dtype),
                                     h5py.h5s.create_simple(values.shape), create)
            for first in range(0, len(values), BLOSC_CHUNK):
                chunk = numpy.zeros(BLOSC_CHUNK, values.dtype)
                part = values[first:first + BLOSC_CHUNK]
                chunk[:len(part)] = part
                column.write_direct_chunk((first,), compressed(chunk))


def main():
    t, x, y, p, frames = read()
    folder = FOLDER / "hdf5"
    folder.mkdir(exist_ok=True)
    gzip = {"compression": "gzip"}
    write_dsec(folder / "dsec.h5", t, x, y, p, **gzip)
    write_event_utils(folder / "event_utils.h5", t, x, y, p, frames, **gzip)
    write_mvsec(folder / "mvsec.hdf5", t, x, y, p, frames, **gzip)
    write_v2e(folder / "v2e.h5", t, x, y, p, **gzip)
    write_e2calib(folder / "e2calib.h5", t, x, y, p)
    write_blosc(folder / "blosc.h5", t, x, y, p)


if __name__ == "__main__":
    main()
