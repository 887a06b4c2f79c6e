"""Entry point of `python -m rmfs`, which is the command `rmfs`."""

import sys

from rmfs.cli import main

sys.exit(main())
