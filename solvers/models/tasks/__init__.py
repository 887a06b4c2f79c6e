"""Task allocation (TA): which robot does which task, and in which order.

- `matching`: each robot gets at most one task, by travel time (linear assignment);
- `balance`: like `matching`, but balances the queues of stations and considers due times
  (minimum-cost flow);
- `sequence`: each robot gets a sequence of tasks, in which the storing of one pod is combined with
  the fetching of the next (routing with time windows, CP-SAT).
"""
