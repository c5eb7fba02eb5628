"""Ctrl-C that waits until a step is where it can be left."""
from __future__ import annotations

import signal
import threading
from types import FrameType, TracebackType
from typing import Any, Self


class Interrupts:
    """While this is entered, in the main thread, Ctrl-C is noted, and check() raises
    KeyboardInterrupt. A second Ctrl-C is not waited with."""

    def __init__(self) -> None:
        self._seen = False
        self._before: Any = None

    def check(self) -> None:
        """Raises KeyboardInterrupt after Ctrl-C."""
        if self._seen:
            self._seen = False
            raise KeyboardInterrupt

    def __enter__(self) -> Self:
        before = signal.getsignal(signal.SIGINT)
        # A host that ignores or handles the signal in its own way keeps doing so.
        if (threading.current_thread() is threading.main_thread()
                and before is signal.default_int_handler):
            self._before = signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None,
                 trace: TracebackType | None) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)
            self._before = None
        if error is None:
            self.check()

    def _note(self, number: int, frame: FrameType | None) -> None:
        if self._seen:
            signal.default_int_handler(number, frame)
        self._seen = True
