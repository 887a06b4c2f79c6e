"""Pod storage assignment (PSA): where a pod waits for its next visit.

A *place* is a storage location; a *zone* is a group of places. The models are:

- `placement`: assigns a batch of returning pods to free places, and takes the expected cost of
  their next visits into account;
- `zones`: assigns classes of pods to zones in the steady state, with congestion; the dual prices of
  the zones can be used to rate places;
- `stays`: assigns stays of pods to zones over time, if the times of the next visits are known.
"""
