"""Every pair of every two parameters occurs unless a constraint forbids it (scripts/lib/covering.py)."""
import itertools
import os
import random
import sys
import unittest

sys.dont_write_bytecode = True
sys.path.insert(0, os.path.join(os.path.dirname(__file__), "..", "..", "scripts", "lib"))
from covering import Space, cheapest_first, covering_array, pairs_of  # noqa: E402

SIZES = {"a": 5, "b": 2, "c": 7, "d": 6, "e": 5, "f": 2, "g": 3}
PARAMETERS = {name: list(range(size)) for name, size in SIZES.items()}
CONSTRAINTS = [
    (("a", "c"), lambda a, c: c == 0 or a < 2),
    (("a", "b"), lambda a, b: b == 0 or a == 0),
    # It names three, so that no constraint alone tells which pairs can be.
    (("d", "e", "g"), lambda d, e, g: not (d == 0 and e == 0 and g > 0)),
    # Forbids a pair that no constraint names: f = 1 needs g = 2, which d = 5 cannot have.
    (("f", "g"), lambda f, g: f == 0 or g == 2),
    (("d", "g"), lambda d, g: d != 5 or g != 2),
]


def possible_pairs(parameters, constraints):
    """By trying every row there is."""
    names = list(parameters)
    found = set()
    for values in itertools.product(*parameters.values()):
        row = dict(zip(names, values))
        if all(allowed(*(row[n] for n in of)) for of, allowed in constraints):
            found.update(pairs_of(row, names))
    return found


class CoveringTest(unittest.TestCase):
    def check(self, parameters, constraints):
        space = Space(parameters, constraints)
        expected = possible_pairs(parameters, constraints)
        self.assertEqual(set(space.pairs()), expected)
        rows = covering_array(space, random.Random(1))
        met = set()
        for row in rows:
            self.assertEqual(set(row), set(parameters))
            for names, allowed in constraints:
                self.assertTrue(allowed(*(row[n] for n in names)), row)
            met.update(pairs_of(row, space.names))
        self.assertEqual(met, expected)
        return rows

    def test_every_pair_occurs(self):
        rows = self.check(PARAMETERS, [])
        # The two longest parameters alone need 7 x 6.
        self.assertGreaterEqual(len(rows), 42)
        self.assertLess(len(rows), 60)

    def test_every_pair_occurs_that_constraints_allow(self):
        self.check(PARAMETERS, CONSTRAINTS)

    def test_a_pair_that_only_several_constraints_forbid_is_left_out(self):
        self.assertNotIn((("d", 5), ("f", 1)), Space(PARAMETERS, CONSTRAINTS).pairs())

    def test_the_seed_decides(self):
        space = Space(PARAMETERS, CONSTRAINTS)
        first, same, other = (covering_array(space, random.Random(seed)) for seed in (3, 3, 4))
        self.assertEqual(first, same)
        self.assertNotEqual(first, other)

    def test_order_keeps_every_row_and_begins_with_most_pairs_for_their_cost(self):
        space = Space(PARAMETERS, CONSTRAINTS)
        rows = covering_array(space, random.Random(5))
        cost = lambda row: 1 + row["c"]
        ordered = cheapest_first(rows, space.names, cost)
        key = lambda row: tuple(row[name] for name in space.names)
        self.assertEqual(sorted(map(key, rows)), sorted(map(key, ordered)))
        self.assertEqual(cost(ordered[0]), min(map(cost, rows)))
        met = set()
        for i, row in enumerate(ordered):
            gain = lambda r: sum(pair not in met for pair in pairs_of(r, space.names)) / cost(r)
            self.assertEqual(gain(row), max(map(gain, ordered[i:])))
            met.update(pairs_of(row, space.names))


if __name__ == "__main__":
    unittest.main()
