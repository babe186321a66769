"""Planners: an instruction and a world state in, a plan graph or a refusal out."""
