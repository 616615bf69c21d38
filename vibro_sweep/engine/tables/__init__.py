"""What is known of an oscillator before any orbit begins: flights over the cells of a forcing period."""
