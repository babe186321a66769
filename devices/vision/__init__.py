"""What a picture shows: detection, projection, tracking."""
