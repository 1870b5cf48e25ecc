"""Finds the `impasto` program and runs it."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
from pathlib import Path

from . import preferences
from .failure import Failure

NAME = "impasto.exe" if os.name == "nt" else "impasto"

# The version of the lines that `impasto serve` speaks.
SERVE_VERSION = 1

HOW_TO_GET = (
    "Name it in Preferences > Add-ons > Impasto, or put it on the PATH; "
    "the page \"Inside Blender\" (docs/blender.md) says how it is installed, in step 1"
)

# Programs that were found to serve, with the time at which they were written.
_good: dict[str, float] = {}


def find() -> Path:
    """The program: that of the preferences, else the one beside this add-on, else the one on the PATH.

    Raises Failure where there is none, where it does not run, or where its version does not go with this add-on."""
    named = preferences.program()
    if named:
        if not Path(named).is_file():
            raise Failure(f"There is no program at {named}, which the preferences of Impasto name. {HOW_TO_GET}.")
        return _checked(Path(named))
    beside = Path(__file__).parent / NAME
    if beside.is_file():
        return _checked(beside)
    on_path = shutil.which("impasto")
    if on_path is None:
        raise Failure(f"The program impasto was not found. {HOW_TO_GET}.")
    return _checked(Path(on_path))


def _checked(program: Path) -> Path:
    written_s = program.stat().st_mtime
    if _good.get(str(program)) == written_s:
        return program
    try:
        asked = subprocess.run(
            [str(program), "--version", "--json"], capture_output=True, text=True, timeout=20, check=False
        )
    except (OSError, subprocess.TimeoutExpired) as error:
        raise Failure(f"{program} does not run: {error}. {HOW_TO_GET}.") from error
    try:
        said = json.loads(asked.stdout)
    except json.JSONDecodeError:
        said = {}
    if said.get("name") != "impasto":
        raise Failure(f"{program} is too old, or is another program. {HOW_TO_GET}.")
    if said.get("serve") != SERVE_VERSION:
        raise Failure(
            f"{program} is version {said.get('version')}, which does not go with this add-on. "
            "Take both from the same release."
        )
    _good[str(program)] = written_s
    return program


def run(arguments: list[str], timeout_s: float = 120.0, good: tuple[int, ...] = (0,)) -> str:
    """Runs the program to its end and returns what it printed. Raises Failure with its own words, where it ends with another code
    than the good ones."""
    program = find()
    try:
        done = subprocess.run(
            [str(program), *arguments], capture_output=True, text=True, timeout=timeout_s, check=False
        )
    except subprocess.TimeoutExpired as error:
        raise Failure(f"impasto {arguments[0]} took longer than {timeout_s:.0f} seconds and was ended.") from error
    except OSError as error:
        raise Failure(f"{program} does not run: {error}.") from error
    if done.returncode not in good:
        words = done.stderr.strip() or f"impasto {arguments[0]} ended with {done.returncode}"
        raise Failure(words.removeprefix("impasto: error: "))
    return done.stdout
