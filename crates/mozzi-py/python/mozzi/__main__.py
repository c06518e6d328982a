"""The command ``mozzi``, also ``python -m mozzi``."""

import signal
import sys

from ._mozzi import _command_line


def main() -> int:
    """Run the command line; return its exit code."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)  # Ctrl-C is for the command, not for Python
    return _command_line(["mozzi", *sys.argv[1:]])


if __name__ == "__main__":
    sys.exit(main())
