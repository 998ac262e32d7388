"""The tables of scripts/mutate name files and tests that exist, and a mutant's build leaves nothing behind."""
import fnmatch
import importlib.machinery
import importlib.util
import os
import pathlib
import sys
import tempfile
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

    def test_every_scene_exists(self):
        self.assertEqual([name for name in mutate.SCENES if not (ROOT / f"assets/scenes/{name}.json").exists()], [])

    def test_a_group_that_is_called_as_the_file_is_among_the_likeliest(self):
        first, others = mutate.steps_of("engine/crowd", "engine/crowd/load.cpp")
        self.assertEqual(first, ["crowd:host", "crowd:load"])
        self.assertNotIn("crowd:load", others)

    def test_the_likeliest_come_first_but_for_long_ones(self):
        bench = mutate.Bench(None)
        bench.usual = {"v:loop": 3, "crowd:gait": 20, "crowd:hurt": 12, "crowd:load": 90, "crowd:edge": 80}
        self.assertEqual(bench.in_order("gait.cpp", ["crowd:load", "crowd:gait", "crowd:hurt"], ["crowd:edge", "v:loop"]),
                         ["crowd:hurt", "crowd:gait", "v:loop", "crowd:edge", "crowd:load"])

    def test_a_folder_is_put_back_with_its_times(self):
        with tempfile.TemporaryDirectory() as folder:
            sound, build = pathlib.Path(folder) / "sound", pathlib.Path(folder) / "build"
            for name in "same.o", "part/changed.o", "part/lost.o":
                (build / name).parent.mkdir(parents=True, exist_ok=True)
                (build / name).write_text("sound")
            mutate.mirror(build, sound)
            (build / "part" / "changed.o").write_text("fault")
            os.utime(build / "part" / "changed.o", ns=(0, 1))
            (build / "part" / "lost.o").unlink()
            (build / "new.o").write_text("fault")
            self.assertEqual(mutate.differing(sound, build), ["new.o", "part/changed.o", "part/lost.o"])
            mutate.mirror(sound, build)
            self.assertEqual(mutate.differing(sound, build), [])
            self.assertEqual((build / "part" / "changed.o").read_text(), "sound")


if __name__ == "__main__":
    unittest.main()
