"""Studies: the file that says what is varied and how, its points, and the scenario of each."""
