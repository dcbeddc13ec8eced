"""The Exudyn side: assembly of the multibody system, its stepping, and its state. Nothing else imports exudyn."""
