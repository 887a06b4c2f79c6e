"""Pod storage assignment (PSA): where a pod waits for its next visit.

- `placement`: assigns a batch of returning pods to free places, counting the cost of next visits;
- `zones`: assigns classes of pods to zones in the steady state, with congestion; its prices rate
  places;
- `stays`: assigns pods whose next visits are known to zones of places over time.
"""
