"""The scenario as a co-simulation FMU: table of variables, export, the worker that computes, running and checking."""
