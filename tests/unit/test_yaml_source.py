"""Strict YAML: what plain values mean, where they stand, and what is refused."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from gw_exudyn.errors import ScenarioError
from gw_exudyn.scenario.yaml_source import parse_value, parse_yaml, read_yaml


def problems(text: str) -> list[str]:
    """Everything that is wrong with a text, fatal or not."""
    try:
        return [str(problem) for problem in parse_yaml(text, "f.yaml").problems]
    except ScenarioError as error:
        return str(error).split("\n")


@pytest.mark.parametrize(
    ("text", "value"),
    [
        ("1e-3", 1e-3),
        ("7e10", 7e10),
        ("1.5", 1.5),
        (".5", 0.5),
        ("5.", 5.0),
        ("-0", 0),
        ("42", 42),
        ("+1", 1),
        ("1_000", "1_000"),
        ("1:30", "1:30"),
        ("190:20:30", "190:20:30"),
        ("007", "007"),
        ("0x1F", "0x1F"),
        ("0o17", "0o17"),
        ("2024-01-01", "2024-01-01"),
        ("no", "no"),
        ("yes", "yes"),
        ("on", "on"),
        ("off", "off"),
        ("true", True),
        ("False", False),
        ("null", None),
        ("~", None),
        ("", None),
        ("'3'", "3"),
        ("'true'", "true"),
        ("2 mm/s", "2 mm/s"),
        ("[0 mm, 1]", ["0 mm", 1]),
        ("{kind: straight}", {"kind": "straight"}),
    ],
)
def test_a_plain_value_means_what_it_looks_like(text: str, value: Any) -> None:
    found = parse_value(text, "--set a")
    assert found == value
    assert type(found) is type(value)


def test_every_value_has_its_line() -> None:
    source = parse_yaml("a: 1\nb:\n  c: x\n  d:\n    - 1\n    - [2,\n       3]\n", "f.yaml")
    assert source.data == {"a": 1, "b": {"c": "x", "d": [1, [2, 3]]}}
    lines = {path: line for path, (_, line) in source.places.items()}
    assert lines == {"": None, "a": 1, "b": 2, "b.c": 3, "b.d": 4, "b.d.0": 5, "b.d.1": 6, "b.d.1.0": 6, "b.d.1.1": 7}


def test_duplicate_keys_are_told_with_both_lines_and_the_first_is_kept() -> None:
    source = parse_yaml("a:\n  b: 1\n  b: 2\na: 3\n", "f.yaml")
    assert [str(problem) for problem in source.problems] == [
        "f.yaml:3: a.b: is given twice, in lines 2 and 3; remove one",
        "f.yaml:4: a: is given twice, in lines 1 and 4; remove one",
    ]
    assert source.data == {"a": {"b": 1}}


@pytest.mark.parametrize(
    ("text", "sentences"),
    [
        ("", ["f.yaml: is empty; a scenario needs at least wire, vessel, catheter and drive"]),
        ("# nothing\n", ["f.yaml: is empty; a scenario needs at least wire, vessel, catheter and drive"]),
        ("- 1\n", ["f.yaml:1: holds a list of 1 item at its top level; lines of 'key: value' are needed"]),
        ("hello", ["f.yaml:1: holds 'hello' at its top level; lines of 'key: value' are needed"]),
        ("a:\n\tb: 1\n", ["f.yaml:2: a tab in the indentation; YAML indents with spaces"]),
        ("a:\n  b:\t1\n", ["f.yaml:2: not valid YAML: a tab where a value or a key begins; use spaces"]),
        ("a: b: c\n", ["f.yaml:1: not valid YAML: a ':' where none may be; check the indentation, and quote text "
                       "that contains ': '"]),
        ("a: [1, 2\nb: 3\n", ["f.yaml:2: not valid YAML: a list [...] is not closed, or a ',' is missing in it"]),
        ("a: 1\nb: \"x\nc: 2\n", ["f.yaml:2: not valid YAML: a quoted text is not closed"]),
        ("a: 1\n---\nb: 2\n", ["f.yaml:2: a second document begins here ('---'); one file holds one scenario"]),
        ("a: 1\nb: .nan\nc: -.inf\nd: 1e999\n", ["f.yaml:2: b: .nan is no finite number",
         "f.yaml:3: c: -.inf is no finite number",
                                                 "f.yaml:4: d: 1e999 is too large a number"]),
        ("a: &x 1\nb: *x\n", ["f.yaml:1: a: anchor '&x' is not supported; write the value out wherever it is needed",
                              "f.yaml:2: b: alias '*x' is not supported; write the value out"]),
        ("a: !!python/name:os.system x\n", ["f.yaml:1: a: tag 'tag:yaml.org,2002:python/name:os.system' is not "
                                            "supported; write plain values"]),
        ("? [a]\n: 1\n", ["f.yaml:1: a key must be plain text"]),
        ("a: \x1b[2J\n", ["f.yaml:1: holds the character 0x1b, which text files do not have"]),
        ("a: " + "[" * 1000, ["f.yaml:1: a.0.0.0: is nested deeper than 20 levels"]),
    ],
)  # fmt: skip
def test_what_is_no_plain_yaml_is_refused(text: str, sentences: list[str]) -> None:
    assert problems(text) == sentences


def test_aliases_cannot_make_it_grow() -> None:
    """The "billion laughs": nine lines that would expand to 10^9 values."""
    lines = ["a0: &a0 [x,x,x,x,x,x,x,x,x,x]"]
    lines += [f"a{i}: &a{i} [{','.join([f'*a{i - 1}'] * 10)}]" for i in range(1, 9)]
    source = parse_yaml("\n".join(lines), "f.yaml")
    assert source.data["a8"] == [None] * 10
    assert len(source.problems) == 9 + 8 * 10


def test_the_number_of_values_is_bounded() -> None:
    assert problems("a: [" + "1," * 50_001 + "]") == [
        "f.yaml:1: holds more than 50000 values; put long tables in a CSV file"
    ]


@pytest.mark.parametrize(
    ("raw", "sentence"),
    [
        ("a: ü".encode("latin-1"), ":1: is not UTF-8 text (byte 0xfc); save it as UTF-8"),
        ("a: 1".encode("utf-16"), ": is UTF-16 text; save it as UTF-8"),
        (b"a: 1\nb: \0", ":2: is a binary file, not text"),
        (b"#" * 1_000_001, ": is larger than 1 MB, which no scenario needs"),
    ],
)
def test_a_file_that_is_no_text_is_refused(tmp_path: Path, raw: bytes, sentence: str) -> None:
    file = tmp_path / "f.yaml"
    file.write_bytes(raw)
    with pytest.raises(ScenarioError) as caught:
        read_yaml(file)
    assert str(caught.value) == f"{file}{sentence}"


def test_byte_order_mark_and_windows_line_ends_do_no_harm(tmp_path: Path) -> None:
    file = tmp_path / "f.yaml"
    file.write_bytes(b"\xef\xbb\xbfname: x\r\nwire:\r\n  length: 1 m\r\n")
    source = read_yaml(file)
    assert source.data == {"name": "x", "wire": {"length": "1 m"}}
    assert source.places["wire.length"] == (str(file), 3)


def test_a_file_that_cannot_be_read_is_named(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="there is no such file"):
        read_yaml(tmp_path / "none.yaml")
    with pytest.raises(ScenarioError, match="is a folder; a file is needed"):
        read_yaml(tmp_path)


def test_a_bad_value_of_an_override_names_its_place() -> None:
    with pytest.raises(ScenarioError) as caught:
        parse_value("[1", "--set a.b", "a.b")
    assert str(caught.value) == "--set a.b: a.b: not valid YAML: a list [...] is not closed, or a ',' is missing in it"
