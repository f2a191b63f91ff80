"""The command ``stickslip``: the same code as that of the binary."""

from __future__ import annotations

import signal
import sys

from . import _core


def main() -> int:
    """Runs the command line."""
    # The command has no use for KeyboardInterrupt: whoever waits in compiled code wants to be rid of it.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _core.command(["stickslip", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
