"""What the tests of the Python module share."""
import pathlib

import pytest

import fast_edi

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def pytest_addoption(parser):
    parser.addoption("--long", action="store_true",
                     help="all modes on bags/demo.bag as well, and memory over 10,000 frames")


@pytest.fixture(scope="session")
def is_long(request):
    return request.config.getoption("--long")


@pytest.fixture(scope="session")
def tools():
    """Folder of the package's programs, of the space that the module is imported from."""
    space = next(folder for folder in pathlib.Path(fast_edi.__file__).resolve().parents
                 if (folder / "lib" / "fast_edi").is_dir())
    return space / "lib" / "fast_edi"
