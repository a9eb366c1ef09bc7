"""Draws the results of test/load/run and test/load/soak into their folder."""
import matplotlib
matplotlib.use('Agg')
import matplotlib.pyplot as plt  # noqa: E402 (the backend has to be chosen before)

TITLES = {'in_process': 'in one process', 'tcp': 'over TCP'}


def finish(figure, folder, name):
    path = folder / (name + '.png')
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)
    return path


def draw_load(report, part, folder):
    """Memory and latency over time, one column for each load. Returns the file."""
    levels = report['levels']
    figure, axes = plt.subplots(2, len(levels), figsize=(4 * len(levels) + 1, 6), squeeze=False,
                                sharey='row')
    before_mb = report.get('before_mb', 0)
    for column, level in enumerate(levels):
        memory, latency = axes[:, column]
        memory.set_title('%gx, %.1f Mev/s, %s' % (
            level['factor'], level['events'] / level['seconds'] / 1e6, TITLES[part]), fontsize=9)
        memory.plot([t for t, _ in level['memory_mb']],
                    [mb - before_mb for _, mb in level['memory_mb']], label='resident memory')
        memory.axhline(report['bound_mb'], color='tab:red', linestyle='--', label='bound')
        memory.set_ylim(bottom=0)
        latency.plot([t for t, _ in level['latency_ms']], [ms for _, ms in level['latency_ms']],
                     '.', markersize=3, label='%d deblurred, %d passed through'
                     % (level['deblurred'], level['passed']))
        latency.set_xlabel('time [s]')
        for panel in (memory, latency):
            panel.grid(alpha=0.3)
            panel.legend(fontsize=7)
    axes[0, 0].set_ylabel('memory [MB]')
    axes[1, 0].set_ylabel('frame in to frame out [ms]')
    return finish(figure, folder, part)


def draw_soak(report, folder):
    """Memory and latency over the whole time, coloured by what arrived. Returns the file."""
    figure, (memory, latency) = plt.subplots(2, 1, figsize=(10, 6), sharex=True)
    memory.plot([t / 60 for t, _ in report['memory_mb']], [mb for _, mb in report['memory_mb']],
                linewidth=0.8, label='resident memory, %+.0f kB/h' % report['slope_kb_h'])
    memory.axhline(report['bound_mb'], color='tab:red', linestyle='--', label='bound')
    memory.set(ylabel='memory [MB]', ylim=(0, None))
    for name in sorted({segment['name'] for segment in report['segments']}):
        points = [(segment['start_s'] / 60, segment['p50_ms'], segment['p99_ms'])
                  for segment in report['segments'] if segment['name'] == name]
        line, = latency.plot([t for t, _, _ in points], [ms for _, ms, _ in points], 'o-',
                             markersize=3, label=name + ', p50')
        latency.plot([t for t, _, _ in points], [ms for _, _, ms in points], 'x', markersize=3,
                     color=line.get_color())
    latency.set(xlabel='time [min]', ylabel='frame in to frame out [ms] (x: p99)', yscale='log')
    for panel in (memory, latency):
        panel.grid(alpha=0.3)
        panel.legend(fontsize=7)
    return finish(figure, folder, 'soak')
