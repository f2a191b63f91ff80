"""What is written from the schema, the command and docstrings is current, and builders know all that problem files say."""

import importlib.util
from pathlib import Path

import pytest

import stickslip
from stickslip import tables

HERE = Path(__file__).resolve().parents[1]
ROOT = HERE.parents[1]


@pytest.fixture(scope="module")
def written():
    if not (ROOT / "book").exists():
        pytest.skip("the book is not there")
    spec = importlib.util.spec_from_file_location("written", HERE / "written.py")
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_what_is_written_is_current(written):
    files = written.files()
    assert len(files) == 3
    for file, text in files.items():
        assert file.read_text() == text, f"{file.name} is old: run `ci.sh dev write`"


class Built:
    """Makes a table again by calling builders, as the schema leads."""

    def __init__(self, written):
        self.written = written
        self.schema = written.Schema(stickslip.schema())
        self.used = set()

    def value(self, kind, value):
        if "$ref" in kind:
            return self.named(kind["$ref"].rsplit("/", 1)[1], value)
        if "anyOf" in kind:
            return self.value(next(one for one in kind["anyOf"] if ("$ref" in one) == isinstance(value, (dict, str))), value)
        if isinstance(value, list):
            return [self.value(kind["items"], one) for one in value]
        if isinstance(value, dict):
            return {name: self.value(kind["additionalProperties"], one) for name, one in value.items()}
        return value

    def named(self, name, value):
        table = self.schema.tables[name]
        if not isinstance(value, dict):
            return value
        if "anyOf" in table:
            return self.value(table, value)
        builder = getattr(tables, self.schema.name(name))
        if not self.schema.is_family(table):
            return builder(**self.arguments(table, value))
        [(kind, inner)] = value.items()
        function = getattr(builder, self.written.argument(kind))
        self.used.add(function.__qualname__)
        inner_kind = next(one for key, one, _ in self.schema.kinds(table) if key == kind)
        below = self.schema.tables[inner_kind["$ref"].rsplit("/", 1)[1]] if "$ref" in inner_kind else None
        if below is None or self.schema.is_family(below) or "anyOf" in below:
            return function(self.value(inner_kind, inner))
        return function(**self.arguments(below, inner))

    def arguments(self, table, value):
        kinds = {**table.get("properties", {}), **{key: kind for key, kind, _ in self.schema.kinds(table)}}
        return {self.written.argument(key): self.value(kinds[key], one) for key, one in value.items()}


def test_builders_make_every_example(written):
    made = Built(written)
    files = sorted((ROOT / "examples").glob("*/case*.toml"))
    assert len(files) > 40
    for file in files:
        wanted = stickslip.Problem.from_toml(file).tables
        built = tables.File(**made.arguments(made.schema.root, wanted))
        assert built == wanted, file
        assert isinstance(built["step"][0], tables.Step) and isinstance(next(iter(built["body"].values())), tables.Body)
    assert {"Friction.coulomb", "Generator.rectangle", "Wear.archard"} <= made.used
