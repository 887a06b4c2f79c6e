"""`python -m rmfs` is the command `rmfs`."""

import sys

from rmfs.cli import main

sys.exit(main())
