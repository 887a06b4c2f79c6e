"""Physical or emulated robots in place of simulated ones.

Merschformann, Xie and Li (2018, section 4) describe the corresponding demonstrator of RAWSim-O.
"""
