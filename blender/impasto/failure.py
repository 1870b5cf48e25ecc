"""What the user is told when something cannot be done."""


class Failure(Exception):
    """One sentence or more, for the user: what is wrong, and the mend."""


class Stopped(Exception):
    """The user pressed Esc."""
