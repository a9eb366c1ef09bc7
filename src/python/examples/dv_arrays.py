"""Frames and events of dv_processing straight in: dv_arrays.py RECORDING.aedat4 IMAGES.npy"""
import sys

import dv_processing as dv
import numpy

import fast_edi

reader = dv.io.MonoCameraRecording(sys.argv[1])
deblurrer = fast_edi.Deblurrer(reader.getEventResolution(), stamp_reference="start",
                               contrast_threshold_on=0.26, contrast_threshold_off=0.24)
images = []
frame = reader.getNextFrame()
while (events := reader.getNextEventBatch()) is not None:
    deblurrer.add_events(events.numpy())
    while frame is not None and frame.timestamp <= events.getHighestTime():
        deblurrer.add_frame(frame.image, frame.timestamp, frame.exposure // numpy.timedelta64(1, "us"))
        frame = reader.getNextFrame()
    images += [result.image for result in deblurrer.results()]
deblurrer.finish()
images += [result.image for result in deblurrer.results()]
numpy.save(sys.argv[2], images)
