"""A plant in another process: messages over a local socket, the server that owns the plant, and the client that drives it."""
