"""What is computed of single systems at a prompt, standing on the engine."""
