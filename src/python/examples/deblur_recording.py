"""Deblurs a recording into PNGs: deblur_recording.py RECORDING FOLDER"""
import pathlib
import sys

from PIL import Image

import fast_edi

recording = fast_edi.open(sys.argv[1])
folder = pathlib.Path(sys.argv[2])
folder.mkdir()
deblurrer = fast_edi.Deblurrer(recording.sensor_size, contrast_threshold_on=0.26,
                               contrast_threshold_off=0.24)
for number, result in enumerate(deblurrer.run(recording)):
    Image.fromarray(result.image).save(folder / f"{number:06d}.png")
    if not result.deblurred:
        print(f"frame {number} is as it came: {result.pass_reason}")
print(f"{deblurrer.counters['frames_deblurred']} frames deblurred")
