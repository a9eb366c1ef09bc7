#!/usr/bin/env python3
"""iniVation's own client (NetworkReader) receives events and frames, and tells when.

    build/peers/bin/python test/peers/paced_client.py --events PORT --frames PORT

Prints `connected`, then, when its standard input ends, a JSON list: [last event's time [us], time] of each packet
of events, with the clock that paced_server.py uses. Asks for packets all the time: nothing is faster.
"""
import argparse
import json
import os
import sys
import threading
import time

import dv_processing as dv


CONNECT_TIMEOUT_S = 60


def connect(port):
    """Tries until the server, which reads its recording first, is there."""
    deadline = time.monotonic() + CONNECT_TIMEOUT_S
    while True:
        try:
            return dv.io.NetworkReader("127.0.0.1", port)
        except RuntimeError:
            if time.monotonic() > deadline:
                raise
            time.sleep(0.1)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--events", type=int, required=True, metavar="PORT")
    parser.add_argument("--frames", type=int, required=True, metavar="PORT")
    arguments = parser.parse_args()
    events, frames = connect(arguments.events), connect(arguments.frames)
    print("connected", flush=True)
    ended = threading.Event()
    threading.Thread(target=lambda: (sys.stdin.read(), ended.set()), daemon=True).start()
    found = []
    while not ended.is_set():
        store = events.getNextEventBatch()
        if store is not None:
            found.append([store.getHighestTime(), time.monotonic()])
            frames.getNextFrame()
    print(json.dumps(found), flush=True)
    os._exit(0)  # without the library's own end, which may wait for ever


if __name__ == "__main__":
    main()
