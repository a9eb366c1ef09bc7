#!/usr/bin/env python3
"""`evaluate`'s PIQE against `pypiqe`, and its BRISQUE against the one of OpenCV's Python wheels.

    build/peers/bin/python test/peers/measures.py [--tools DIRECTORY] [--brisque-model FOLDER]

Images are those of simulated recordings, two of each kind: blurry, deblurred (the default, and without
filters) and true frames of strong and of mild blur, in bright and in dim light, with the noise of two
sensors. PIQE and BRISQUE must agree within 2 % on each image.

- pypiqe divides an image by its brightest pixel before it begins. MATLAB's `piqe`, from which it was made,
  does not, nor does ours. So pypiqe is called with a division by 255; the last column but two says what it
  makes of the image with its own.
- BRISQUE is OpenCV's in `evaluate`, too, but of the distribution, in C++; here it is another version,
  built by somebody else, with the same two files of Debian's opencv-data.

Exit code 1: something is out of bounds.
"""
import argparse
import csv
import pathlib
import subprocess
import sys
import tempfile
from unittest import mock

import cv2
import numpy
import pypiqe
from rosbags.rosbag1 import Reader
from vendor import frame_of

ROOT = pathlib.Path(__file__).resolve().parents[2]
WHITE = 255
LARGEST_DIFFERENCE = 0.02
FRAMES = "4"
SCORED = "3-4"  # the first ones are much alike
RECORDINGS = {
    "bright, strong blur": "--texture poster --motion shake --exposure-us 25000 --tags 6",
    "bright, mild blur": "--texture page --motion mild --noise clean --sensor davis240c",
    "dim, noisy": "--texture mosaic --motion shake --illumination 0.15 --noise davis346 --exposure-us 30000",
    "faint, noisy": "--texture clouds --motion pan --contrast 0.4 --noise davis240 --sensor davis240c",
    "no noise": "--texture facade --motion spin --noise none",
}
BLURRY, TRUTH, DEBLURRED = "/dvs/image_raw", "/dvs/ground_truth/image_raw", "/dvs/deblurred/image_raw"


def run(*words):
    subprocess.run([str(word) for word in words], stdout=subprocess.DEVNULL, check=True)


def frames_in(bag, topic):
    """Pixels by stamp [us]."""
    with Reader(bag) as reader:
        return dict(frame_of(data) for connection, _, data in reader.messages() if connection.topic == topic)


def scores_of(figures):
    """(PIQE, BRISQUE) by method and stamp [us]."""
    with open(figures, encoding="utf-8", newline="") as file:
        return {(row["method"], (int(row["stamp_ns"]) + 500) // 1000): (float(row["PIQE"]), float(row["BRISQUE"]))
                for row in csv.DictReader(file)}


def piqe_by_peer(image):
    """As pypiqe is, and with DN as they are."""
    as_it_is = pypiqe.piqe(image)[0]
    with mock.patch.object(numpy, "max", return_value=WHITE):
        return as_it_is, pypiqe.piqe(image)[0]


def images_of(tools, options, folder):
    """Simulates, deblurs, evaluates. Yields name, pixels and (PIQE, BRISQUE) by evaluate."""
    bag, deblurred, plain = folder / "in.bag", folder / "deblurred.bag", folder / "plain.bag"
    thresholds = ["contrast_threshold_on:=0.2609", "contrast_threshold_off:=0.2415"]
    run(tools / "simulate_davis", "--out", bag, "--frames", FRAMES, *options.split())
    run(tools / "deblur_bag", "--in", bag, "--out", deblurred, *thresholds)
    run(tools / "deblur_bag", "--in", bag, "--out", plain, *thresholds, "filter:=false")
    run(tools / "evaluate", bag, "--output", folder / "report", "--score-frames", SCORED, *thresholds,
        "--column", f"deblurred={deblurred}", "--column", f"unfiltered={plain}")
    scores = scores_of(folder / "report" / "figures.csv")
    for method, path, topic in (("blurry input", bag, BLURRY), ("unfiltered", plain, DEBLURRED),
                                ("deblurred", deblurred, DEBLURRED), ("truth", bag, TRUTH)):
        for stamp, pixels in sorted(frames_in(path, topic).items()):
            if (method, stamp) in scores:
                yield method, numpy.ascontiguousarray(pixels), scores[method, stamp]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--tools", type=pathlib.Path, default=ROOT / "devel" / "lib" / "fast_edi",
                        help="where simulate_davis, deblur_bag and evaluate are (devel/lib/fast_edi)")
    parser.add_argument("--brisque-model", type=pathlib.Path, default=pathlib.Path("/usr/share/opencv4/quality"),
                        help="folder with brisque_model_live.yml and brisque_range_live.yml")
    arguments = parser.parse_args()
    model, ranges = (str(arguments.brisque_model / f"brisque_{what}_live.yml") for what in ("model", "range"))
    faults = []
    compared = 0
    print(f"OpenCV {cv2.__version__}\n\n| recording | image | brightest [DN] | PIQE | pypiqe | difference | pypiqe, "
          "divided | BRISQUE | OpenCV's |\n|---|---|---:|---:|---:|---:|---:|---:|---:|")
    for name, options in RECORDINGS.items():
        with tempfile.TemporaryDirectory() as folder:
            images = list(images_of(arguments.tools, options, pathlib.Path(folder)))
        if len(images) != 8:
            faults.append(f"{name}: {len(images)} images with scores, expected 8")
        for method, pixels, (piqe, brisque) in images:
            divided, peer = piqe_by_peer(pixels)
            brisque_by_peer = cv2.quality.QualityBRISQUE_compute(pixels, model, ranges)[0]
            print(f"| {name} | {method} | {pixels.max()} | {piqe:.3f} | {peer:.3f} | {100 * (piqe / peer - 1):+.2f} % "
                  f"| {divided:.3f} | {brisque:.3f} | {brisque_by_peer:.3f} |")
            compared += 1
            faults += [f"{name}, {method}: {measure} {ours}, theirs {theirs}" for measure, ours, theirs in
                       (("PIQE", piqe, peer), ("BRISQUE", brisque, brisque_by_peer))
                       if abs(ours - theirs) > LARGEST_DIFFERENCE * abs(theirs)]
    print("\n".join(faults) or f"{compared} images within the bounds")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
