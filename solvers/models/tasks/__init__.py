"""Task allocation (TA): which robot does which task, and in which order.

- `matching`: each robot gets at most one task, by travel time (linear assignment);
- `balance`: the same, with stations balanced and due times considered (minimum-cost flow);
- `sequence`: several tasks in a row per robot, the return of one pod combined with the fetch of the
  next (routing with time windows, CP-SAT).
"""
