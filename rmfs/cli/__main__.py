"""Entry point of `python -m rmfs.cli`."""

import sys

from rmfs.cli import main

sys.exit(main())
