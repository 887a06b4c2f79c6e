"""Conversion of RAWSim-O's files to those of rmfs.

This package reads layouts, scenarios and controllers in RAWSim-O's formats, converts whole folders
(`folder`), and maps its measures to those of rmfs (`footprint`). The simulator does not import it;
files are read through `rmfs.foreign`, by their suffix.
"""
