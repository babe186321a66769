"""Making the embedded detector: pictures with truth, the network, its training, and how good it is."""
