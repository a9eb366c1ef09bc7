"""Reads what the benchmark programs wrote into a results folder."""
import json
import os

PROGRAMS = ('wire_decoding', 'intra_process', 'append', 'close', 'stages', 'reblur', 'end_to_end',
            'video', 'recording')


class Results:
    """All figures of one run, by benchmark name: `end_to_end/ours/periodic/uniform/346x260/400000`."""

    def __init__(self, folder):
        self.benchmarks = {}
        self.errors = {}
        for program in PROGRAMS:
            for entry in (self._load(folder, program) or {}).get('benchmarks', []):
                name = entry['name'].split('/iterations')[0].split('/manual_time')[0]
                if entry.get('error_occurred'):
                    self.errors[name] = entry['error_message']
                else:
                    self.benchmarks[name] = entry
        self.tcpros = {entry['case']: entry for entry in self._load(folder, 'tcpros') or []}
        self.bag = self._load(folder, 'bag')
        self.machine = self._load(folder, 'machine') or {}

    @staticmethod
    def _load(folder, name):
        path = os.path.join(folder, name + '.json')
        if not os.path.exists(path) or os.path.getsize(path) == 0:
            return None
        with open(path) as file:
            return json.load(file)

    def get(self, name, counter):
        """The figure, or None where it was not measured."""
        entry = self.benchmarks.get(name)
        return None if entry is None else entry[counter]

    def curve(self, prefix, counter):
        """Points (events per exposure, figure) of the benchmarks prefix/<events>."""
        points = [(int(name.rsplit('/', 1)[1]), entry[counter])
                  for name, entry in self.benchmarks.items() if name.rsplit('/', 1)[0] == prefix]
        return sorted(points)

    def footnote(self):
        return '%s, %s; test/benchmark/run, version %s, %s' % tuple(
            self.machine.get(key, 'not known') for key in ('cpu', 'compiler', 'version', 'date'))
