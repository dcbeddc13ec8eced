"""The evidence that the physics is right: cases that measure the simulation against what is known for certain."""
