"""skitter.pyi says what the module has: the same names, and the same parameters in the same order."""
import ast
import inspect
import pathlib
import re

import skitter

STUB = ast.parse((pathlib.Path(skitter.__file__).parent / "skitter.pyi").read_text())


def named(body):
    """The public names of a body, and the node of each."""
    names = {}
    for node in body:
        if isinstance(node, (ast.FunctionDef, ast.ClassDef)):
            names[node.name] = node
        elif isinstance(node, ast.AnnAssign):
            names[node.target.id] = node
    return {name: node for name, node in names.items() if not name.startswith("_") or name in ("__init__", "__version__")}


def members(thing):
    own = {name for name in vars(thing) if not name.startswith("_")}
    # A class that nobody can make has the slot of its base.
    if inspect.isclass(thing) and not isinstance(vars(thing).get("__init__", object.__init__), type(object.__init__)):
        own.add("__init__")
    return own


def parameters_of(function):
    args = function.args
    names = [arg.arg for arg in args.args if arg.arg != "self"]
    return names + [arg.arg for arg in args.kwonlyargs]


def told(callable_):
    """What pybind11 says that it takes: the first line of the docstring."""
    text = re.sub(r"\[[^\[\]]*\]", "", re.sub(r"\[[^\[\]]*\]", "", callable_.__doc__.splitlines()[0]))
    inside = text[text.index("(") + 1 : text.rindex(")")]
    names = [part.split(":")[0].split("=")[0].strip() for part in re.split(r",\s*(?![^()]*\))", inside)]
    return [name for name in names if name not in ("self", "*", "") and not name.startswith("*")]


def compare(body, thing, path):
    stub = named(body)
    have = members(thing)
    if path == "skitter":
        have.add("__version__")
    kept = {name for name in stub if name not in ("kind",) or not issubclass_of_error(thing)}
    assert kept == have - ({"kind"} if issubclass_of_error(thing) else set()), path
    for name, node in stub.items():
        member = inspect.getattr_static(thing, name, None)
        where = f"{path}.{name}"
        if isinstance(node, ast.ClassDef):
            assert getattr(thing, name).__doc__, where
            compare(node.body, getattr(thing, name), where)
        elif isinstance(node, ast.FunctionDef):
            assert getattr(thing, name).__doc__, where
            if isinstance(member, property):
                assert any(getattr(d, "id", "") == "property" for d in node.decorator_list), where
            else:
                assert parameters_of(node) == told(getattr(thing, name)), where
        elif isinstance(member, property):
            assert member.fset is not None and member.__doc__, where


def issubclass_of_error(thing):
    return inspect.isclass(thing) and issubclass(thing, skitter.Error)


def test_names_and_parameters_agree():
    compare(STUB.body, skitter, "skitter")


def test_read_only_is_what_the_stub_has_as_a_property():
    for cls in (node for node in STUB.body if isinstance(node, ast.ClassDef)):
        for node in cls.body:
            if isinstance(node, ast.FunctionDef) and any(getattr(d, "id", "") == "property" for d in node.decorator_list):
                member = inspect.getattr_static(getattr(skitter, cls.name), node.name)
                assert isinstance(member, property) and member.fset is None, f"{cls.name}.{node.name}"


def test_the_version_is_the_projects():
    root = pathlib.Path(__file__).parent.parent.parent
    version = re.search(r"project\(skitter VERSION (\S+)", (root / "CMakeLists.txt").read_text()).group(1)
    assert skitter.__version__ == version
