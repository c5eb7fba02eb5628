"""What stood in a file stays, whatever a write meets, until the new one is whole."""
import errno
import os
import tempfile
import unittest
from unittest import mock

from grainlaw.files import write_whole


class Files(unittest.TestCase):
    def setUp(self):
        self.directory = tempfile.TemporaryDirectory()
        self.addCleanup(self.directory.cleanup)
        self.path = os.path.join(self.directory.name, "points")
        write_whole(self.path, b"old")

    def read(self):
        with open(self.path, "rb") as file:
            return file.read()

    def test_a_call_of_the_system_that_fails(self):
        for name in ("open", "fchmod", "write", "fsync", "close", "replace"):
            original = getattr(os, name)

            def failing(*arguments, name=name, original=original):
                if name == "close":
                    original(*arguments)
                raise OSError(errno.ENOSPC, "full")

            with mock.patch.object(os, name, failing), self.assertRaises(OSError):
                write_whole(self.path, b"new")
            self.assertEqual(self.read(), b"old", name)
            self.assertEqual(os.listdir(self.directory.name), ["points"], name)
        write_whole(self.path, "new")
        self.assertEqual(self.read(), b"new")

    def test_a_disk_that_takes_a_part(self):
        original = os.write
        taken = []

        def part(descriptor, data):
            if len(taken) == 3:
                raise OSError(errno.ENOSPC, "full")
            taken.append(original(descriptor, data[:10]))
            return taken[-1]

        with mock.patch.object(os, "write", part), self.assertRaises(OSError):
            write_whole(self.path, b"x" * 100)
        self.assertEqual(self.read(), b"old")
        taken.clear()
        with mock.patch.object(os, "write", part):
            write_whole(self.path, b"x" * 30)
        self.assertEqual(self.read(), b"x" * 30)

    def test_links_and_permissions_stay(self):
        link = os.path.join(self.directory.name, "link")
        os.symlink(self.path, link)
        os.chmod(self.path, 0o640)
        write_whole(link, b"new")
        self.assertTrue(os.path.islink(link))
        self.assertEqual(self.read(), b"new")
        self.assertEqual(os.stat(self.path).st_mode & 0o777, 0o640)

    def test_a_device_stays_one(self):
        with self.assertRaises(OSError):
            write_whole("/dev/full", b"new")
        write_whole("/dev/null", b"new")
        for device in ("/dev/full", "/dev/null"):
            self.assertFalse(os.path.isfile(device))


if __name__ == "__main__":
    unittest.main()
