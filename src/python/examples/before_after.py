"""Shows a frame before and after: before_after.py RECORDING NUMBER PICTURE.png"""
import sys

import numpy
from matplotlib import pyplot

import fast_edi

items = list(fast_edi.open(sys.argv[1]))
frame = [item for item in items if isinstance(item, fast_edi.Frame)][int(sys.argv[2])]
events = numpy.concatenate([item for item in items if isinstance(item, numpy.ndarray)])
start = frame.stamp - frame.exposure // 2
sharp = fast_edi.deblur(frame.image, events, start, start + frame.exposure,
                        contrast_threshold_on=0.26, contrast_threshold_off=0.24)
figure, axes = pyplot.subplots(1, 2, figsize=(10, 4))
for axis, image, title in zip(axes, (frame.image, sharp), ("blurry", "deblurred")):
    axis.imshow(image, cmap="gray", vmin=0, vmax=255)
    axis.set_title(title)
    axis.axis("off")
figure.savefig(sys.argv[3])
