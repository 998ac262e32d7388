"""Small faults in GLSL and C++, found by text: where each kind can be made, and what it puts there.

Sources are formatted by clang-format, which tells binary operators (spaces on both sides) from signs, pointers and
template brackets. What remains wrong does not compile, and such a mutant is drawn again.
"""
import re

# Text for readers and reports of faults are not mutated, nor are names of numbers that both sides share.
LEFT_OUT = re.compile(
    r"\b(?:static_assert|assert|fail|refuse|say|inputError|deviceError|Error|fmt::print|fmt::format|printf|std::cerr"
    r"|notes\.push_back|layout)\s*\(")
SHARED_NAME = re.compile(r"^(?:BINDING|BATCH|SPLINE|SKITTER_[A-Z_]*CONST)\s+(?:\w+\s+)?\w+\s*=.*$", re.M)
NAME = r"[A-Za-z_]\w*"


def _blank(text):
    return re.sub(r"[^\n]", " ", text)


def closing(text, opening):
    """The index of the bracket that closes the one at `opening`."""
    pairs = {"(": ")", "[": "]", "{": "}"}
    depth = 0
    for at in range(opening, len(text)):
        if text[at] in pairs:
            depth += 1
        elif text[at] in pairs.values():
            depth -= 1
            if depth == 0:
                return at
    return len(text) - 1


def code_of(text):
    """The text with spaces in place of all that is not to be mutated: every offset is what it was."""
    tokens = (r"//[^\n]*|/\*.*?\*/|^[ \t]*#(?:[^\n\\]|\\.)*|R\"\((?:.*?)\)\"|\"(?:[^\"\\\n]|\\.)*\""
              r"|'(?:[^'\\\n]|\\.)+'(?!\w)|\[\[.*?\]\]")
    code = re.sub(tokens, lambda m: _blank(m[0]), text, flags=re.S | re.M)
    code = SHARED_NAME.sub(lambda m: _blank(m[0]), code)
    code = re.sub(r"\bthrow\b[^;]*;", lambda m: _blank(m[0]), code)
    at = 0
    while found := LEFT_OUT.search(code, at):
        end = closing(code, found.end() - 1) + 1
        code = code[:found.start()] + _blank(code[found.start():end]) + code[end:]
        at = end
    return code


def _arguments(code, opening):
    """Spans of the arguments of the call whose bracket opens there."""
    end, at, spans, begin = closing(code, opening), opening + 1, [], opening + 1
    while at < end:
        if code[at] in "([{":
            at = closing(code, at)
        elif code[at] == ",":
            spans.append((begin, at))
            begin = at + 1
        at += 1
    return spans + [(begin, end)], end + 1


def _end_of_term(code, at, factor):
    """Where a term (a factor) that begins there ends."""
    stops = r" [-+*/%] " if factor else r" [-+] "
    stop = re.compile(stops + r"| (?:[<>]=?|[=!]=|&&|\|\||[?:&|^]|<<|>>) |[,;)\]}]")
    while at < len(code):
        if stop.match(code, at):
            return at
        at = closing(code, at) + 1 if code[at] in "([{" else at + 1
    return at


def _in_template(code, start, end):
    line = code[code.rfind("\n", 0, start) + 1:start]
    return bool(re.search(r"\w<[^<>;()]*$", line)) and bool(re.match(r"[^<>;()]*>", code[end:end + 80]))


# Each yields (start, end, choose): what lies between is replaced by choose(rng).

def arithmetic(code):
    other = {"+": "-", "-": "+", "*": "/", "/": "*"}
    for m in re.finditer(r"(?<=\S) ([-+*/])(=?) (?=\S)", code):
        yield m.start(), m.end(), lambda rng, m=m: f" {other[m[1]]}{m[2]} "


def comparison(code):
    other = {"<": ["<=", ">="], ">": [">=", "<="], "<=": ["<", ">"], ">=": [">", "<"], "==": ["!="], "!=": ["=="]}
    for m in re.finditer(r"(?<=\S) ([<>]=?|[=!]=) (?=\S)", code):
        yield m.start(), m.end(), lambda rng, m=m: f" {rng.choice(other[m[1]])} "


def logic(code):
    other = {"&&": "||", "||": "&&", "&": "|", "|": "&"}
    for m in re.finditer(r"(?<=\S) (&&|\|\||&|\|) (?=\S)", code):
        yield m.start(), m.end(), lambda rng, m=m: f" {other[m[1]]} "
    for m in re.finditer(r"(?<![\w)\]])!(?=[\w(])", code):
        yield m.start(), m.end(), lambda rng: ""


def constant(code):
    """By 1 to 5 %, a whole number by 1."""
    for m in re.finditer(r"(?<![\w.#])((?:\d+\.\d*|\.\d+|\d+(?=e))(?:e[-+]?\d+)?)(f?)(?!\w)", code):
        if float(m[1]) != 0:
            def choose(rng, m=m):
                value = float(m[1]) * (1 + rng.choice([-1, 1]) * rng.uniform(0.01, 0.05))
                text = f"{value:.6g}"
                return (text if re.search(r"[.e]", text) else text + ".0") + m[2]
            yield m.start(), m.end(), choose
    for m in re.finditer(r"(?<![\w.])(?<!\de[-+])(\d+)(u?)(?![\w.])", code):
        if not _in_template(code, m.start(), m.end()):
            def choose(rng, m=m):
                value = int(m[1])
                return f"{value + (1 if value == 0 else rng.choice([-1, 1]))}{m[2]}"
            yield m.start(), m.end(), choose


def component(code):
    for m in re.finditer(r"(?<=[\w)\]])\.([xyzw]{1,4}|[rgba]{1,4})(?![\w(])", code):
        letters = "xyzw" if m[1][0] in "xyzw" else "rgba"

        def choose(rng, m=m, letters=letters):
            if len(m[1]) == 1:
                among = letters if m[1] == letters[3] else letters[:3]
                return "." + rng.choice([c for c in among if c != m[1]])
            i, j = rng.sample(range(len(m[1])), 2)
            swapped = list(m[1])
            swapped[i], swapped[j] = swapped[j], swapped[i]
            return "." + "".join(swapped)
        yield m.start(), m.end(), choose


def clamp(code):
    """clamp(x, a, b) -> x, max(x, a) -> x or a, and x without abs, normalize, floor, ..."""
    of_one = ("abs", "fabs", "floor", "round", "fract", "normalize", "unit")
    calls = r"\b(?:std::)?(clamp|min|max|mix|mod|fmod|" + "|".join(of_one) + r")\("
    for m in re.finditer(calls, code):
        spans, end = _arguments(code, m.end() - 1)
        first = code[spans[0][0]:spans[0][1]].strip()
        # A list in braces is no value, and a call without arguments has none.
        if first[:1] in ("", "{") or (len(spans) < 2 and m[1] not in of_one):
            continue

        def choose(rng, m=m, spans=spans):
            begin, stop = spans[rng.randrange(2) if m[1] in ("min", "max") else 0]
            return f"({code[begin:stop].strip()})"
        yield m.start(), end, choose


def term(code):
    """a + b -> a, a * b -> a."""
    for m in re.finditer(r"(?<=\S) ([-+*/]) (?=\S)", code):
        end = _end_of_term(code, m.end(), m[1] in "*/")
        if code[m.end():end].strip() and "\n" not in code[m.start():end]:
            yield m.start(), end, lambda rng: ""


def index(code):
    for m in re.finditer(r"(?<=[\w)\]])\[([^\[\]\n{}]+)\]", code):
        yield m.start(), m.end(), lambda rng, m=m: f"[{m[1]} {rng.choice('+-')} 1]"


def bound(code):
    """Where a loop begins and ends."""
    for m in re.finditer(r"\bfor \(([^;()]*=\s*)([^;]+);\s*([^;]*?\S\s*[<>]=?\s*)([^;&|]+);", code):
        yield m.start(2), m.end(2), lambda rng, m=m: f"({m[2]}) + 1"
        yield m.start(4), m.end(4), lambda rng, m=m: f"({m[4]}) - 1"


KINDS = {f.__name__: f for f in (arithmetic, comparison, logic, constant, component, clamp, term, index, bound)}


def sites(text):
    """{kind: [(start, end, choose)]} of a source."""
    code = code_of(text)
    found = {}
    for kind, find in KINDS.items():
        # A stretch that was blanked in part would lose that part.
        at = [site for site in find(code) if code[site[0]:site[1]] == text[site[0]:site[1]]]
        if at:
            found[kind] = at
    return found
