"""`python -m console`: the operator's commands."""

from console.app import app

if __name__ == "__main__":
    app(prog_name="justw")
