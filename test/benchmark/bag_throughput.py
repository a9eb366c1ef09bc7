#!/usr/bin/env python3
"""Measures deblur_bag against a plain copy of the same bag through rosbag's C++ API.

Bags lie in memory (/dev/shm). Runs alternate, medians count. Writes JSON.

    bag_throughput.py RESULTS.json [--seconds 4] [--rate 13] [--repeats 3]
"""
import argparse
import json
import os
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

import roslib.packages

MEMORY_FOLDER = '/dev/shm'
RUN_TIMEOUT_S = 300
WIRE_EVENT_BYTES = 13
#: Input, and one output at a time; the rest is images and index.
BAGS_AT_ONCE = 2.2


def find_program(name):
    found = roslib.packages.find_node('fast_edi', name)
    if not found:
        sys.exit('fast_edi/%s was not found: was devel/setup.bash sourced and the target built?'
                 % name)
    return found[0]


def run(arguments):
    return subprocess.run(arguments, check=True, timeout=RUN_TIMEOUT_S, text=True,
                          stdout=subprocess.PIPE).stdout


def main():
    parser = argparse.ArgumentParser(description=__doc__,
                                     formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('results')
    parser.add_argument('--seconds', type=float, default=4, help='length of the recording')
    parser.add_argument('--rate', type=float, default=13, help='event rate [Mev/s]')
    parser.add_argument('--repeats', type=int, default=3)
    arguments = parser.parse_args()
    bag_tool, deblur_bag = find_program('bag_tool'), find_program('deblur_bag')

    events = arguments.seconds * arguments.rate * 1e6
    needed = BAGS_AT_ONCE * events * WIRE_EVENT_BYTES
    free = shutil.disk_usage(MEMORY_FOLDER).free
    if free < needed:
        sys.exit('%s has %.1f GB free, %.1f GB are needed: use a smaller --seconds'
                 % (MEMORY_FOLDER, free / 1e9, needed / 1e9))

    copy_s, deblur_s, summary = [], [], ''
    with tempfile.TemporaryDirectory(dir=MEMORY_FOLDER) as folder:
        recording, output = os.path.join(folder, 'in.bag'), os.path.join(folder, 'out.bag')
        run([bag_tool, 'make', recording, str(arguments.seconds), str(arguments.rate)])
        size_mb = os.path.getsize(recording) / 1e6
        for _ in range(arguments.repeats):
            copy_s.append(json.loads(run([bag_tool, 'copy', recording, output]))['seconds'])
            os.remove(output)
            begin = time.monotonic()
            summary = run([deblur_bag, '--threads', '1', 'filter:=false', '--in', recording, '--out', output,
                           'contrast_threshold_on:=0.3', 'contrast_threshold_off:=0.3'])
            deblur_s.append(time.monotonic() - begin)
            os.remove(output)

    result = {
        'events': events,
        'recording_mb': size_mb,
        'copy_s': copy_s,
        'deblur_s': deblur_s,
        'deblur_mev_s': events / statistics.median(deblur_s) / 1e6,
        'share_of_copy': statistics.median(copy_s) / statistics.median(deblur_s),
        'summary': re.sub(r'\x1b\[[0-9;]*m', '', summary),
    }
    print('deblur_bag %.1f Mev/s, %.0f %% of a plain copy (%.0f MB)' % (
        result['deblur_mev_s'], 100 * result['share_of_copy'], size_mb))
    with open(arguments.results, 'w') as out:
        json.dump(result, out, indent=1)


if __name__ == '__main__':
    main()
