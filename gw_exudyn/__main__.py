"""`python -m gw_exudyn`, the same as the command `gw-exudyn`."""

import sys

from gw_exudyn.cli import main

if __name__ == "__main__":
    sys.exit(main())
