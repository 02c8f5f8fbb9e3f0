"""Pure functions on (3, N) arrays. They keep the dtype that they are given: float32 renders, float64 proves."""
