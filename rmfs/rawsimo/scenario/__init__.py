"""Readers of RAWSim-O's files: scenarios (.xsett), SKU sets (.xgenc), order lists (.xitem)."""

from rmfs.rawsimo.scenario.xgenc import read_xgenc as read_xgenc
from rmfs.rawsimo.scenario.xitem import read_xitem as read_xitem
from rmfs.rawsimo.scenario.xsett import read_xsett as read_xsett
