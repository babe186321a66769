"""Who has a port."""

import os
import socket

from deploy.ports import holder, is_free


def test_the_program_that_has_a_port_is_named() -> None:
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        assert not is_free(port)
        assert f"(process {os.getpid()})" in holder(port)
    assert is_free(port)
