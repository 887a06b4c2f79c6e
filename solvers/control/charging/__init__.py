"""CA by a model: who charges when, where and for how long, over a look-ahead."""

from rmfs.solvers.control.charging.controller import ScheduleControl as ScheduleControl
