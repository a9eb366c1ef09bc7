"""The recording on which deblur_bag is measured: options of simulate_davis, and its thresholds; a stopwatch."""

import resource
import subprocess
import time

RECORDING = ("--texture", "mosaic", "--motion", "shake", "--motion-scale", "0.7", "--seed", "5", "--period-us",
             "33000", "--exposure-us", "10000")
THRESHOLDS = ("contrast_threshold_on:=0.2609", "contrast_threshold_off:=0.2415")
TIMEOUT_S = 600


def run(*words, **options):
    """What a command prints."""
    return subprocess.run([str(word) for word in words], check=True, timeout=TIMEOUT_S, text=True,
                          stdout=subprocess.PIPE, **options).stdout


def timed(*words, **options):
    """Seconds of a command by the clock and of the processor, and what it prints."""
    before, begin = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
    text = run(*words, **options)
    seconds = time.monotonic() - begin
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return seconds, after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime, text
