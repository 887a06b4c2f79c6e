"""Physical or emulated robots in place of simulated ones (RAWSim-O paper, section 4)."""
