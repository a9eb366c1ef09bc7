"""The recording on which deblur_bag is measured: options of simulate_davis, and its thresholds."""

RECORDING = ("--texture", "mosaic", "--motion", "shake", "--motion-scale", "0.7", "--seed", "5", "--period-us",
             "33000", "--exposure-us", "10000")
THRESHOLDS = ("contrast_threshold_on:=0.2609", "contrast_threshold_off:=0.2415")
