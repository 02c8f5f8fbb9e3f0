"""How fast Glanz is and how much memory it takes, measured side by side with Cycles: `python -m benchmarks`."""
