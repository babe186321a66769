"""How the emulated planner thinks: from the text of a prompt alone to the parts of a plan, with the errors that it is to make."""
