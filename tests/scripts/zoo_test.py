"""scripts/zoo with a command that plays what a run may give: what is red, how it ends, and what it leaves."""
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import time
import unittest

ZOO = pathlib.Path(__file__).resolve().parents[2] / "scripts" / "zoo"

# What the command does is in $FAKE, a folder of files. Agent a is at x = 10 a + tick.
COMMAND = f"#!{sys.executable}" + '''
import array, json, os, pathlib, sys, time
fake = pathlib.Path(os.environ["FAKE"])
name, file, arguments = sys.argv[1], sys.argv[2], sys.argv[3:]
option = dict(zip(arguments, arguments[1:]))
played = json.loads((fake / "plays.json").read_text())
def npy(path, floats, shape):
    head = str({"descr": "<f4", "fortran_order": False, "shape": shape}).encode() + b"\\n"
    path.write_bytes(b"\\x93NUMPY\\x01\\x00" + len(head).to_bytes(2, "little") + head + array.array("f", floats).tobytes())
if name == "inspect":
    print(played.get("inspect", "leg length 0.5 m"))
elif name == "validate":
    pathlib.Path(option["--json"]).write_text(json.dumps({"laws": played["laws"]}))
elif "--trace" in option:
    (fake / "began").touch()
    time.sleep(played.get("sleeps", 0))
    if "says" in played:
        sys.exit(played["says"])
    pathlib.Path(option["--json"]).write_text(json.dumps({"device": "fake", "warnings": played.get("warnings", [])}))
    herd = pathlib.Path(option["--trace"]) / "herd0"
    herd.mkdir(parents=True)
    ticks = int(option["--frames"])
    bodies = [v for t in range(ticks) for a in range(4) for v in (10 * a + t + 1, 2, 3, 0, 0, 0, 1)]
    npy(herd / "body.npy", bodies, (ticks, 4, 7))
    nan = float("nan")
    joints = [v for t in range(ticks) for a in range(4) for v in (10 * a + t + 1, 2.5, 3, nan, nan, nan)]
    npy(herd / "joints.npy", joints, (ticks, 4, 1, 2, 3))
else:
    (fake / "drawn.json").write_bytes(pathlib.Path(file).read_bytes())
    (fake / "drawing.json").write_text(json.dumps(option))
    out = pathlib.Path(option["--out"])
    out.touch() if out.suffix == ".png" else out.mkdir()
'''
FFMPEG = f"#!{sys.executable}\nimport pathlib, sys\npathlib.Path(sys.argv[-1]).touch()\n"
SLIDES = {"law": "sole-slide", "herd": 0, "agents": 1, "firstTick": 9, "worst": 0.5, "text": "herd 0 (spider): slides"}
LEFT = {"law": "grounded", "herd": 0, "agents": 4, "firstTick": 4, "worst": 40.2, "text": "herd 0 (spider): left the ground"}


class Zoo(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.fake = pathlib.Path(temporary.name)
        for name, text in (("skitter", COMMAND), ("ffmpeg", FFMPEG)):
            (self.fake / name).write_text(text)
            (self.fake / name).chmod(0o755)
        self.out = self.fake / "pages" / "zoo"
        self.environment = {**os.environ, "FAKE": str(self.fake), "SKITTER": str(self.fake / "skitter"),
                            "PATH": f"{self.fake}:{os.environ['PATH']}"}

    def command(self, *arguments):
        return [ZOO, "--out", self.out, "--only", "spider", "--only", "flat", *arguments]

    def zoo(self, *arguments, **plays):
        (self.fake / "plays.json").write_text(json.dumps(plays))
        return subprocess.run(self.command(*arguments), capture_output=True, text=True, env=self.environment, timeout=60)

    def page(self):
        return (self.out / "index.html").read_text()

    def reds(self):
        return self.page().count('<p class="broken"')

    def test_help_and_wrong_use(self):
        done = self.zoo("--help")
        self.assertEqual(done.returncode, 0, done.stderr)
        for option in ("--out", "--only", "--quick", "--ticks"):
            self.assertIn(option, done.stdout)
        for wrong, word in ((("--ticks", "0"), "--ticks 0"), (("--only", "unicorn"), "spider"), (("--fast",), "--fast"),
                            (("--jobs", "0"), "--jobs 0"), (("--out", self.fake), "zoo.json")):
            with self.subTest(wrong=wrong):
                done = self.zoo(*wrong)
                self.assertEqual(done.returncode, 2, done.stderr)
                self.assertIn(word, done.stderr)
        self.environment["SKITTER"] = "/nowhere/skitter"
        done = self.zoo("--quick")
        self.assertEqual((done.returncode, done.stderr.count("\n")), (2, 1), done.stderr)
        self.assertFalse(self.out.exists())

    def test_kept_laws_are_not_red(self):
        done = self.zoo("--quick", "--ticks", "8")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.reds(), 0)
        self.assertIn('src="pictures/spider.flat.png"', self.page())
        self.assertEqual(sorted(str(p.relative_to(self.out)) for p in self.out.rglob("*.*")),
                         ["index.html", "pictures/spider.flat.png", "zoo.json"])

    def test_left_ground_is_red_and_fails(self):
        self.zoo("--quick")
        done = self.zoo("--quick", warnings=[LEFT])
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("spider on flat: herd 0 (spider): left the ground", done.stderr)
        self.assertEqual(self.reds(), 1)
        self.assertIn("grounded 40.2", self.page())
        self.assertEqual(list(self.out.parent.iterdir()), [self.out])

    def test_another_broken_law_is_red(self):
        done = self.zoo("--quick", warnings=[SLIDES])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(self.reds(), 1)

    def test_failed_run_is_red_and_fails(self):
        done = self.zoo("--quick", says="skitter: the device <lost> its way")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertEqual(self.reds(), 1)
        self.assertIn("the device &lt;lost&gt; its way", self.page())

    def test_refused_model_is_a_row(self):
        done = self.zoo("--quick", inspect="no legs at all")
        self.assertEqual(done.returncode, 1, done.stderr)
        self.assertIn("no legs at all</td>", self.page())

    def test_own_models(self):
        model = self.fake / "crab.glb"
        done = self.zoo(model)
        self.assertEqual((done.returncode, "no such file" in done.stderr), (2, True), done.stderr)
        model.touch()
        (self.fake / "plays.json").write_text("{}")
        done = subprocess.run([ZOO, "--quick", "--out", self.out, "--only", "flat", model], capture_output=True, text=True,
                              env=self.environment, timeout=60)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertEqual(json.loads((self.fake / "drawn.json").read_text())["herds"][0]["spawn"], {"spacing": 4})
        self.assertIn("<th>crab</th>", self.page())

    def test_full_page_has_the_figures_of_all_laws(self):
        def law(name, value, passes):
            return {"name": name, "unit": "leg lengths", "value": value, "worst": 2 * value, "pass": passes, "why": ""}

        done = self.zoo("--ticks", "8", laws=[law("sole-air", 0.125, True), law("stretch", 0.25, False)])
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("sole-air&nbsp;0.125", self.page())
        self.assertIn("stretch 0.5", self.page())
        self.assertEqual(self.reds(), 1)
        # The eye of picture n looks at agent n, after 2 (n + 1) of 8 ticks.
        keys = json.loads((self.fake / "drawn.json").read_text())["camera"]["keys"][1:]
        self.assertEqual([key["target"] for key in keys], [[10 * n + 2 * (n + 1), 2.6, 3] for n in range(4)])
        self.assertEqual([round(60 * key["time"]) for key in keys], [2, 4, 6, 8])

    def test_more_ticks_than_a_frame_may_have(self):
        done = self.zoo("--ticks", "8004", laws=[])
        self.assertEqual(done.returncode, 0, done.stderr)
        drawn = json.loads((self.fake / "drawing.json").read_text())
        self.assertEqual((drawn["--frames"], drawn["--ticks-per-frame"]), ("12", "667"))

    def test_interrupted_it_leaves_the_earlier_page(self):
        self.zoo("--quick", warnings=[SLIDES])
        before = self.page()
        (self.fake / "plays.json").write_text(json.dumps({"sleeps": 60}))
        (self.fake / "began").unlink()
        child = subprocess.Popen(self.command("--quick"), stderr=subprocess.PIPE, text=True, env=self.environment)
        while not (self.fake / "began").exists() and child.poll() is None:
            time.sleep(0.02)
        child.send_signal(signal.SIGINT)
        _, error = child.communicate(timeout=30)
        self.assertEqual((child.returncode, error), (130, "zoo: interrupted\n"))
        self.assertEqual(self.page(), before)
        self.assertEqual(list(self.out.parent.iterdir()), [self.out])


if __name__ == "__main__":
    unittest.main()
