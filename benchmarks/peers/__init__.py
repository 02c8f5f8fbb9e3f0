"""Glanz beside Cycles and Mitsuba 3 on the same scenes: time, error, memory; `make bench-peers` or `python -m benchmarks.peers`."""
