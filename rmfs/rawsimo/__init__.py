"""RAWSim-O at the edge: what turns its files into ours.

Layouts, scenarios and controllers of its formats are read here, whole folders of them are converted
(`folder`), and its columns are matched with ours (`footprint`). The simulator imports nothing of
it: files are read through `rmfs.foreign`, by their ending.
"""
