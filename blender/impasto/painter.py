"""A process of `impasto serve` for each scene: it prepares once and paints what it is asked for."""

from __future__ import annotations

import atexit
import json
import queue
import subprocess
import tempfile
import threading
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

from . import binary
from .failure import Failure, Stopped

# How often Esc is looked for, and how long a painter may take to stop, seconds.
_LOOK_S = 0.05
_STOP_S = 0.25

# How many painted frames may wait to be taken.
_AHEAD = 4


class Painter:
    """One process, for one scene file."""

    def __init__(self, scene_file: Path) -> None:
        program = binary.find()
        self.program = program
        self._words: list[str] = []
        self._lines: queue.Queue[dict[str, Any] | None] = queue.Queue()
        self._folder = tempfile.TemporaryDirectory(prefix="impasto_")
        self._id = 0
        self._warnings: list[str] = []
        self._warned: set[str] = set()
        self._scene_folder = str(scene_file.parent)
        # What is being painted: frames that are still to come, and how.
        self._coming: list[int] = []
        self._how: dict[str, Any] = {}
        try:
            self._process = subprocess.Popen(
                [str(program), "serve", str(scene_file)],
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                stderr=subprocess.PIPE,
                text=True,
                encoding="utf-8",
            )
        except OSError as error:
            raise Failure(f"{program} does not run: {error}.") from error
        threading.Thread(target=self._read_lines, daemon=True).start()
        threading.Thread(target=self._read_words, daemon=True).start()

    def _read_lines(self) -> None:
        assert self._process.stdout is not None
        for line in self._process.stdout:
            try:
                self._lines.put(json.loads(line))
            except json.JSONDecodeError:
                self._words.append(line.strip())
        self._lines.put(None)

    def _read_words(self) -> None:
        assert self._process.stderr is not None
        for line in self._process.stderr:
            self._words = [*self._words[-20:], line.strip()]

    def _say(self, **line: Any) -> None:
        assert self._process.stdin is not None
        try:
            self._process.stdin.write(json.dumps(line) + "\n")
            self._process.stdin.flush()
        except (OSError, ValueError):
            # It has ended: what it said last is told when its end is read.
            pass

    def is_alive(self) -> bool:
        return self._process.poll() is None

    def _next_line(self, should_stop: Callable[[], bool]) -> dict[str, Any]:
        """The next answer. Raises Stopped on Esc, and Failure where the process has ended."""
        while True:
            try:
                line = self._lines.get(timeout=_LOOK_S)
            except queue.Empty:
                if should_stop():
                    self.stop()
                    raise Stopped from None
                continue
            if line is None:
                code = self._process.wait()
                said = " ".join(self._words[-3:]) or f"it ended with code {code}"
                raise Failure(f"impasto ended while it painted: {said}")
            return line

    def frame(
        self,
        number: int,
        further: list[int],
        how: dict[str, Any],
        should_stop: Callable[[], bool],
    ) -> Path:
        """The file of a painted frame, uncompressed EXR; the caller removes it. `further` are the frames that will be asked for next:
        they are painted ahead.

        Raises Failure with the program's own words, and Stopped on Esc."""
        if self._how != how or self._coming[:1] != [number]:
            self._begin([number, *further], how, should_stop)
        while True:
            line = self._next_line(should_stop)
            event = line.get("event")
            if event == "ready":
                # Every order repeats the scene's warnings: each is told once.
                news = [words for words in line.get("warnings", []) if words not in self._warned]
                self._warned.update(news)
                self._warnings += news
            if line.get("id", self._id) != self._id or event in ("started", "ready"):
                continue
            if event == "frame" and line["frame"] == number:
                self._coming.pop(0)
                self._say(command="taken")
                return Path(line["path"])
            if event in ("failed", "error"):
                self._coming = []
                words = str(line.get("message", "")).removeprefix("impasto: error: ")
                raise Failure(words.replace(f"{self._scene_folder}/", ""))
            if event in ("done", "stopped"):
                self._coming = []
                raise Failure(f"impasto did not paint frame {number}")

    def take_warnings(self) -> list[str]:
        """What the program said of the scene since the last time, beside errors."""
        told, self._warnings = self._warnings, []
        return told

    def _begin(self, frames: list[int], how: dict[str, Any], should_stop: Callable[[], bool]) -> None:
        if self._coming:
            self._say(command="stop")
        self._id += 1
        self._coming, self._how = list(frames), dict(how)
        output = str(Path(self._folder.name) / f"{self._id}_######.exr")
        listed = ",".join(str(frame) for frame in frames)
        self._say(command="render", id=self._id, frames=listed, output=output, plain=True, ahead=_AHEAD, **how)
        if should_stop():
            self.stop()
            raise Stopped

    def stop(self) -> None:
        """Gives up what is being painted; ends the process where it does not obey at once, as while it prepares."""
        self._say(command="stop")
        self._coming = []
        until_s = time.monotonic() + _STOP_S
        while time.monotonic() < until_s:
            try:
                line = self._lines.get(timeout=_LOOK_S)
            except queue.Empty:
                continue
            if line is None or line.get("event") in ("stopped", "done", "error"):
                return
        # Until it has ended, it would count as alive for the next frame.
        self._process.kill()
        self._process.wait()

    def end(self) -> None:
        """Ends the process and removes its files."""
        if self.is_alive():
            self._say(command="quit")
            try:
                self._process.wait(timeout=_STOP_S)
            except subprocess.TimeoutExpired:
                self._process.kill()
        self._process.wait()
        self._folder.cleanup()


_painters: dict[Path, Painter] = {}


def painter_of(scene_file: Path) -> Painter:
    """The painter of a scene file; a new one where there is none, or where it has ended or is another program."""
    known = _painters.get(scene_file)
    if known is not None and known.is_alive() and known.program == binary.find():
        return known
    stop_painter(scene_file)
    made = Painter(scene_file)
    _painters[scene_file] = made
    return made


def stop_painter(scene_file: Path) -> None:
    """Ends the painter of a scene file, if there is one."""
    known = _painters.pop(scene_file, None)
    if known is not None:
        known.end()


def stop_all_painters() -> None:
    """Ends all painters."""
    for scene_file in list(_painters):
        stop_painter(scene_file)


atexit.register(stop_all_painters)
