"""Controllers: a protocol for each decision problem, and the rules that implement it.

Each problem has a folder (`poa`, `roa`, `rps`, `pps`, `psa`, `ta`, `sa`, `mm`, `pp`, `ca`,
`repositioning`) with its protocol in `__init__.py` and its rules in the other modules. `base`
contains the base class of all controllers, `view` the state that they may read, `decisions` the
decisions that they can make, `registry` the lookup of controllers by name, and `settings` the
controllers file.
"""

from rmfs.control.base import Controller as Controller
from rmfs.control.problems import Problem as Problem
from rmfs.control.problems import Trigger as Trigger
from rmfs.control.settings import ControllerSettings as ControllerSettings
from rmfs.control.settings import load as load
from rmfs.control.settings import load_with_notes as load_with_notes
from rmfs.control.view import View as View
