"""Every public function is called by a test that sees the public headers alone.

The functions of include/skitter/X.h are called in tests/public/X_test.cpp, those of bindings/c/skitter.h in
tests/bindings/c_test.c. tests/public/symbols_test.py tells overloads apart, of a build.
"""
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
HEADERS = sorted((ROOT / "include/skitter").glob("*.h*"))
C_HEADER = ROOT / "bindings/c/skitter.h"
C_TEST = ROOT / "tests/bindings/c_test.c"
TESTS = ROOT / "tests/public"
# records.h, which shaders include, too, is compiled and tested by tests/crowd/records_in_c.c and records_test.cpp.
WITHOUT = {"export.h", "records.h"}
# Includes that lead to no header of the engine's own rooms. <...> is of the system.
PUBLIC_INCLUDE = re.compile(r'"(skitter/\w+\.h|public/\w+\.h)"|<(?!skitter/)[\w./-]+>|<skitter\.h>')


def without_comments(text):
    text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
    text = re.sub(r"//.*", "", text)
    text = re.sub(r"^\s*#(?:.*\\\n)*.*$", "", text, flags=re.M)
    return re.sub(r'"(?:[^"\\]|\\.)*"', '""', text)


def declarations(text):
    """(text before its braces or semicolon, text within its braces) of each declaration."""
    head, body, braces, parentheses = "", "", 0, 0
    for c in text:
        if braces == 0 and c in "()":
            parentheses += 1 if c == "(" else -1
        if braces == 0 and parentheses == 0 and c == ";":
            yield head.strip(), body
            head, body = "", ""
            continue
        if c == "}":
            braces -= 1
        if braces > 0:
            body += c
        elif c not in "{}":
            head += c
        if c == "{":
            braces += 1
        # A function or a namespace ends here; a class or an initialised member with a semicolon.
        if c == "}" and braces == 0 and parentheses == 0 and not re.search(r"\b(class|struct|enum)\b", head):
            yield head.strip(), body
            head, body = "", ""


def public_part(keyword, body):
    access, parts = ("private" if keyword == "class" else "public"), []
    for part in re.split(r"\b(public|private|protected)\s*:", body):
        if part in ("public", "private", "protected"):
            access = part
        elif access == "public":
            parts.append(part)
    return "".join(parts)


def functions(text, owner=""):
    """Names of what is declared: "loadScene", "Crowd::record"."""
    for head, body in declarations(text):
        namespace = re.match(r"(?:inline )?namespace [\w:]+$", head)
        kind = re.match(r"(class|struct)\s+(?:SKITTER_(\w+)\s+)?(\w+)", head)
        if namespace or head.startswith("extern"):
            yield from functions(body)
        elif kind and body and kind[2] != "LOCAL":
            yield from functions(public_part(kind[1], body), kind[3] + "::")
        elif not kind and not re.match(r"(friend|using|typedef|static_assert|enum)\b", head):
            while "<" in head.partition("(")[0] and re.search(r"<[^<>]*>", head):
                head = re.sub(r"<[^<>]*>", "", head)
            called = re.match(r"[^=(]*?(~?\w+)\s*\(", head)
            # Destructors and moves are called by every test that has a value.
            moves = called and re.search(r"\b%s\s*\(\s*(const )?%s\s*&" % ((called[1],) * 2), head)
            if called and not called[1].startswith("~") and not re.match("operator$|SKITTER_", called[1]) and not moves:
                yield owner + called[1]


def is_called(name, text):
    owner, _, function = name.rpartition("::")
    if owner == function:  # a constructor
        return re.search(r"\b%s(<\w+>)?( \w+)?\s*[({]" % function, text)
    return re.search(r"(\.|->|::)(operator )?%s\s*\(" % function if owner else r"\b%s\s*\(" % function, text)


class Public(unittest.TestCase):
    def check(self, header, test):
        names = sorted(set(functions(without_comments(header.read_text()))))
        text = without_comments(test.read_text()) if test.exists() else ""
        for name in names:
            with self.subTest(header=header.name, function=name):
                self.assertTrue(is_called(name, text), f"{test.relative_to(ROOT)} does not call {name}")
        return names

    def test_every_function_is_called(self):
        count = 0
        for header in HEADERS:
            if header.name not in WITHOUT:
                test = TESTS / (header.name.partition(".")[0] + "_test.cpp")
                count += len(self.check(header, test))
        self.assertGreater(count, 200)

    def test_every_function_of_c_is_called(self):
        names = self.check(C_HEADER, C_TEST)
        self.assertGreater(len(names), 90)
        self.assertIn("skitter_crowd_record", names)

    def test_the_tests_see_public_headers_alone(self):
        sources = [C_TEST, *TESTS.glob("*.cpp"), *TESTS.glob("*.h")]
        self.assertGreater(len(sources), 20)
        for source in sources:
            for name in re.findall(r"^#include\s+(\S+)", source.read_text(), re.M):
                with self.subTest(source=source.name, includes=name):
                    self.assertRegex(name, PUBLIC_INCLUDE)

    def test_functions_are_found(self):
        found = set(functions("""namespace skitter {
            API int f(const A& = {}, int b = g(0)); inline Error h() { return i(); }
            int made = j(); enum class E { a, b };
            class SKITTER_API C { public: C(int); C(C&&); ~C(); int k() const { return 1; } D d{D{}};
              struct SKITTER_LOCAL Impl; struct N { int l() const; }; private: void m(); };
            struct S { int n = 1; bool operator==(const S&) const = default; void o(); };
            }"""))
        self.assertEqual(found, {"f", "h", "C::C", "C::k", "N::l", "S::o"})


if __name__ == "__main__":
    unittest.main()
