"""The input: what an input file says, as a mapping from "Section/Entry" to text."""

import json
import os
from collections.abc import Iterator, Mapping, MutableMapping, Sequence
from numbers import Integral, Real
from pathlib import Path
from typing import Any, Union

import pandas

from feldspar import _core

#: Value of an entry: text with its unit as in an input file, a number without unit, several of them, or None for "none".
Value = Union[str, float, int, None, Sequence[Union[str, float, int]]]

#: An SI number, or text with its unit.
Quantity = Union[float, str]

#: What an input may be given as: itself, a .prm or .json file, or entries with their values.
InputLike = Union["Input", str, "os.PathLike[str]", Mapping[str, Value]]


def text_of(value: Value) -> str:
    """Returns a value as an input file has it."""
    if value is None:
        return "none"
    if isinstance(value, str):
        return value
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        words = [text_of(one).split() for one in value]
        units = {" ".join(word[1:]) for word in words}
        if len(units) == 1 and all(words):  # "5 MPa", "10 MPa" is 5, 10 MPa
            return f"{', '.join(word[0] for word in words)} {units.pop()}".strip()
        return ", ".join(" ".join(word) for word in words)
    if isinstance(value, Real) and not isinstance(value, bool):
        return str(int(value)) if isinstance(value, Integral) else repr(float(value))
    raise _core.Error(f"an entry takes text, a number or a list of them, not {value!r}")


def in_si(value: Quantity, quantity: str) -> float:
    """Returns a stress, length, angle, density, rate or duration in SI; a number is in SI already."""
    return _core.in_si(value, quantity) if isinstance(value, str) else number(value, f"a {quantity}")


def number(value: object, name: str) -> float:
    """Returns a number as it is. Raises Error for what is none."""
    if isinstance(value, bool) or not isinstance(value, Real):
        raise _core.Error(f"{name} must be a number, not {value!r}")
    return float(value)


def whole(value: object, name: str, least: int = 0, most: int = 2**64 - 1) -> int:
    """Returns a whole number as it is. Raises Error for what is none, or out of its bounds."""
    if isinstance(value, bool) or not isinstance(value, Integral) or not least <= int(value) <= most:
        raise _core.Error(f"{name} must be a whole number in [{least}, {most}], not {value!r}")
    return int(value)


class Input(MutableMapping[str, str]):
    """The input of a run or a body.

    `source` is a .prm or .json file, another input, or a mapping; entries that it does not name have their presets.
    Relative file names in it refer to the folder of its file, else to the current one.

    >>> rock = Input("granite.prm", {"Specimen/Width": "30 mm"})
    >>> rock["Flat joint/Modulus"] = "70 GPa"

    Raises Error for what a file could not say. Conditions between entries are checked by check(), and where the input is
    used.
    """

    def __init__(
        self,
        source: Union[str, "os.PathLike[str]", Mapping[str, Value], None] = None,
        entries: Union[Mapping[str, Value], None] = None,
    ) -> None:
        self.file: Union[Path, None] = None
        self.core: _core.Input
        if isinstance(source, Input):
            self.core = _core.Input(source.core)
            self.file = source.file
        elif source is None or isinstance(source, Mapping):
            self.core = _core.Input()
        else:
            self.file = Path(source).absolute()
            self.core = _core.Input(os.fspath(source))
        if isinstance(source, Mapping) and not isinstance(source, Input):
            self.update(source)  # type: ignore[arg-type]
        self.update(entries or {})  # type: ignore[arg-type]

    def __getitem__(self, entry: str) -> str:
        """Returns the value of an entry, be it given or preset."""
        return self.core.get(entry)

    def __copy__(self) -> "Input":
        return Input(self)

    def __deepcopy__(self, memo: object) -> "Input":
        return Input(self)

    def __reduce__(self) -> Any:
        return _unpickled, (self.file, dict(self))

    def __setitem__(self, entry: str, value: Value) -> None:
        self.core.set(entry, text_of(value))

    def __delitem__(self, entry: str) -> None:
        """Takes an entry back to its preset."""
        self.core.unset(entry)

    def __iter__(self) -> Iterator[str]:
        """Goes through the entries that were given."""
        return iter([entry for entry, _ in self.core.given()])

    def __len__(self) -> int:
        return len(self.core.given())

    def __contains__(self, entry: object) -> bool:
        return any(entry == name for name, _ in self.core.given())

    def __repr__(self) -> str:
        return f"Input({dict(self)!r})"

    def check(self) -> "Input":
        """Checks the input as a whole. Returns it."""
        self.core.check()
        return self

    def help(self, word: str) -> pandas.DataFrame:
        """Returns the entries whose name or meaning has the word."""
        table = entries()
        found = table.index.str.contains(word, case=False, regex=False)
        return table[found | table["meaning"].str.contains(word, case=False, regex=False)]

    def to_json(self) -> str:
        """Returns the text of a .json input file."""
        sections: dict[str, dict[str, str]] = {}
        for name, value in self.items():
            section, entry = name.split("/", 1)
            sections.setdefault(section, {})[entry] = value
        return json.dumps(sections, indent=2, ensure_ascii=False) + "\n"


def _unpickled(file: Union[Path, None], given: dict[str, str]) -> Input:
    input = Input(file)
    for entry in [one for one in input if one not in given]:
        del input[entry]
    input.update(given)
    return input


def as_input(input: InputLike) -> Input:
    """Returns an input of whatever one may be given as."""
    return input if isinstance(input, Input) else Input(input)


def entries() -> pandas.DataFrame:
    """Returns every entry of the input by its name, with unit, range, preset and meaning."""
    columns = ["name", "unit", "range", "preset", "meaning"]
    rows = [[getattr(entry, column) for column in columns] for entry in _core.entries()]
    return pandas.DataFrame(rows, columns=columns).set_index("name")


def set_threads(n: int) -> None:
    """Sets the number of threads that the library works on; 0: all of the machine. Results do not depend on it."""
    _core.set_threads(whole(n, "the number of threads", most=10**6))


def version() -> str:
    """Returns the version of the library, with the commit it was built from."""
    return _core.version()
