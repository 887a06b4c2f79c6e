"""A room with robots that are as unkind as real ones; they run the robots' own program."""
