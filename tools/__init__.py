"""Programs for those who work on the package: they are run by hand, from the root of the checkout."""
