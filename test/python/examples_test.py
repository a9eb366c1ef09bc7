"""The examples of the Python module run, and are as short as they are said to be."""
import os
import re
import subprocess
import sys

import numpy
import pytest
from conftest import ROOT
from PIL import Image

FOLDER = ROOT / "src" / "python" / "examples"
MOST_LINES = 30
EXPOSURE_MS = 20
FRAMES = 4
NUMBER = 2


@pytest.fixture(scope="module")
def recording(tools, tmp_path_factory):
    path = tmp_path_factory.mktemp("recording") / "recording.aedat4"
    subprocess.run([tools / "simulate_davis", "--out", path, "--frames", str(FRAMES), "--width", "120",
                    "--height", "90", "--exposure-us", str(EXPOSURE_MS * 1000)],
                   check=True, stdout=subprocess.DEVNULL)
    return path


def run(*command, cwd=ROOT):
    return subprocess.run([sys.executable, *map(str, command)], check=True, cwd=cwd, text=True,
                          stdout=subprocess.PIPE, env=dict(os.environ, MPLBACKEND="Agg")).stdout


@pytest.mark.parametrize("path", sorted(FOLDER.glob("*.py")), ids=lambda path: path.stem)
def test_length(path):
    assert len(path.read_text().splitlines()) <= MOST_LINES


def test_recording_to_pictures(recording, tmp_path):
    out = run(FOLDER / "deblur_recording.py", recording, tmp_path / "images")
    assert out == f"{FRAMES} frames deblurred\n"
    images = [numpy.array(Image.open(path)) for path in sorted((tmp_path / "images").iterdir())]
    assert [image.shape for image in images] == [(90, 120)] * FRAMES


def test_before_and_after(recording, tmp_path):
    run(FOLDER / "before_after.py", recording, NUMBER, tmp_path / "picture.png")
    picture = numpy.array(Image.open(tmp_path / "picture.png").convert("L"))
    left, right = numpy.array_split(picture, 2, axis=1)
    gradients = [numpy.abs(numpy.diff(half.astype(float), axis=1)).mean() for half in (left, right)]
    assert gradients[1] > gradients[0]


def test_film(recording, tmp_path):
    out = run(FOLDER / "film.py", recording, NUMBER, tmp_path / "film.gif")
    with Image.open(tmp_path / "film.gif") as film:
        assert film.n_frames == EXPOSURE_MS * 500 // 1000
        assert out == f"{film.n_frames} images of an exposure of {EXPOSURE_MS}.0 ms\n"


def test_lines_of_the_page():
    """Those that need no arrays of the reader's."""
    blocks = re.findall(r"^```python\n(.*?)^```", (FOLDER.parent / "README.md").read_text(),
                        re.MULTILINE | re.DOTALL)
    lines = [run("-c", block) for block in blocks if "import fast_edi" in block]
    assert [text.count("(260, 346)") for text in lines] == [30]
