"""Readers of RAWSim-O's files: scenarios (.xsett), SKU sets (.xgenc), order lists (.xitem)."""

from rmfs.scenario.rawsimo.xgenc import read_xgenc as read_xgenc
from rmfs.scenario.rawsimo.xitem import read_xitem as read_xitem
from rmfs.scenario.rawsimo.xsett import read_xsett as read_xsett
