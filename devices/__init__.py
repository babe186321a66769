"""Everything that senses or moves, one folder per kind of device."""
