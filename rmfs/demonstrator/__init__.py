"""Physical or emulated robots in place of simulated ones (Merschformann, Xie and Li 2018).

Section 4 of their paper describes the demonstrator of RAWSim-O.
"""
