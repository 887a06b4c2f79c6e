"""Leaves these tests out where the extra `learning` is not installed."""

from importlib.util import find_spec

if any(find_spec(name) is None for name in ("cma", "gymnasium", "pettingzoo")):
    collect_ignore_glob = ["test_*.py"]
