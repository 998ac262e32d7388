"""Where faults are made, and what they are (scripts/lib/mutations.py)."""
import os
import random
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "scripts", "lib"))
from mutations import KINDS, code_of, sites  # noqa: E402


def mutants(text, kind, draws=40):
    """All that a kind of fault makes of the text, of so many draws a place."""
    rng = random.Random(1)
    return {text[:begin] + choose(rng) + text[end:]
            for begin, end, choose in sites(text).get(kind, []) for _ in range(draws)}


class MutationsTest(unittest.TestCase):
    def test_what_each_kind_makes(self):
        for kind, text, expected in [
            ("arithmetic", "a + b", {"a - b"}),
            ("arithmetic", "a /= b", {"a *= b"}),
            ("arithmetic", "float* p = &x[-i];", set()),
            ("comparison", "a < b", {"a <= b", "a >= b"}),
            ("comparison", "a == b", {"a != b"}),
            ("comparison", "std::vector<float> v", set()),
            ("logic", "a && !b", {"a || !b", "a && b"}),
            ("logic", "a != b && c", {"a != b || c"}),
            ("constant", "a[3]", {"a[2]", "a[4]"}),
            ("constant", "for (i = 0u;", {"for (i = 1u;"}),
            ("constant", "std::array<float, 4> a", set()),
            ("constant", "x2 = v0 + 0.0", set()),
            ("component", "v.xz", {"v.zx"}),
            ("component", "v.x", {"v.y", "v.z"}),
            ("component", "v.size()", set()),
            ("clamp", "clamp(x + f(y, z), 0.0, 1.0)", {"(x + f(y, z))"}),
            ("clamp", "std::max(a, b)", {"(a)", "(b)"}),
            ("clamp", "normalize(v).x", {"(v).x"}),
            ("clamp", "std::max({a, b})", set()),
            ("term", "x = a + b * c;", {"x = a;", "x = a + b;"}),
            ("term", "x = (a - f(b, c)) * d", {"x = (a) * d", "x = (a - f(b, c))"}),
            ("index", "a[i] = [i] {}", {"a[i + 1] = [i] {}", "a[i - 1] = [i] {}"}),
            ("bound", "for (int i = 0; i < n; ++i)", {"for (int i = (0) + 1; i < n; ++i)",
                                                      "for (int i = 0; i < (n) - 1; ++i)"}),
        ]:
            with self.subTest(kind=kind, text=text):
                self.assertEqual(mutants(text, kind), expected)

    def test_fractions_change_by_1_to_5_percent(self):
        for text in ("1.5f", "2e-4", "0.75"):
            for mutant in mutants(text, "constant"):
                self.assertEqual(mutant.endswith("f"), text.endswith("f"))
                change = abs(float(mutant.rstrip("f")) / float(text.rstrip("f")) - 1)
                self.assertTrue(0.0099 < change < 0.0501, mutant)

    def test_what_is_no_code_stays(self):
        for text in ['a // b + 1 < c[0]', '/* a * b\n 1.5 */', '#define A (b + 1)', 'x("a + b", \'+\')',
                     'assert(a + b < 2);', 'throw inputError(n + 1);', 'fmt::print("{}", a * 2);',
                     "BINDING BINDING_GOAL = 6;", "layout(set = 0, binding = 1) uniform U;", "[[a + 1]]"]:
            with self.subTest(text=text):
                self.assertEqual(sites(text), {})
                self.assertEqual(len(code_of(text)), len(text))

    def test_every_mutant_differs_from_the_sound_text(self):
        text = "vec3 f(vec3 a[2]) { for (int i = 0; i < 2; ++i) s += max(a[i].xyz * 1.5, 0.5); return !b && c < d; }"
        found = sites(text)
        self.assertEqual(set(found), set(KINDS))
        for kind in found:
            self.assertNotIn(text, mutants(text, kind), kind)


if __name__ == "__main__":
    unittest.main()
