"""The tables of scripts/mutate name files and tests that exist."""
import fnmatch
import importlib.machinery
import importlib.util
import pathlib
import sys
import unittest

sys.dont_write_bytecode = True
ROOT = pathlib.Path(__file__).resolve().parents[2]
loader = importlib.machinery.SourceFileLoader("mutate", str(ROOT / "scripts" / "mutate"))
mutate = importlib.util.module_from_spec(importlib.util.spec_from_loader("mutate", loader))
loader.exec_module(mutate)

FILES = sorted(path.relative_to(ROOT).as_posix()
               for room in mutate.ROOMS for path in (ROOT / room).rglob("*") if path.is_file())


class Mutate(unittest.TestCase):
    def test_every_pattern_is_the_first_that_matches_some_file(self):
        mutated = [name for members in mutate.rooms_of([], FILES).values() for _, name in members]
        patterns = [pattern for pattern, _ in mutate.LIKELIEST]
        used = {next((each for each in patterns if fnmatch.fnmatch(name, each)), None) for name in mutated}
        self.assertEqual([each for each in patterns if each not in used], [])

    def test_every_room_has_files(self):
        self.assertEqual(sorted(mutate.rooms_of([], FILES)), sorted(mutate.ROOMS))

    def test_files_that_are_named_exist(self):
        self.assertEqual([name for name in mutate.MEASURE + mutate.UNREACHED if name not in FILES], [])

    def test_every_step_is_a_validation_or_a_group_of_tests(self):
        for steps in [*mutate.ROOMS.values(), *(steps for _, steps in mutate.LIKELIEST)]:
            for step in mutate.single(steps):
                with self.subTest(step=step):
                    program, name = step.split(":")
                    self.assertIn(name, mutate.VALIDATIONS if program == "v" else mutate.GROUPS[program])


if __name__ == "__main__":
    unittest.main()
