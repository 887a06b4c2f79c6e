"""The experiment that is disturbed: six runs."""

DESIGN = """
format = "rmfs-design/1"
name = "tiny"
seeds = [1, 2, 3]
keep = ["series"]
[base]
layout = "small"
scenario = "small"
controllers = "default"
[factors]
"controllers.psa" = ["nearest", "random"]
"""
