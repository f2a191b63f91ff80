"""Writes what follows from something else: the builders of tables, the options of `plot`, and the page of the book on the classes.

    ./ci.sh dev write         after a change of the schema, of an option of `stickslip plot`, or of a docstring

`tests/test_written.py` fails where one of them is not current.
"""

import inspect
import json
import keyword
import re
import textwrap
from pathlib import Path

import stickslip
from stickslip import _core

HERE = Path(__file__).resolve().parent
PACKAGE = HERE / "python" / "stickslip"
ROOT = HERE.parents[1]
SCHEMA = stickslip.schema()
NOTE = "Written by `crates/stickslip-py/written.py`"


# The builders of tables.


class Schema:
    """The JSON schema of problem files, as types of Python."""

    def __init__(self, schema):
        self.root = schema
        self.tables = schema["$defs"]

    def name(self, table):
        """What a table is called: families of models lose the word, where no other table has the name."""
        short = table.removesuffix("Model")
        return short if short and short not in self.tables else table

    def words(self, table):
        """The words one of which is chosen, if that is all that there is."""
        words = [kind.get("const") for kind in self.tables[table].get("oneOf", [])]
        return words if words and all(words) else None

    def kinds(self, table):
        """The kinds one of which is chosen by key: key, property, text."""
        for kind in table.get("oneOf", []):
            for key, value in kind.get("properties", {}).items():
                yield key, value, kind.get("description", "")

    def is_family(self, table):
        """Whether a table is a choice and nothing else."""
        return "oneOf" in table and "properties" not in table

    def type(self, value):
        """The type of a property."""
        if "$ref" in value:
            table = value["$ref"].rsplit("/", 1)[1]
            words = [json.dumps(kind["const"]) for kind in self.tables[table].get("oneOf", []) if "const" in kind]
            chosen = f" | Literal[{', '.join(words)}]" if words and not self.words(table) else ""
            return "Mesh | GivenMesh" if table == "GivenMesh" else self.name(table) + chosen
        if "anyOf" in value:
            return " | ".join(dict.fromkeys(self.type(one) for one in value["anyOf"] if one.get("type") != "null"))
        kinds = value["type"] if isinstance(value["type"], list) else [value["type"]]
        kind = next(k for k in kinds if k != "null")
        if kind == "array":
            item = self.type(value["items"])
            return {"float": "Numbers", "int": "Numbers", "Numbers": "Rows"}.get(item, f"Sequence[{item}]")
        if kind == "object":
            return f"Mapping[str, {self.type(value['additionalProperties'])}]"
        return {"number": "float", "integer": "int", "string": "str", "boolean": "bool"}[kind]

    def arguments(self, table):
        """The arguments of a table: name, type, whether it must be given, text."""
        needed = table.get("required", [])
        own = [(key, value, value.get("description", "")) for key, value in table.get("properties", {}).items()]
        all_keys = [*own, *self.kinds(table)]
        for key, value, text in sorted(all_keys, key=lambda one: one[0] not in needed):
            kind = "Mesh | str" if table is self.tables["GivenMesh"] and key == "name" else self.type(value)
            yield argument(key), kind, key in needed, text


def argument(key):
    """A key as the name of an argument."""
    name = key.replace("-", "_")
    return f"{name}_" if keyword.iskeyword(name) else name


def plain(text):
    """A text of the schema as that of a docstring: without dimensions, which numbers of Python do not have either."""
    tables = SCHEMA["properties"]

    def kept(found):
        inside = found.group(1).strip("`")
        table = inside in tables or "NAME" in inside or "." in inside
        return found.group(0) if table or inside in ("rad", "degrees", "°") else ""

    text = re.sub(r" ?`?\[([^\[\],\"{`= ]+)\]`?", kept, text).replace(",,", ",")
    text = re.sub(r"\[`Problem::(\w+)`\]", r"`Problem.\1`", text)
    return text.replace("\\", "\\\\").replace('"""', "'''")


def docstring(text, arguments, indent):
    """A docstring with its arguments."""
    lines = plain(text).strip().splitlines() or [""]
    body = [lines[0], *lines[1:]]
    told = [(name, plain(what)) for name, what in arguments if what]
    if told:
        body += ["", "Parameters", "----------"]
        for name, what in told:
            body += [name, *(f"    {line}".rstrip() for line in what.splitlines())]
    quoted = ['"""' + body[0], *body[1:]]
    if len(quoted) == 1:
        return f'{indent}{quoted[0]}"""\n'
    return "".join(f"{indent}{line}".rstrip() + "\n" for line in [*quoted, '"""'])


def signature(name, arguments, answer, first):
    """The first lines of a function."""
    parts = [f"{n}: {kind}" if needed else f"{n}: {kind} | None = None" for n, kind, needed, _ in arguments]
    star = ["*", *parts] if parts else []
    inside = ", ".join([first, *star])
    return f"    def {name}({inside}) -> {answer}:\n"


def builder(schema, name, table, base="Table"):
    """The class of a table with keys of its own."""
    arguments = list(schema.arguments(table))
    text = docstring(table.get("description", name), [(n, what) for n, _, _, what in arguments], "    ")
    return f"\n\nclass {name}({base}):\n{text}\n{signature('__init__', arguments, 'None', 'self')}        super().__init__(locals())\n"


def family(schema, name, table):
    """The class of a choice, with a function a kind."""
    words = [(f'"{kind["const"]}"', kind.get("description", "")) for kind in table["oneOf"] if "const" in kind]
    out = f"\n\nclass {name}(Table):\n{docstring(table.get('description', name), words, '    ')}"
    for key, value, text in schema.kinds(table):
        below = schema.tables[value["$ref"].rsplit("/", 1)[1]] if "$ref" in value else None
        if below is None or schema.is_family(below) or "anyOf" in below:
            arguments = [("value", schema.type(value), True, "")]
            inner = "value"
        else:
            arguments = list(schema.arguments(below))
            inner = "Table(locals())"
        out += f"\n    @staticmethod\n{signature(argument(key), arguments, name, '').replace('(, ', '(').replace('(*, value', '(value')}"
        long = below.get("description", text) if below else text
        out += docstring(long or text, [(n, what) for n, _, _, what in arguments], "        ")
        out += f"        return {name}({{\"{key}\": {inner}}})\n"
    return out


def classes(schema):
    """The tables that stand somewhere by themselves. The keys of a kind of a family are the arguments of its function: it needs no class."""
    found = set()
    for table in [schema.root, *schema.tables.values()]:
        kinds = [value for _, value, _ in schema.kinds(table) if not (schema.is_family(table) and "$ref" in value)]
        found.update(re.findall(r'"#/\$defs/(\w+)"', json.dumps([table.get("properties"), table.get("anyOf"), kinds])))
    return sorted(found)


def tables():
    """`stickslip.tables`, from the schema."""
    schema = Schema(SCHEMA)
    names = classes(schema)
    out = f'''"""Builders of the tables of a problem file: dictionaries whose keys an editor completes and `mypy` checks.

>>> from stickslip import Problem, tables as t
>>> steel = t.Material(isotropic=t.Isotropic(young=210e9, poisson=0.3))
>>> press = t.Interface(secondary="block.bottom", primary="base.top", friction=t.Friction.coulomb(mu=0.3))

Each is a dictionary with the keys of the problem file, and may stand among others. What a table is for and what its keys mean is said as in the reference
of the problem file, from which they come.

{NOTE} from `stickslip.schema.json`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal, Union

import numpy as np

from ._builders import Table
from .mesh import Mesh

#: Numbers, and rows of numbers.
Numbers = Union[Sequence[float], np.ndarray]
Rows = Union[Sequence[Sequence[float]], Sequence[np.ndarray], np.ndarray]
'''
    for name in names:
        if words := schema.words(name):
            out += f"\n#: {plain(schema.tables[name].get('description', name)).splitlines()[0]}\n{schema.name(name)} = Literal[{', '.join(json.dumps(w) for w in words)}]\n"
    for name in names:
        table = schema.tables[name]
        if schema.words(name) or "anyOf" in table:
            continue
        out += (family if schema.is_family(table) else builder)(schema, schema.name(name), table)
    out += builder(schema, "File", schema.root)
    for name in names:
        if "anyOf" in schema.tables[name]:
            kinds = ", ".join(schema.type(one) for one in schema.tables[name]["anyOf"])
            out += f"\n\n#: {plain(schema.tables[name].get('description', name)).splitlines()[0]}\n{schema.name(name)} = Union[{kinds}]\n"
    return out


# The options of `plot`.


def kind_of_option(value, repeated):
    """The type of an option by what the help calls its value."""
    if value is None:
        return "bool"
    if repeated:
        return "Union[str, list[str]]"
    if value == "MODE":
        return "Union[str, int]"
    if value == "WxH":
        return "tuple[int, int]"
    if "," in value:
        return "Union[str, tuple[Union[str, float], ...]]"
    numbers = {"N": "int", "X": "float", "LENGTH": "float", "LO": "float"}
    if value in numbers:
        return numbers[value]
    words = value.split("|")
    if len(words) == 1 or "[" in value:
        return "str"
    kinds = [f"Literal[{', '.join(json.dumps(w) for w in words if w.islower())}]"]
    kinds += [numbers[w] for w in words if not w.islower()]
    return kinds[0] if len(kinds) == 1 else f"Union[{', '.join(kinds)}]"


def plot_options():
    """`stickslip._options`, from the options of the command."""
    out = f'''"""The options of `plot`. {NOTE} from those of the command `stickslip plot`."""

from __future__ import annotations

from typing import Literal, TypedDict, Union


class PlotOptions(TypedDict, total=False):
    """Options of ``stickslip plot``."""
'''
    for name, value, repeated, text in _core.plot_options():
        # Scripts stand beside pictures in files.
        if name not in ("field", "output", "script"):
            kind = 'Literal["gif", "png"]' if name == "animate" else kind_of_option(value, repeated)
            out += f"\n    {argument(name)}: {kind}\n{docstring(text, [], '    ')}"
    return out


# The page of the book.


def prose(text):
    """A docstring as Markdown."""
    lines, out, code = text.splitlines(), [], False
    for i, line in enumerate(lines):
        below = lines[i + 1].strip() if i + 1 < len(lines) else ""
        if line.strip() and set(line.strip()) == {"-"}:
            continue
        example = line.strip().startswith((">>>", "...")) or (code and line.strip() != "")
        if example and not code:
            out.append("```text")
        if code and not example:
            out.append("```")
        code = example
        if below and set(below) == {"-"}:
            out += [f"*{line.strip()}*", ""]
        elif example or not line.startswith("    "):
            named = re.fullmatch(r"\w+", line) and i + 1 < len(lines) and lines[i + 1].startswith("    ")
            out.append(f"- `{line}`:" if named else line if example else line.replace("``", "`"))
        else:
            out.append("  " + line.strip().replace("``", "`"))
    return "\n".join([*out, "```"] if code else out)


def written_signature(name, function):
    """A function as it is called."""
    parameters = list(inspect.signature(function).parameters.values())
    options = [p for p in parameters if p.kind is p.KEYWORD_ONLY and p.name in stickslip.PlotOptions.__annotations__]
    parts = []
    for p in parameters:
        if p.name not in ("self", "cls") and p not in options:
            parts.append(p.name if p.default is p.empty else f"{p.name}={p.default!r}")
    return f"{name}({', '.join([*parts, '**options'] if options else parts)})"


def named(kind):
    """A type as it is written."""
    return re.sub(r"stickslip\._summary\.|typing\.", "", kind.__name__ if isinstance(kind, type) and not getattr(kind, "__args__", None) else str(kind))


def members(cls):
    """What a class has that is documented, in the order in which it is written."""
    for text, name in re.findall(r"#: (.+)\n +(?:self\.)?(\w+)\b", inspect.getsource(cls)):
        if not name.startswith("_"):
            yield f"`{name}`", text
    for name, member in vars(cls).items():
        inner = getattr(member, "__func__", member)
        if name.startswith("_") or not inspect.getdoc(member):
            continue
        if isinstance(member, property):
            yield f"`{name}`", inspect.getdoc(member)
        elif callable(inner):
            yield f"`{written_signature(name, inner)}`", inspect.getdoc(inner)


def page():
    """The page of the book on classes and functions, from their docstrings."""
    out = f"# Python: classes and functions\n\n<!-- {NOTE} from docstrings. -->\n\n{prose(inspect.getdoc(stickslip))}\n"
    for name in stickslip.__all__:
        thing = getattr(stickslip, name)
        if inspect.ismodule(thing):
            out += f"\n## `stickslip.{name}`\n\n{prose(inspect.getdoc(thing).split(NOTE)[0].strip())}\n"
            continue
        heading = written_signature(name, thing) if inspect.isfunction(thing) or name == "Mesh" else name
        out += f"\n## `stickslip.{heading}`\n\n{prose(inspect.getdoc(thing))}\n"
        if name == "PlotOptions":
            options = [(argument(o), kind_of_option(value, many)) for o, value, many, _ in _core.plot_options()]
            out += "\nWhat they do: [A picture](../report.md#a-picture).\n\n"
            out += "".join(f"- `{o}: {kind}`\n" for o, kind in options if o in thing.__annotations__)
        elif name == "Summary":
            out += "\n" + "".join(f"- `{key}`: `{getattr(kind, '__forward_arg__', None) or named(kind)}`\n" for key, kind in thing.__annotations__.items())
        elif inspect.isclass(thing) and thing.__module__ != "stickslip._core":
            for heading, text in members(thing):
                out += f"\n### {heading}\n\n{prose(text)}\n"
    return out


def files():
    """The files, with what has to be in them."""
    return {
        PACKAGE / "tables.py": tables(),
        PACKAGE / "_options.py": plot_options(),
        ROOT / "book" / "src" / "reference" / "python.md": page(),
    }


if __name__ == "__main__":
    for file, text in files().items():
        if not file.exists() or file.read_text() != text:
            file.write_text(text)
            print(file)
