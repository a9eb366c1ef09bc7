"""The types of the Python module, as mypy sees them."""
import pathlib
import subprocess

from conftest import ROOT

FOLDER = pathlib.Path(__file__).resolve().parent


def test_strict(tmp_path):
    """--strict also complains about an `ignore` that ignores nothing: wrong calls are found."""
    result = subprocess.run(["/usr/bin/mypy", "--strict", "--cache-dir", tmp_path,
                             ROOT / "src" / "python" / "fast_edi", FOLDER / "typed" / "every_call.py"],
                            stdout=subprocess.PIPE, text=True, check=False)
    assert result.stdout.startswith("Success"), result.stdout
