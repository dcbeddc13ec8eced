"""The vessels: their forms in a scenario file, and the outline that comes of each."""
