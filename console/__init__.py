"""The operator's side: commands on a terminal."""
