"""What models and systems give."""
