"""Files that are either the old one or the whole new one, whatever a write meets."""
from __future__ import annotations

import contextlib
import errno
import itertools
import os
import stat


def write_whole(path: str | os.PathLike[str], data: str | bytes) -> None:
    """Write text or bytes beside the file, wait until it is on the disk, and put it in the place of
    the old one. On an OSError the old file is as it was, and nothing is left beside it. A device or
    a pipe is written to as it is."""
    content = data.encode() if isinstance(data, str) else data
    target = os.path.realpath(path)
    try:
        mode = os.stat(target).st_mode
    except FileNotFoundError:
        mode = None
    if mode is not None and not os.access(target, os.W_OK):
        raise PermissionError(errno.EACCES, os.strerror(errno.EACCES), os.fspath(path))
    if mode is not None and not stat.S_ISREG(mode):
        with open(target, "wb", buffering=0) as file:
            _write(file.fileno(), content)
        return
    temporary, descriptor = _beside(target)
    try:
        try:
            if mode is not None:
                os.fchmod(descriptor, stat.S_IMODE(mode))
            _write(descriptor, content)
            os.fsync(descriptor)
        finally:
            os.close(descriptor)
        os.replace(temporary, target)
    except BaseException:
        with contextlib.suppress(FileNotFoundError):
            os.unlink(temporary)
        raise
    # The name itself is on the disk once its directory is; some file systems cannot be asked to.
    with contextlib.suppress(OSError):
        directory = os.open(os.path.dirname(target), os.O_RDONLY)
        try:
            os.fsync(directory)
        finally:
            os.close(directory)


def _beside(target: str) -> tuple[str, int]:
    for number in itertools.count():
        temporary = f"{target}.{os.getpid()}-{number}.new"
        with contextlib.suppress(FileExistsError):
            return temporary, os.open(temporary, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o666)
    raise AssertionError  # count() does not end


def _write(descriptor: int, data: bytes) -> None:
    while data:
        data = data[os.write(descriptor, data):]
