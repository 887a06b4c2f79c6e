"""An emulated room whose robots have the imperfections of real ones and run the same program."""
