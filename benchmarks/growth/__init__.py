"""How time and memory grow with pixels, samples, triangles, lights, textures and threads; `make bench-growth`."""
