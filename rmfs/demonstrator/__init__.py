"""Physical or emulated robots in place of simulated ones (as in the RAWSim-O paper, section 4)."""
