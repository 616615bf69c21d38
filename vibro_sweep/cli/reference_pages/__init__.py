"""Pages of docs/reference/ that are made from the declarations, one module for each."""
