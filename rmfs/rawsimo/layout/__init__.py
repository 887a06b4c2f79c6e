"""Import of RAWSim-O's layout files: parameters (.xlayo) and explicit instances (.xinst)."""
