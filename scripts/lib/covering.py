"""Covering arrays: rows in which every pair of values of every two parameters occurs, unless a constraint forbids it.

Built greedily a row at a time, as AETG does (Cohen, Dalal, Fredman & Patton 1997, The AETG System: An Approach to
Testing Based on Combinatorial Design). Each row begins with a pair that is still missing and takes, parameter by
parameter in a drawn order, the value that meets most other missing pairs.
"""
import itertools

CANDIDATES = 12  # rows that are tried for each that is kept: more cost time, and save a few rows


class Space:
    """Parameters (a dict of name -> list of values) and constraints, each a pair (names, allowed): `allowed` is called
    with the values of those names and says whether they can be combined."""

    def __init__(self, parameters, constraints=()):
        self.parameters = parameters
        self.names = list(parameters)
        self.constraints = [(tuple(names), allowed) for names, allowed in constraints]
        self._of = {name: [c for c in self.constraints if name in c[0]] for name in self.names}
        self._constrained = [name for name in self.names if self._of[name]]

    def _fits(self, row, name):
        return all(allowed(*(row[n] for n in names))
                   for names, allowed in self._of[name] if all(n in row for n in names))

    def allows(self, row):
        """Whether no constraint forbids what is set in the row."""
        return all(self._fits(row, name) for name in row)

    def completes(self, row):
        """Whether the row can be completed without breaking a constraint."""
        def complete(row, rest):
            if not rest:
                return True
            name = rest[0]
            return any(self._fits(further, name) and complete(further, rest[1:])
                       for further in ({**row, name: value} for value in self.parameters[name]))

        return self.allows(row) and complete(row, [name for name in self._constrained if name not in row])

    def pairs(self):
        """Every pair that some row can have: ((name, value), (name, value)), the names in order."""
        found = []
        for a, b in itertools.combinations(self.names, 2):
            for x, y in itertools.product(self.parameters[a], self.parameters[b]):
                if self.completes({a: x, b: y}):
                    found.append(((a, x), (b, y)))
        return found


def pairs_of(row, names):
    return itertools.combinations([(name, row[name]) for name in names], 2)


def _row(space, missing, with_value, rng):
    """One row: a drawn missing pair, then greedily."""
    row = dict(rng.choice(missing))
    left = [name for name in space.names if name not in row]
    rng.shuffle(left)
    for name in left:
        values = list(space.parameters[name])
        rng.shuffle(values)
        # Python's sort is stable, so ties stay in drawn order.
        values.sort(key=lambda value: -sum((n, v) in with_value[name, value] for n, v in row.items()))
        row[name] = next(value for value in values if space.completes({**row, name: value}))
    return {name: row[name] for name in space.names}


def covering_array(space, rng):
    """Rows (dicts) that together have every pair of space.pairs()."""
    # In a list for draws, and by value for counting: (name, value) -> the values that it has yet to meet.
    missing = dict.fromkeys(space.pairs())
    with_value = {(name, value): set() for name in space.names for value in space.parameters[name]}
    for one, other in missing:
        with_value[one].add(other)
        with_value[other].add(one)
    rows = []
    while missing:
        listed = list(missing)
        row = max((_row(space, listed, with_value, rng) for _ in range(CANDIDATES)),
                  key=lambda row: sum(pair in missing for pair in pairs_of(row, space.names)))
        for one, other in pairs_of(row, space.names):
            if missing.pop((one, other), 0) is None:
                with_value[one].discard(other)
                with_value[other].discard(one)
        rows.append(row)
    return rows


def cheapest_first(rows, names, cost):
    """The rows in an order that meets most new pairs for its cost first."""
    met, left, ordered = set(), list(rows), []
    while left:
        best = max(left, key=lambda row: sum(pair not in met for pair in pairs_of(row, names)) / cost(row))
        left.remove(best)
        ordered.append(best)
        met.update(pairs_of(best, names))
    return ordered
