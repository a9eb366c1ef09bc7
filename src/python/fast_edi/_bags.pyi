"""The compiled part that needs ROS and OpenCV."""
from typing import Optional

from ._fast_edi import Recording

def open_recording(path: str, unit_ns: int) -> Optional[Recording]: ...
