"""Conversion of RAWSim-O's files to those of rmfs.

This package reads layouts, scenarios and controllers in RAWSim-O's formats, converts whole folders
(`folder`), and maps RAWSim-O's measures to those of rmfs (`footprint`). The simulator does not
import this package; `rmfs.foreign` chooses the reader of a file by the file's suffix.
"""
