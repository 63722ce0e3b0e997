"""Results of models and systems."""
