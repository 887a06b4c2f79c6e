"""Reader of RAWSim-O's controller configurations (.xconf)."""

from rmfs.control.rawsimo.xconf import read_xconf as read_xconf
