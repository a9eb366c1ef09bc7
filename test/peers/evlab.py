#!/usr/bin/env python3
"""Faults that `evlab corrupt` puts into events: what they cost this package and plain EDI.

    build/peers/bin/python test/peers/evlab.py [--tools DIRECTORY] [--recording BAG]... [--types KIND,...]
                                               [--output FOLDER] [-- PARAMETER:=VALUE...]

evlab (PyPI) models six faults of event cameras: bursts of noise, readout congestion, dead regions, flicker,
hot pixels and wrong polarities, each in episodes that cover 45 % of the recording ("high" severity). Events
of two simulated sequences (or of each --recording, with true frames on /dvs/ground_truth/image_raw and its
thresholds behind `--`; v2e.py writes such bags) are exchanged for those that evlab makes of them; frames,
exposures and true frames stay. `evaluate` then judges the clean recording and each corrupted one.

Exit code 1: this package's frames are more than 0.1 dB below the blurry ones (mean PSNR), or are missing.
"""
import argparse
import csv
import pathlib
import statistics
import subprocess
import sys

import numpy
from messages import EVENT, Fields, events_of
from rosbags.rosbag1 import Reader, Writer

ROOT = pathlib.Path(__file__).resolve().parents[2]
EVLAB = pathlib.Path(sys.executable).parent / "evlab"
KINDS = ("burst", "congestion", "dead-region", "flicker", "hot-pixels", "polarity")
METHODS = ("blurry input", "plain EDI", "ours")
EVENTS = "/dvs/events"
SEQUENCES = {
    "poster, panned": "--texture poster --motion pan --exposure-us 20000 --seed 7",
    "natural, shaken": "--texture natural --motion shake --exposure-us 15000 --motion-scale 0.6 --seed 8",
}
FRAMES = "8"
THRESHOLDS = ["contrast_threshold_on:=0.2609", "contrast_threshold_off:=0.2415"]
SEED = "3"  # of evlab's episodes
MOST_BELOW_BLURRY_DB = 0.1


def run(*words):
    result = subprocess.run([str(word) for word in words], stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            check=False)
    if result.returncode != 0:
        raise SystemExit(f"{words[0]} ended with {result.returncode}: {result.stdout[-2000:]}")


def save_events(bag, out):
    """All events of a bag in the form that evlab reads. Returns how many."""
    with Reader(bag) as reader:
        arrays = [events_of(data) for connection, _, data in reader.messages() if connection.topic == EVENTS]
    if not arrays:
        raise SystemExit(f"{bag}: no events on {EVENTS}")
    width, height = arrays[0][1]
    t, x, y, p = (numpy.concatenate(columns) for columns in zip(*(columns for columns, _ in arrays)))
    order = numpy.argsort(t, kind="stable")
    numpy.savez(out, x=x[order], y=y[order], t=t[order], p=p[order], width=width, height=height)
    return len(t)


def rows_of(path):
    """Events that evlab wrote, as records of an event array, and their times [us]."""
    with numpy.load(path) as data:
        events = data["events"]
    t = events["t"]
    rows = numpy.empty(len(t), EVENT)
    for name, column in (("x", events["x"]), ("y", events["y"]), ("s", t // 10**6), ("ns", t % 10**6 * 1000),
                         ("on", events["p"] > 0)):
        rows[name] = column
    return rows, t


def with_events(array, rows):
    """The same event array with other events."""
    fields = Fields(array)
    fields.stamp_us()
    fields.text()
    fields.number()
    fields.number()
    return fields.data[:fields.place] + numpy.uint32(len(rows)).tobytes() + rows.tobytes()


def write_bag(source, events, out):
    """`source` with other events, shared out to its arrays by the time of each one's first event. Returns how many."""
    rows, times = rows_of(events)
    with Reader(source) as reader, Writer(out) as writer:
        starts = [columns[0][0] for columns, _ in (events_of(data) for connection, _, data in reader.messages()
                                                   if connection.topic == EVENTS) if len(columns[0])]
        parts = iter(numpy.split(rows, numpy.searchsorted(times, starts[1:])))
        connections = {connection.id: writer.add_connection(connection.topic, connection.msgtype,
                                                            msgdef=connection.msgdef.data, md5sum=connection.digest)
                       for connection in reader.connections}
        for connection, recorded_ns, data in reader.messages():
            if connection.topic == EVENTS and len(events_of(data)[0][0]):
                data = with_events(data, next(parts))
            writer.write(connections[connection.id], recorded_ns, bytes(data))
    return len(rows)


def psnr_of(tools, bag, output, parameters):
    """Mean PSNR of each method, and the number of frames."""
    run(tools / "evaluate", bag, "--force", "--full-reference-only", "--output", output, *parameters)
    by_method = {}
    with open(output / "figures.csv", encoding="utf-8", newline="") as file:
        for row in csv.DictReader(file):
            if row["PSNR"]:
                by_method.setdefault(row["method"], []).append(float(row["PSNR"]))
    return [statistics.mean(by_method[method]) for method in METHODS], len(by_method["ours"])


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "devel" / "lib" / "fast_edi",
                        help="where simulate_davis and evaluate are (devel/lib/fast_edi)")
    parser.add_argument("--recording", type=pathlib.Path, action="append", default=[], help="may be repeated")
    parser.add_argument("--types", default=",".join(KINDS), help="kinds of faults, each in a recording of its own")
    parser.add_argument("--output", type=pathlib.Path, default=ROOT / "build" / "peers" / "evlab_out")
    parser.add_argument("parameters", nargs="*", help="of this package (after --); thresholds of each --recording")
    arguments = parser.parse_args()
    faults = []
    print("| sequence | faults | events | blurry | plain EDI | ours | ours against blurry |\n"
          "|---|---|---:|---:|---:|---:|---:|")
    for name, options in ({path.stem: None for path in arguments.recording} or SEQUENCES).items():
        folder = arguments.output / name.replace(" ", "_").replace(",", "")
        folder.mkdir(parents=True, exist_ok=True)
        clean = folder / "clean.bag"
        if options:
            run(arguments.tools / "simulate_davis", "--out", clean, "--force", "--frames", FRAMES, *options.split())
        else:
            clean = next(path for path in arguments.recording if path.stem == name)
        events, bag = save_events(clean, folder / "clean.npz"), clean
        parameters = [*(THRESHOLDS if options else []), *arguments.parameters]
        expected = None
        for kind in ("none", *arguments.types.split(",")):
            if kind != "none":
                bag, corrupted = folder / f"{kind}.bag", folder / f"{kind}.npz"
                for path in (bag, corrupted):
                    path.unlink(missing_ok=True)
                run(EVLAB, "corrupt", folder / "clean.npz", corrupted, "--types", kind, "--severity", "high", "--seed",
                    SEED)
                events = write_bag(clean, corrupted, bag)
            (blurry, plain, ours), frames = psnr_of(arguments.tools, bag, folder / f"{kind}_report", parameters)
            print(f"| {name} | {kind} | {events} | {blurry:.2f} | {plain:.2f} | {ours:.2f} "
                  f"| {ours - blurry:+.2f} |", flush=True)
            expected = expected or frames
            if frames != expected:
                faults.append(f"{name}, {kind}: {frames} frames, expected {expected}")
            if ours < blurry - MOST_BELOW_BLURRY_DB:
                faults.append(f"{name}, {kind}: {ours:.2f} dB, blurry frames {blurry:.2f} dB")
    print("\n".join(faults) or "nowhere below the blurry frames")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
