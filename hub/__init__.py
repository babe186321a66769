"""The coordination hub: one world state, plans, dispatch, monitoring."""
