"""Physical or emulated robots in place of simulated ones (paper, section 4)."""
