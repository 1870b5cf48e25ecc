"""What ends an export early."""


class ExportError(Exception):
    """The scene cannot be carried; the message names the object and the mend."""


class Stopped(Exception):
    """The user stopped the export."""
