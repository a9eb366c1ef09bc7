#!/usr/bin/env python3
"""Draws the results of test/benchmark/run.

    plot.py RESULTS_FOLDER

Writes cost_per_event.png, close_time.png and during_and_after.png into the folder.
"""
import os
import sys

import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen before)

from results import Results  # noqa: E402

SIZES = ('346x260', '640x480', '1280x720')
COLOURS = {'346x260': 'tab:blue', '640x480': 'tab:orange', '1280x720': 'tab:green'}
VANILLA_EVENTS = 5000


def finish(figure, results, folder, name):
    figure.text(0.01, 0.005, results.footnote(), fontsize=6, color='gray')
    figure.tight_layout(rect=(0, 0.02, 1, 1))
    figure.savefig(os.path.join(folder, name), dpi=130)
    plt.close(figure)


def draw(axes, points, label, **style):
    if points:
        axes.plot([x for x, _ in points], [y for _, y in points], label=label, **style)


def cost_per_event(results, folder):
    figure, axes = plt.subplots(figsize=(8, 5))
    for size in SIZES:
        ours, paper = ('append/%s/periodic/uniform/%s' % (method, size)
                       for method in ('ours', 'paper'))
        draw(axes, results.curve(ours, 'ns_per_event'), 'fast_edi, ' + size, marker='o',
             color=COLOURS[size])
        low = results.curve(ours, 'ns_per_event_p10')
        high = results.curve(ours, 'ns_per_event_p90')
        axes.fill_between([x for x, _ in low], [y for _, y in low], [y for _, y in high],
                          color=COLOURS[size], alpha=0.2, linewidth=0)
        draw(axes, results.curve(paper, 'ns_per_event'), 'paper\'s lists, ' + size, marker='x',
             linestyle='--', color=COLOURS[size])
    axes.set(xscale='log', yscale='log', xlabel='events per exposure of 30 ms',
             ylabel='taking in one event [ns], without closing')
    axes.grid(True, which='both', alpha=0.3)
    axes.legend(fontsize=8)
    finish(figure, results, folder, 'cost_per_event.png')


def close_time(results, folder):
    figure, all_axes = plt.subplots(1, len(SIZES), figsize=(12, 4.5), sharey=True)
    for axes, size in zip(all_axes, SIZES):
        for exposures, label in (('periodic', 'fast_edi, exposure predicted'),
                                 ('jittering', 'fast_edi, prediction corrected'),
                                 ('unpredicted', 'fast_edi, exposure not predicted')):
            draw(axes, results.curve('close/ours/%s/uniform/%s' % (exposures, size), 'close_ms'),
                 label, marker='o')
        draw(axes, results.curve('close/paper/periodic/uniform/' + size, 'close_ms'),
             'paper\'s lists', marker='x', linestyle='--')
        axes.set(xscale='log', yscale='log', title=size, xlabel='events per exposure')
        axes.grid(True, which='both', alpha=0.3)
    all_axes[0].set_ylabel('last needed event to finished image [ms]')
    all_axes[0].legend(fontsize=8)
    finish(figure, results, folder, 'close_time.png')


def during_and_after(results, folder):
    """Work for one frame while its events come, and after its last one."""
    rows = []
    for events in (400000, 5000000):
        for method, exposures, label in (('ours', 'periodic', 'fast_edi'),
                                         ('ours', 'unpredicted', 'fast_edi, not predicted'),
                                         ('paper', 'periodic', 'paper\'s lists')):
            name = 'end_to_end/%s/%s/uniform/346x260/%d' % (method, exposures, events)
            if name in results.benchmarks:
                rows.append(('%s, %.1f M events' % (label, events / 1e6),
                             results.get(name, 'take_in_ms'), results.get(name, 'close_ms')))
        name = 'end_to_end/vanilla/periodic/uniform/346x260/%d' % VANILLA_EVENTS
        if name in results.benchmarks:
            rows.append(('vanilla, %.1f M events (from its rate at 5,000)' % (events / 1e6),
                         results.get(name, 'take_in_ms') * events / VANILLA_EVENTS,
                         results.get(name, 'close_ms')))
    if not rows:
        return
    figure, axes = plt.subplots(figsize=(9, 4.5))
    places = range(len(rows))
    axes.barh([place - 0.2 for place in places], [row[1] for row in rows], height=0.4,
              label='while events come')
    axes.barh([place + 0.2 for place in places], [row[2] for row in rows], height=0.4,
              label='after the last needed event')
    axes.axvline(30, color='gray', linestyle=':', label='the exposure itself')
    axes.set_yticks(list(places))
    axes.set_yticklabels([row[0] for row in rows], fontsize=8)
    axes.invert_yaxis()
    axes.set(xscale='log', xlabel='work for one frame [ms], 346x260, uniform events')
    axes.grid(True, axis='x', which='both', alpha=0.3)
    axes.legend(fontsize=8)
    finish(figure, results, folder, 'during_and_after.png')


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    folder = sys.argv[1]
    results = Results(folder)
    cost_per_event(results, folder)
    close_time(results, folder)
    during_and_after(results, folder)


if __name__ == '__main__':
    main()
