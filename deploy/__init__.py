"""Site files, supervision and access control."""
