"""One line on stderr that says how far a test is, as the command has it."""
from __future__ import annotations

import sys
import time
from collections.abc import Callable

TERMINAL_INTERVAL, LOG_INTERVAL = 0.2, 10.0   # s

#: True: a line on stderr; or a function of the fraction that is done and a text.
Listener = bool | Callable[[float, str], None]


class Progress:
    """On a terminal the line is rewritten in place; elsewhere one is printed every few seconds."""

    def __init__(self, name: str, listener: Listener = True) -> None:
        self._name, self._listener = name, listener
        self._terminal = sys.stderr is not None and sys.stderr.isatty()
        self._shown = False
        self._start = self._last = time.monotonic()
        self._first: tuple[float, float] | None = None

    def update(self, fraction: float, text: str) -> None:
        """Tells the fraction that is done and a text. The time left is told at the speed since the
        first call."""
        if callable(self._listener):
            self._listener(fraction, text)
        elif self._listener:
            self._print(fraction, text)

    def clear(self) -> None:
        """Takes the line off the terminal."""
        if self._terminal and self._shown:
            self._tell("\r\033[K")
        self._shown = False

    def _print(self, fraction: float, text: str) -> None:
        now = time.monotonic()
        first_fraction, first = self._first = self._first or (fraction, now)
        if now - self._last < (TERMINAL_INTERVAL if self._terminal else LOG_INTERVAL):
            return
        self._last, self._shown = now, True
        left = ""
        if fraction > first_fraction:
            rest = (1 - fraction) * (now - first) / (fraction - first_fraction)
            left = f", {duration(rest)} left"
        line = f"{self._name}: {100 * fraction:3.0f} %, {duration(now - self._start)}{left}, {text}"
        self._tell("\r\033[K" + line if self._terminal else line + "\n")

    @staticmethod
    def _tell(text: str) -> None:
        try:
            if sys.stderr is not None:
                sys.stderr.write(text)
                sys.stderr.flush()
        except OSError:
            pass   # that it cannot be written ends no test


def duration(seconds: float) -> str:
    """As 40 s, 12 min 05 s, 3 h 20 min."""
    whole = round(seconds)
    if whole < 100:
        return f"{whole} s"
    if whole < 6000:
        return f"{whole // 60} min {whole % 60:02} s"
    return f"{whole // 3600} h {whole // 60 % 60:02} min"
