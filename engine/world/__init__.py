"""The scene compiled to arrays: what rays meet."""
