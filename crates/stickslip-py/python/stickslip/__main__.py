"""``python -m stickslip``."""

import sys

from ._command import main

sys.exit(main())
