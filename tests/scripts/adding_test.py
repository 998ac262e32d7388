"""docs/adding.md names files that exist, counts them rightly, and says of a file what it has."""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = (ROOT / "docs" / "adding.md").read_text()
PLACEHOLDER = r"(?<![A-Za-z])(?:X|NAME)(?![A-Za-z])"  # of a stage, a record, a controller or a subcommand


def sections():
    """{heading: text below it}"""
    parts = re.split(r"^## (.+)$", PAGE, flags=re.M)
    return dict(zip(parts[1::2], parts[2::2]))


def rows(text):
    """(numbers, files, what changes, how many files) of a table; `X.{h,cpp}` is two, one "or" another is one."""
    for numbers, named, change in re.findall(r"^\| ([\d, ]+) \| (.+?) \| (.+) \|$", text, re.M):
        files = []
        for name in re.findall(r"`([^`]+)`", named):
            stem, _, ends = name.rstrip("}").partition("{")
            files += [stem + end for end in ends.split(",")]
        numbers = [int(number) for number in numbers.split(",")]
        yield numbers, files, change, 1 if " or " in named else len(files)


def found(name):
    """The files that a name with placeholders may stand for."""
    return list(ROOT.glob(re.sub(PLACEHOLDER, "*", name)))


class Adding(unittest.TestCase):
    def test_files_exist(self):
        for heading, text in sections().items():
            names = [name for _, files, *_ in rows(text) for name in files]
            prose = re.sub(r"^\|.*$", "", text, flags=re.M)
            names += re.findall(r"`((?:\w+/)+[\w.-]+)`", prose)
            for name in names:
                with self.subTest(heading=heading, file=name):
                    self.assertTrue(found(name))

    def test_counts_are_those_of_the_tables(self):
        counts = re.findall(r"^\| \[(.+?)\]\(#.+?\) \| (\d+)(?:, (and|or) (\d+))?", PAGE, re.M)
        self.assertGreater(len(counts), 5)
        for name, least, word, more in counts:
            with self.subTest(addition=name):
                numbers = [n for each, *_ in rows(sections()[name[0].upper() + name[1:]]) for n in each]
                self.assertEqual(numbers, list(range(1, len(numbers) + 1)))
                self.assertIn(len(numbers), {int(least), int(least) + int(more or 0), int(more or 0)})

    def test_a_row_has_a_number_for_each_file(self):
        for heading, text in sections().items():
            for numbers, files, _, count in rows(text):
                with self.subTest(heading=heading, files=files):
                    self.assertEqual(len(numbers), count)

    def test_a_file_has_what_changes_in_it(self):
        for heading, text in sections().items():
            for _, files, change, _ in rows(text):
                for word in re.findall(r"`([A-Za-z_]+)`", change):
                    with self.subTest(heading=heading, files=files, word=word):
                        pattern = re.sub("X|NAME|name", r"\\w+", word)
                        self.assertTrue(any(re.search(pattern, file.read_text())
                                            for name in files for file in found(name)))


if __name__ == "__main__":
    unittest.main()
