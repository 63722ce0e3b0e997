"""What comes of models and systems."""
