"""What can be said of a file before anything is planned with it: what it is, whether it holds, what is odd about it."""
