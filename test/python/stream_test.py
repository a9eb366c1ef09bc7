"""The Python module over long streams and in several threads."""
import os
import threading

import numpy
import pytest

import fast_edi

CONTRAST = {"contrast_threshold_on": 0.25, "contrast_threshold_off": 0.25}
SIZE = (32, 24)
PERIOD_US = 10_000
EVENTS = 300


def columns(number, offset=0):
    """x, y, t, p of the events of a period."""
    index = numpy.arange(EVENTS)
    return ((index * 7 + number) % SIZE[0], index % SIZE[1],
            number * PERIOD_US + index * PERIOD_US // EVENTS + offset, index % 2)


def play(deblurrer, numbers):
    """The images of one frame in each period."""
    image = numpy.arange(SIZE[0] * SIZE[1], dtype=numpy.uint16).reshape(SIZE[1], SIZE[0]) % 200
    images = []
    for number in numbers:
        deblurrer.add_events(*columns(number))
        deblurrer.add_frame(image.astype(numpy.uint8), number * PERIOD_US + PERIOD_US // 2, PERIOD_US // 2)
        images += [result.image for result in deblurrer.results()]
    return images


def resident_bytes():
    with open("/proc/self/statm", encoding="ascii") as file:
        return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def test_memory_stays(is_long):
    frames = 10_000 if is_long else 1_000
    deblurrer = fast_edi.Deblurrer(SIZE, **CONTRAST)
    play(deblurrer, range(100, 600))
    before = resident_bytes()
    play(deblurrer, range(600, 600 + frames))
    assert resident_bytes() - before < 2 * 2**20
    assert deblurrer.counters["frames_in"] == 500 + frames
    assert deblurrer.status["waiting_frames"] <= 1


def test_results_that_are_not_taken_are_kept():
    deblurrer = fast_edi.Deblurrer(SIZE, **CONTRAST)
    for number in range(100, 110):
        deblurrer.add_events(*columns(number))
        deblurrer.add_frame(numpy.full(SIZE[::-1], 9, numpy.uint8), number * PERIOD_US + 5_000, 5_000)
    deblurrer.finish()
    assert [result.stamp for result in deblurrer.results()] == [
        number * PERIOD_US + 5_000 for number in range(100, 110)]
    assert not list(deblurrer.results())


def in_threads(*functions):
    """Runs them at the same time; raises what one of them raises."""
    errors = []

    def guarded(function):
        try:
            function()
        except BaseException as error:  # handed to the caller
            errors.append(error)

    threads = [threading.Thread(target=guarded, args=(function,)) for function in functions]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if errors:
        raise errors[0]


def test_objects_in_threads_do_not_disturb_each_other():
    expected = play(fast_edi.Deblurrer(SIZE, **CONTRAST), range(100, 160))
    found = [[], []]
    in_threads(*(lambda images=images: images.extend(play(fast_edi.Deblurrer(SIZE, **CONTRAST), range(100, 160)))
                 for images in found))
    for images in found:
        assert numpy.array_equal(images, expected)


def test_one_object_in_several_threads():
    deblurrer = fast_edi.Deblurrer(SIZE, **CONTRAST)
    done = threading.Event()
    images = []

    def watch():
        while not done.is_set():
            assert deblurrer.counters["frames_in"] >= 0 and deblurrer.status["buffer_bytes"] >= 0

    def feed():
        try:
            images.extend(play(deblurrer, range(100, 200)))
        finally:
            done.set()

    in_threads(watch, feed)
    assert len(images) in (99, 100)  # the last one waits for an event behind it


def test_arrays_that_another_thread_changes():
    """Either the events are taken, or the error names what was found."""
    deblurrer = fast_edi.Deblurrer(SIZE, **CONTRAST)
    x, y, t, p = columns(100)
    done = threading.Event()

    def scribble():
        while not done.is_set():
            x[:] = 70_000
            x[:] = 0

    def feed():
        try:
            for _ in range(300):
                try:
                    deblurrer.add_events(x, y, t, p)
                except ValueError as error:
                    assert str(error).startswith("x[")
        finally:
            done.set()

    in_threads(scribble, feed)
    x[:] = 0
    deblurrer.add_events(x, y, t + PERIOD_US, p)
    assert deblurrer.counters["events_in"] % EVENTS == 0


@pytest.mark.parametrize("jump_us", [-50_000_000, 50_000_000])
def test_clocks_that_jump(jump_us):
    deblurrer = fast_edi.Deblurrer(SIZE, **CONTRAST)
    start = 100 - min(0, jump_us) // PERIOD_US
    play(deblurrer, range(start, start + 5))
    after = start + 5 + jump_us // PERIOD_US
    images = play(deblurrer, range(after, after + 5))
    assert deblurrer.counters["event_time_jumps"] == 1
    assert numpy.array_equal(images[-2:], play(fast_edi.Deblurrer(SIZE, **CONTRAST), range(after, after + 5))[-2:])
