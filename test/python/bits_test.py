"""The Python module gives the bits that deblur_bag writes."""
import subprocess

import numpy
import pytest
import rosbag
from conftest import ROOT

import fast_edi

CONTRAST = {"contrast_threshold_on": 0.25, "contrast_threshold_off": 0.25}
MODES = {
    "default": {},
    "plain": {"filter": False},
    "reference end": {"reference": "end"},
    "counter": {"weighting": "counter"},
    "video": {"latent_images": 3},
}
DEMO = ROOT / "bags" / "demo.bag"


@pytest.fixture(scope="module")
def simulated(tools, tmp_path_factory):
    """AEDAT4 of a small sensor: quick to deblur in each mode."""
    path = tmp_path_factory.mktemp("simulated") / "simulated.aedat4"
    subprocess.run([tools / "simulate_davis", "--out", path, "--frames", "12", "--width", "120",
                    "--height", "90"], check=True, stdout=subprocess.DEVNULL)
    return path


def text(value):
    return str(value).lower() if isinstance(value, bool) else str(value)


def images(bag, topic):
    """(stamp [ns], pixels) of each image of a topic."""
    return [(message.header.stamp.to_nsec(),
             numpy.frombuffer(message.data, numpy.uint8).reshape(message.height, message.width))
            for _, message, _ in bag.read_messages(topics=[topic])]


def require_bits_of_deblur_bag(path, parameters, tools, folder):
    """Returns how many latent images were compared."""
    parameters = {**CONTRAST, **parameters}
    subprocess.run([tools / "deblur_bag", "--in", path, "--out", folder / "out.bag",
                    "--compression", "none",
                    *(f"{key}:={text(value)}" for key, value in parameters.items())],
                   check=True, stdout=subprocess.DEVNULL)
    with rosbag.Bag(str(folder / "out.bag")) as bag:
        expected = images(bag, "/dvs/deblurred/image_raw")
        expected_latent = images(bag, "/dvs/latent/image_raw")
    recording = fast_edi.open(path, time_unit="ns")
    results = list(fast_edi.Deblurrer(recording.sensor_size, time_unit="ns",
                                      **parameters).run(recording))
    assert [result.stamp for result in results] == [stamp for stamp, _ in expected]
    assert sum(result.deblurred for result in results) > len(results) * 2 / 3
    for result, (_, image) in zip(results, expected):
        assert numpy.array_equal(result.image, image)
    latent = [image for result in results for image in result.latent]
    assert [image.stamp for image in latent] == [stamp for stamp, _ in expected_latent]
    for image, (_, pixels) in zip(latent, expected_latent):
        assert numpy.array_equal(image.image, pixels)
    return len(latent)


@pytest.mark.parametrize("mode", MODES)
def test_bits_of_deblur_bag(mode, simulated, tools, tmp_path):
    latent = require_bits_of_deblur_bag(simulated, MODES[mode], tools, tmp_path)
    assert bool(latent) == (mode == "video")


def test_bits_of_deblur_bag_on_the_demo(is_long, tools, tmp_path):
    for mode in MODES if is_long else ("default",):
        folder = tmp_path / mode
        folder.mkdir()
        latent = require_bits_of_deblur_bag(DEMO, MODES[mode], tools, folder)
        assert bool(latent) == (mode == "video")


def test_recorded_exposures_come_before_parameters(simulated, tools, tmp_path):
    require_bits_of_deblur_bag(simulated, {"stamp_reference": "start", "exposure_time_us": 1000,
                                           "exposure_source": "parameter"}, tools, tmp_path)


def test_lost_event_arrays(tools, tmp_path):
    path = tmp_path / "simulated.bag"
    subprocess.run([tools / "simulate_davis", "--out", path, "--frames", "6", "--width", "64", "--height", "48",
                    "--exposure-us", "35000", "--fault", "dropped-arrays=1"], check=True, stdout=subprocess.DEVNULL)
    recording = fast_edi.open(path)
    deblurrer = fast_edi.Deblurrer(recording.sensor_size, **CONTRAST)
    reasons = [result.pass_reason for result in deblurrer.run(recording) if not result.deblurred]
    assert reasons == ["events missing in the exposure"]
    assert deblurrer.counters["event_arrays_missing"] == 1


def test_folders_of_pictures(simulated, tools, tmp_path):
    folder = tmp_path / "pictures"
    subprocess.run([tools / "convert_recording", simulated, folder], check=True,
                   stdout=subprocess.DEVNULL)
    frames = [[item.image for item in fast_edi.open(path) if isinstance(item, fast_edi.Frame)]
              for path in (simulated, folder)]
    assert len(frames[0]) == 12
    assert all(numpy.array_equal(a, b) for a, b in zip(*frames))
