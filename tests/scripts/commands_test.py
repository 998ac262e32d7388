"""Every Python script says what it is for, so none of them misses what it imports."""
import pathlib
import subprocess
import unittest

SCRIPTS = pathlib.Path(__file__).resolve().parents[2] / "scripts"


class Commands(unittest.TestCase):
    def test_help(self):
        found = [file for file in sorted(SCRIPTS.iterdir())
                 if file.is_file() and b"python" in file.read_bytes().splitlines()[0]]
        self.assertGreater(len(found), 4)
        for file in found:
            with self.subTest(script=file.name):
                done = subprocess.run([file, "--help"], capture_output=True, text=True)
                self.assertEqual(done.returncode, 0, done.stderr)
                self.assertIn(file.name, done.stdout)


if __name__ == "__main__":
    unittest.main()
