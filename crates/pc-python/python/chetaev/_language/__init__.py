"""What models are written in: expressions, joints, events, and texts made of them."""
