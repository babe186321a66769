"""Every message, one module per topic family."""
