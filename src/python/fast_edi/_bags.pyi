"""The compiled part that needs ROS and OpenCV."""
from typing import Any, Optional, Tuple, Union

import numpy

from ._fast_edi import Recording

def open_recording(path: str, unit_ns: int) -> Optional[Recording]: ...
def decode_picture(format: str, data: bytes) -> Union[Tuple[numpy.ndarray[Any, Any], str], str]: ...
