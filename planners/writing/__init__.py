"""What all planners share whose plans a language model writes: the prompt, the questions, the way from steps to nodes."""
