"""What is declared once, as rows: quantities, columns of files, bifurcations, outcomes, units, kinds of pictures."""
