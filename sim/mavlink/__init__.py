"""MAVLink 2 on sockets: links, streams, and the parameter, mission and command protocols."""
