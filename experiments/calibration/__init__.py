"""Calibration: finding the level of a parameter at which a measure has a given mean."""

from rmfs.experiments.calibration.procedure import Calibration as Calibration
from rmfs.experiments.calibration.procedure import Goal as Goal
from rmfs.experiments.calibration.procedure import Step as Step
from rmfs.experiments.calibration.procedure import calibrate as calibrate
