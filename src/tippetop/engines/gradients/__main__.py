"""Measure derivatives by the launch: ``python -m tippetop.engines.gradients``."""

import sys

from tippetop.engines.gradients import LAUNCH_GRADIENTS

LAUNCH_GRADIENTS.run(sys.argv[1:])
