"""An emulated room; its robots run the program of real robots and have similar imperfections."""
