"""The Rerun process: draws the fused world and what the robots do. The only importer of rerun."""
