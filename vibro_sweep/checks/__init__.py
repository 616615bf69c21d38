"""What is refused, and how it is said: errors, checks of arguments and of names of files, notices."""
