"""CA by a model: schedules which robot charges when, where and for how long."""

from rmfs.solvers.control.charging.controller import ScheduleControl as ScheduleControl
