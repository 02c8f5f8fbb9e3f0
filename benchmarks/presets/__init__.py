"""What the presets of Blender's Sampling panel cost and what they are worth, over the sample scenes: `python -m benchmarks.presets`."""
