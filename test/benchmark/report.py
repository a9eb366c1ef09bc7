#!/usr/bin/env python3
"""Prints what was asked of the package's speed and what was measured, side by side.

    report.py RESULTS_FOLDER
"""
import math
import sys

from results import Results

EVENTS = (400000, 5000000)
SCENES = ('uniform', 'edges')
DAVIS = '346x260'
BYTES_PER_EVENT, BYTES_PER_PIXEL = 12, 48


class Table:
    def __init__(self):
        self.rows = [('what', 'goal', 'measured', '')]

    def add(self, what, goal, measured, met=None):
        verdict = '' if met is None else 'met' if met else 'MISSED'
        self.rows.append((what, goal, measured, verdict))

    def missing(self, what, goal):
        self.rows.append((what, goal, 'not measured', ''))

    def text(self):
        widths = [max(len(row[i]) for row in self.rows) for i in range(4)]
        return '\n'.join(' | '.join(cell.ljust(width) for cell, width in zip(row, widths)).rstrip()
                         for row in self.rows)


def geometric_mean(values):
    return math.exp(sum(math.log(value) for value in values) / len(values))


def end_to_end(results, table):
    def rate(method, scene, size, events):
        return results.get('end_to_end/%s/periodic/%s/%s/%d' % (method, scene, size, events),
                           'Mev_per_s')
    ratios, vanilla_ratios = [], []
    for events in EVENTS:
        for scene in SCENES:
            what = 'in and closed, %s, %.1f M events, against paper' % (scene, events / 1e6)
            ours, paper = rate('ours', scene, DAVIS, events), rate('paper', scene, DAVIS, events)
            vanilla = rate('vanilla', scene, DAVIS, 5000)
            if None in (ours, paper, vanilla):
                table.missing(what, '>= 10x')
                continue
            ratios.append(ours / paper)
            vanilla_ratios.append(ours / vanilla)
            table.add(what, '>= 10x', '%.1fx (%.0f against %.1f Mev/s)' % (ratios[-1], ours, paper),
                      ratios[-1] >= 10)
    if ratios:
        table.add('  geometric mean', '>= 15x', '%.1fx' % geometric_mean(ratios),
                  geometric_mean(ratios) >= 15)
        table.add('  against vanilla EDI (its rate at 5,000 events)', '>= 3000x',
                  '%.0fx (worst of %d)' % (min(vanilla_ratios), len(vanilla_ratios)),
                  min(vanilla_ratios) >= 3000)
    for size in ('640x480', '1280x720'):
        what = 'in and closed, uniform, 5 M events, ' + size
        ours = rate('ours', 'uniform', size, EVENTS[1])
        if ours is None:
            table.missing(what, '>= 80 Mev/s')
        else:
            table.add(what, '>= 80 Mev/s', '%.0f Mev/s' % ours, ours >= 80)


def closing(results, table):
    for exposures, goals in (('periodic', (0.5, 1.0)), ('jittering', (None, None)),
                             ('unpredicted', (1.5, 12.0))):
        for events, goal in zip(EVENTS, goals):
            for scene in SCENES:
                what = 'close, %s exposures, %s, %.1f M events' % (exposures, scene, events / 1e6)
                name = 'close/ours/%s/%s/%s/%d' % (exposures, scene, DAVIS, events)
                goal_text = '' if goal is None else '<= %.1f ms' % goal
                median = results.get(name, 'close_ms')
                if median is None:
                    table.missing(what, goal_text)
                else:
                    table.add(what, goal_text, '%.2f ms (p90 %.2f)' % (
                        median, results.get(name, 'close_ms_p90')),
                              None if goal is None else median <= goal)


STAGES = (('plain/image', 'gains to image, plain EDI'),
          ('default/image', 'gains to image, default'),
          ('gain_filter', '  gain filter'),
          ('gain_filter/log_and_exp', '    alone: logarithm and exponential'),
          ('gain_filter/despeckle', '    alone: these and hot pixels'),
          ('gain_filter/smooth', '    alone: these and non-local means'),
          ('noise_estimate', '  noise estimate of the frame'),
          ('frame_noise_filter', '  frame noise filter'),
          ('copy_of_gains', 'copy of the gains for calibration'),
          ('calibration_from_a_pair', 'calibration from a pair, behind the frame'))


def stages(results, table):
    """Where the default's close spends its time."""
    for name, what in STAGES:
        times = ['%.2f' % results.get(full, 'median_ms') for full in
                 ['stages/%s/%s/%s/%d' % (name, scene, DAVIS, EVENTS[0]) for scene in SCENES]
                 if full in results.benchmarks]
        if times:
            table.add('%s, 0.4 M events, %s' % (what, ' and '.join(SCENES)), '',
                      ' and '.join(times) + ' ms')


def taking_in(results, table):
    for scene, size in (('uniform', DAVIS), ('edges', DAVIS), ('uniform', '640x480'),
                        ('uniform', '1280x720')):
        curve = results.curve('append/ours/periodic/%s/%s' % (scene, size), 'ns_per_event')
        what = 'cost of taking in an event, %s %s, 10 k to 10 M' % (scene, size)
        goal = 'within 2x' if size == DAVIS else ''
        if not curve:
            table.missing(what, goal)
            continue
        costs = [cost for _, cost in curve]
        spread = max(costs) / min(costs)
        table.add(what, goal, '%.1fx (%.1f to %.1f ns)' % (spread, min(costs), max(costs)),
                  spread <= 2 if goal else None)


def memory(results, table):
    for events in EVENTS:
        name = 'end_to_end/ours/periodic/uniform/%s/%d' % (DAVIS, events)
        what = 'memory of the container, %.1f M events' % (events / 1e6)
        used = results.get(name, 'memory_bytes')
        if used is None:
            table.missing(what, '')
            continue
        bound = (BYTES_PER_EVENT * results.get(name, 'buffered_events') +
                 BYTES_PER_PIXEL * results.get(name, 'pixels'))
        table.add(what, '<= 12 B/event + 48 B/px = %.1f MB' % (bound / 1e6),
                  '%.1f MB' % (used / 1e6), used <= bound)


def tcpros(results, table):
    for rate, array_ms in ((100, 1), (100, 10), (40, 33)):
        case = '%d Mev/s, arrays of %d ms' % (rate, array_ms)
        what = 'nodelet over TCPROS, arrays of %d ms, max_buffered_events 40 M' % array_ms
        found = results.tcpros.get(case)
        if found is None:
            table.missing(what, case)
            continue
        met = found['nothing_lost'] and found['throughput_mev_s'] >= 0.99 * rate
        table.add(what, '>= %d Mev/s, none lost' % rate,
                  '%.1f Mev/s, %s, %.0f %% of a core' % (
                      found['throughput_mev_s'],
                      'none lost' if found['nothing_lost'] else 'LOSSES (tcpros.json)',
                      100 * found['cpu_share']), met)
    for array_ms in (1, 10, 33):
        found = results.tcpros.get('as fast as it goes, arrays of %d ms' % array_ms)
        if found is not None:
            table.add('  as fast as it goes, arrays of %d ms' % array_ms, '',
                      '%.1f Mev/s, %.0f %% of a core' % (found['throughput_mev_s'],
                                                         100 * found['cpu_share']))
    found = results.tcpros.get('13 Mev/s, arrays of 10 ms')
    if found is None:
        table.missing('nodelet at 13 Mev/s', '')
        return
    table.add('nodelet at 13 Mev/s, closing until published, p50', '<= 1.5 ms',
              '%.2f ms' % found['close_p50_ms'], found['close_p50_ms'] <= 1.5)
    table.add('nodelet at 13 Mev/s, closing until published, p99', '<= 5 ms',
              '%.2f ms' % found['close_p99_ms'], found['close_p99_ms'] <= 5)
    table.add('nodelet at 13 Mev/s, share of one core', '<= 15 %',
              '%.1f %%' % (100 * found['cpu_share']), found['cpu_share'] <= 0.15)
    found = results.tcpros.get('13 Mev/s, default parameters')
    if found is None:
        table.missing('nodelet at 13 Mev/s, default parameters', '')
        return
    table.add('nodelet at 13 Mev/s, default parameters, resident memory (peak)', '<= 150 MB',
              '%.0f MB' % found['peak_resident_mb'], found['peak_resident_mb'] <= 150)
    table.add('  closing until published p50, p99, share of one core', '',
              '%.2f ms, %.2f ms, %.1f %%' % (found['close_p50_ms'], found['close_p99_ms'],
                                             100 * found['cpu_share']))


def bags(results, table):
    if results.bag is None:
        table.missing('deblur_bag', '')
        return
    table.add('deblur_bag', '>= 40 Mev/s', '%.1f Mev/s' % results.bag['deblur_mev_s'],
              results.bag['deblur_mev_s'] >= 40)
    table.add('deblur_bag against a plain rosbag copy', '>= 50 %',
              '%.0f %%' % (100 * results.bag['share_of_copy']), results.bag['share_of_copy'] >= 0.5)


def video(results, table):
    """An image's cost is the slope between 8 and 32 images for each exposure."""
    for filters in ('plain', 'without_motion', 'default'):
        costs = []
        for events in (400000, 4000000):
            names = ['video/%s/%d/%d' % (filters, events, images) for images in (8, 32)]
            times = [results.get(name, 'frame_ms') for name in names]
            images = [results.get(name, 'images') for name in names]
            if None not in times + images:
                costs.append((times[1] - times[0]) / (images[1] - images[0]))
        if len(costs) == 2:
            table.add('image of the high-rate video, %s, 0.4 M and 4 M events in an exposure' %
                      filters.replace('_', ' '), '', '%.2f and %.2f ms' % tuple(costs))
    frames = [results.get('reference/' + reference, 'frame_ms') for reference in ('mid', 'end')]
    if None not in frames:
        table.add('deblurred frame at the end of the exposure instead of its middle, 0.4 M events',
                  '', '%.2f ms more' % (frames[1] - frames[0]))


def also_measured(results, table):
    for name in ('plain_copy', 'event_lists', 'one_by_one', 'generated_message_code'):
        rate = results.get('wire_decoding/' + name, 'items_per_second')
        if rate is not None:
            table.add('wire decoding, ' + name.replace('_', ' '), '', '%.0f Mev/s' % (rate / 1e6))
    for events in EVENTS:
        name = 'end_to_end/ours_filtered/periodic/uniform/%s/%d' % (DAVIS, events)
        if name in results.benchmarks:
            table.add('with the default filters, uniform, %.1f M events' % (events / 1e6), '',
                      '%.0f Mev/s, close %.2f ms' % (results.get(name, 'Mev_per_s'),
                                                     results.get(name, 'close_ms')))
    for events in EVENTS:
        name = 'reblur/close/%d' % events
        if name in results.benchmarks:
            times = [results.get(name, method + '_ms') for method in
                     ('ours', 'ours_filtered', 'ours_reblur')]
            table.add('close, moving texture, %.1f M events: plain EDI, default, filter_reblur' %
                      (events / 1e6), '', '%.2f, %.2f and %.2f ms' % tuple(times))
    for way in ('pointer', 'serialised'):
        for events in (130000, 430000):
            rate = results.get('intra_process/%s/%d' % (way, events), 'items_per_second')
            if rate is not None:
                table.add('array of %d k events within a manager, %s' % (events / 1000, way), '',
                          '%.1f ns per event' % (1e9 / rate))
    for scene in ('hot_pixel', 'bursts'):
        rates = [results.get('end_to_end/%s/periodic/%s/%s/1000000' % (method, scene, DAVIS),
                             'Mev_per_s') for method in ('ours', 'paper')]
        if None not in rates:
            table.add('in and closed, %s, 1 M events, against paper' % scene, '',
                      '%.1fx (%.0f against %.1f Mev/s)' % (rates[0] / rates[1], *rates))
    for name, entry in results.benchmarks.items():
        if name.startswith('recording/'):
            table.add(name, '', '%.1f Mev/s, close %.2f ms' % (entry['Mev_per_s'],
                                                               entry['close_ms']))


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    results = Results(sys.argv[1])
    table = Table()
    for part in (end_to_end, closing, stages, taking_in, memory, tcpros, bags, video,
                 also_measured):
        part(results, table)
    print(table.text())
    print(results.footnote())
    for name, error in results.errors.items():
        print('%s FAILED: %s' % (name, error))
    sys.exit(1 if results.errors else 0)


if __name__ == '__main__':
    main()
