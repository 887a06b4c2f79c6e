"""Reader of RAWSim-O's controller configurations (.xconf)."""

from rmfs.rawsimo.control.xconf import read_xconf as read_xconf
