"""Pod storage assignment (PSA): where a pod waits for its next visit.

- `placement`: a batch of returning pods to free places, worth of the next visit in the cost;
- `zones`: classes of pods to zones in the steady state, with congestion; its prices rate places;
- `stays`: pods whose next visits are known, to zones of places over time.
"""
