"""Reader of GSD files (ISO 15745-3), as strict in what it reports as it is tolerant in what it reads.

``parse`` splits a text into statements, each by the grammar beside this module; ``read`` interprets them.  Nothing that
a file holds raises: what is wrong is collected as problems with line and column, and the rest is read all the same.
"""

import re
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

from lark import Lark, Token, Tree
from lark.exceptions import UnexpectedCharacters, UnexpectedInput, UnexpectedToken

from generator.readers.eds import Problem

_HEAD = "#profibus_dp"


@dataclass(frozen=True, slots=True)
class Area:
    """Numbers from ``first`` to ``last``."""

    first: int
    last: int

    def __contains__(self, number: int) -> bool:
        return self.first <= number <= self.last


@dataclass(frozen=True, slots=True)
class Family:
    """Slave family: number of the main family and names of the sub-families."""

    number: int
    names: tuple[str, ...]


@dataclass(frozen=True, slots=True)
class Named:
    """A number and its name."""

    number: int
    name: str


@dataclass(frozen=True, slots=True)
class Labelled:
    """A name and its numbers: the bytes of a module."""

    name: str
    numbers: tuple[int, ...]


@dataclass(frozen=True, slots=True)
class Choice:
    """A default and what is allowed, ``None`` where that is everything; with the name of a slot."""

    name: str
    default: int
    allowed: Area | tuple[int, ...] | None


Value = int | tuple[int, ...] | str | Area | Family | Named | Labelled | Choice | None
"""Value of a statement: one number is an ``int``, several are a tuple; a decimal fraction is text as written."""


@dataclass(frozen=True, slots=True)
class Statement:
    """A statement: its keyword as written, "" for a bare number, the number or area in parentheses, its value.

    Line and columns count from 1; of a statement in several lines they are those of its parts.
    """

    name: str
    key: int | Area | None
    value: Value
    line: int
    column: int
    value_line: int
    value_column: int


@dataclass(frozen=True, slots=True)
class Document:
    """Statements in the order of the file."""

    statements: tuple[Statement, ...]
    problems: tuple[Problem, ...]


@dataclass(frozen=True, slots=True)
class PrmText:
    """Texts of the values of a parameter, by value."""

    number: int
    texts: Mapping[int, str]
    statement: Statement


@dataclass(frozen=True, slots=True, kw_only=True)
class Parameter:
    """A user parameter.

    ``type`` is its data type as written ("Unsigned8", "Bit", "BitArea"), ``bits`` the bits of the last two, ``text``
    the number of the texts of its values.
    """

    number: int
    name: str
    type: str
    bits: Area | None
    default: int
    allowed: Area | tuple[int, ...] | None
    text: int | None
    changeable: bool
    visible: bool
    statement: Statement


@dataclass(frozen=True, slots=True)
class UserData:
    """User parameters: ``constants`` are (offset, bytes), ``references`` (offset, number of the parameter)."""

    length: int | None
    constants: tuple[tuple[int, bytes], ...]
    references: tuple[tuple[int, int], ...]


@dataclass(frozen=True, slots=True)
class DiagnosisArea:
    """Texts of the values of a group of bits."""

    first: int
    last: int
    texts: Mapping[int, str]
    statement: Statement


@dataclass(frozen=True, slots=True)
class Diagnosis:
    """Texts of a block of the diagnosis; ``type`` is its status type, ``None`` for the block without one."""

    type: int | None
    bits: Mapping[int, str]
    areas: tuple[DiagnosisArea, ...]


@dataclass(frozen=True, slots=True)
class Identifier:
    """An identifier of a configuration: bytes to the master and from the master, what they count, what hangs together.

    ``vendor``: bytes of the maker's own.
    """

    inputs: int
    outputs: int
    words: bool
    consistent: bool
    vendor: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class Module:
    """A module with its identifier bytes; the user parameters are plain, of PROFIsafe (F_) and extended (X_)."""

    name: str
    configuration: bytes
    identifiers: tuple[Identifier, ...]
    reference: int | None
    keywords: Mapping[str, Statement]
    user_data: UserData
    f_user_data: UserData
    x_user_data: UserData
    statement: Statement

    @property
    def inputs(self) -> int:
        """Bytes to the master."""
        return sum(identifier.inputs for identifier in self.identifiers)

    @property
    def outputs(self) -> int:
        """Bytes from the master."""
        return sum(identifier.outputs for identifier in self.identifiers)


@dataclass(frozen=True, slots=True)
class Slot:
    """A slot, the module that is in it unless the user chooses another, and those that may be; by reference."""

    number: int
    name: str
    default: int
    modules: Area | tuple[int, ...]
    statement: Statement


@dataclass(frozen=True, slots=True, kw_only=True)
class Gsd:
    """A file: keywords of the station by name in lower case, and its blocks; of what stands twice the first."""

    document: Document
    keywords: Mapping[str, Statement]
    prm_texts: Mapping[int, PrmText]
    parameters: Mapping[int, Parameter]
    user_data: UserData
    diagnosis: tuple[Diagnosis, ...]
    channel_errors: Mapping[int, str]
    modules: tuple[Module, ...]
    slots: tuple[Slot, ...]
    problems: tuple[Problem, ...]

    def value(self, name: str) -> Value:
        """Value of a keyword in any spelling of upper and lower case, ``None`` where it is missing."""
        statement = self.keywords.get(name.lower())
        return None if statement is None else statement.value

    def module(self, name: str) -> Module | None:
        """The module of a name, ``None`` where there is none."""
        return next((module for module in self.modules if module.name == name), None)


# Statements


@cache
def _parser() -> Lark:
    grammar = Path(__file__).with_suffix(".lark")
    return Lark.open(str(grammar), parser="lalr", maybe_placeholders=True, propagate_positions=True)


def decode(data: bytes) -> str:
    """Text of a file in Latin-1, the character set of the format, or in UTF-8 where it begins with its mark."""
    return data.removeprefix(b"\xef\xbb\xbf").decode(
        "utf-8" if data.startswith(b"\xef\xbb\xbf") else "latin-1", "replace"
    )


def parse(text: str) -> Document:
    """The statements of ``text``, and what is no statement as problems."""
    lines = re.split(r"\r\n|\r|\n", text)
    problems: list[Problem] = []
    start = next((i for i, line in enumerate(lines) if _code(line).strip().lower() == _HEAD), None)
    if start is None:
        problems.append(Problem(1, 1, "the line '#Profibus_DP' is missing"))
    statements = []
    for number, source in _logical_lines(lines, 0 if start is None else start + 1):
        try:
            statements.append(_statement(_parser().parse(source), number))
        except UnexpectedInput as error:
            problems.append(_syntax_problem(error, source, number))
    return Document(tuple(statements), tuple(problems))


def _logical_lines(lines: Sequence[str], start: int) -> Iterator[tuple[int, str]]:
    """Statements as text with the number of their first line, up to the next section of the file."""
    position = start
    while position < len(lines):
        first = position
        while _code(lines[position]).rstrip().endswith("\\") and position + 1 < len(lines):
            position += 1
        position += 1
        code = _code(lines[first]).strip()
        if code.startswith("#"):
            return
        if code:
            yield first + 1, "\n".join(lines[first:position])


def _code(line: str) -> str:
    """A line without its comment."""
    if ";" not in line:
        return line
    if '"' not in line:
        return line.partition(";")[0]
    match = re.match(r'(?:[^";]|"[^"]*"?)*', line)
    return match.group() if match else line


def _statement(tree: Tree[Token], line: int) -> Statement:
    children: list[Any] = tree.children
    name = str(children[0]) if isinstance(children[0], Token) else ""
    key: int | Area | None = None
    value: Value = None
    match tree.data:
        case "word":
            at = children[0]
        case "reference":
            value, at = _number(children[0]), children[0].meta
        case "setting":
            key, value, at = _key(children[1]), _value(children[2]), children[2].meta
        case _:
            allowed = None if children[3] is None else _allowed(children[3])
            key, value, at = _key(children[1]), Choice("", _number(children[2]), allowed), children[2].meta
    return Statement(
        name, key, value, line + tree.meta.line - 1, tree.meta.column, line + int(at.line) - 1, int(at.column)
    )


def _key(tree: Any) -> int | Area | None:
    if tree is None:
        return None
    first, last = tree.children
    return _number(first) if last is None else Area(_number(first), _number(last))


def _number(tree: Any) -> int:
    minus, digits = tree.children
    value = int(digits, 16 if digits[:2] in ("0x", "0X") else 10)
    return -value if minus else value


def _text(token: Token) -> str:
    return re.sub(r"\\[ \t]*\n", "", token)[1:-1]


def _numbers(tree: Any) -> tuple[int, ...]:
    return tuple(_number(child) for child in tree.children)


def _allowed(tree: Any) -> Area | tuple[int, ...]:
    numbers = _numbers(tree)
    return Area(numbers[0], numbers[1]) if tree.data == "area" else numbers


def _value(tree: Any) -> Value:
    parts = tree.children
    match tree.data:
        case "text":
            return _text(parts[0])
        case "decimal":
            return str(parts[0])
        case "numbers":
            numbers = _numbers(tree)
            return numbers[0] if len(numbers) == 1 else numbers
        case "area":
            return _allowed(tree)
        case "family":
            return Family(_number(parts[0]), tuple(name.strip() for name in str(parts[1])[1:].split("@")))
        case "named":
            return Named(_number(parts[0]), _text(parts[1]))
        case "module":
            return Labelled(_text(parts[0]), _numbers(parts[1]))
        case _:
            return Choice(_text(parts[0]), _number(parts[1]), _allowed(parts[2]))


def _syntax_problem(error: UnexpectedInput, source: str, number: int) -> Problem:
    if isinstance(error, UnexpectedToken) and error.token.type == "$END":
        last = source.split("\n")
        code = _code(last[-1]).rstrip()
        return Problem(number + len(last) - 1, len(code) + 1, "the statement ends too early")
    found = source.split("\n")[error.line - 1][error.column - 1 :]
    if isinstance(error, UnexpectedCharacters) and found.startswith('"'):
        message = "a text has no closing quote"
    else:
        word = re.match(r"[\w.]+|.", found)
        message = f"'{word.group() if word else ''}' cannot stand here"
    return Problem(number + error.line - 1, error.column, message)


# Blocks

_BLOCKS = {
    "prmtext": "EndPrmText",
    "extuserprmdata": "EndExtUserPrmData",
    "module": "EndModule",
    "slotdefinition": "EndSlotDefinition",
    "unitdiagtype": "EndUnitDiagType",
    "unit_diag_area": "Unit_Diag_Area_End",
    "x_unit_diag_area": "X_Unit_Diag_Area_End",
    "data_area_beg": "Data_Area_End",
    "physical_interface": "End_Physical_Interface",
    "jokerblock_type": "End_Jokerblock_Type",
    "version_firmware_download": "End_Version_Firmware_Download",
}
"""Keywords that begin a block, in lower case, and those that end it."""
_ENDS = {end.lower(): begin for begin, end in _BLOCKS.items()}
_INNER = ("unit_diag_area", "x_unit_diag_area", "data_area_beg")
"""Blocks that can stand inside of others."""


@dataclass(slots=True)
class _Block:
    """A statement with the statements and blocks inside of it; the file itself has none."""

    head: Statement | None
    items: "list[Statement | _Block]" = field(default_factory=list)

    def statements(self, *names: str) -> Iterator[Statement]:
        """Statements with one of these keywords, or all."""
        for item in self.items:
            if isinstance(item, Statement) and (not names or item.name.lower() in names):
                yield item

    def blocks(self, *names: str) -> "Iterator[tuple[Statement, _Block]]":
        """Blocks that begin with one of these keywords, each with its first statement."""
        for item in self.items:
            if isinstance(item, _Block) and item.head is not None and item.head.name.lower() in names:
                yield item.head, item


def _blocks(document: Document, problems: list[Problem]) -> _Block:
    """The file as a tree; blocks that do not end, and ends without a block, are noted."""
    root = _Block(None)
    open_blocks = [root]
    for statement in document.statements:
        name = statement.name.lower()
        if name in _BLOCKS:
            if name not in _INNER:
                _close(open_blocks, root, problems)
            block = _Block(statement)
            open_blocks[-1].items.append(block)
            open_blocks.append(block)
        elif name in _ENDS:
            head = open_blocks[-1].head
            if head is None or head.name.lower() != _ENDS[name]:
                problems.append(_at(statement, f"'{statement.name}' ends nothing"))
            else:
                open_blocks.pop()
        else:
            open_blocks[-1].items.append(statement)
    _close(open_blocks, root, problems)
    return root


def _close(open_blocks: list[_Block], root: _Block, problems: list[Problem]) -> None:
    while open_blocks[-1] is not root:
        head = open_blocks.pop().head
        assert head is not None
        problems.append(_at(head, f"'{head.name}' has no '{_BLOCKS[head.name.lower()]}'"))


def _at(statement: Statement, message: str) -> Problem:
    return Problem(statement.line, statement.column, message)


# Meaning

_MANDATORY = (
    "Vendor_Name",
    "Model_Name",
    "Revision",
    "Ident_Number",
    "Protocol_Ident",
    "Station_Type",
    "Hardware_Release",
    "Software_Release",
)
_MODULAR = ("Max_Module", "Max_Input_Len", "Max_Output_Len")
_TEXTS = {
    "vendor_name": 32,
    "model_name": 32,
    "revision": 32,
    "hardware_release": 32,
    "software_release": 32,
    "implementation_type": 32,
    "ordernumber": 32,
    "bitmap_device": 8,
    "bitmap_diag": 8,
    "bitmap_sf": 8,
    "info_text": 256,
}
"""Keywords that are texts, with their greatest length."""
_LONGEST_TEXT = 32
_NUMBERS = {
    "gsd_revision": 255,
    "ident_number": 0xFFFF,
    "protocol_ident": 255,
    "station_type": 1,
    "fms_supp": 1,
    "redundancy": 1,
    "repeater_ctrl_sig": 2,
    "24v_pins": 2,
    "freeze_mode_supp": 1,
    "sync_mode_supp": 1,
    "auto_baud_supp": 1,
    "set_slave_add_supp": 1,
    "fail_safe": 1,
    "modular_station": 1,
    "dpv1_slave": 1,
    "c1_read_write_supp": 1,
    "c2_read_write_supp": 1,
    "min_slave_intervall": 0xFFFF,
    "max_diag_data_len": 244,
    "max_user_prm_data_len": 237,
    "user_prm_data_len": 237,
    "max_module": 244,
    "max_input_len": 244,
    "max_output_len": 244,
    "max_data_len": 488,
    "modul_offset": 255,
    "c1_max_data_len": 240,
    "c2_max_data_len": 240,
    "c1_response_timeout": 0xFFFF,
    "c2_response_timeout": 0xFFFF,
    "c2_max_count_channels": 49,
    "max_initiate_pdu_length": 244,
}
"""Keywords that are numbers, with their greatest value."""
RATES = ("9.6", "19.2", "31.25", "45.45", "93.75", "187.5", "500", "1.5M", "3M", "6M", "12M")
"""Bit rates of the format: kbit/s, with M Mbit/s."""
_WIDEST_AREA = 16
_PARAMETER_TYPES = {
    "bit": (0, 1),
    "bitarea": (0, 255),
    "unsigned8": (0, 255),
    "unsigned16": (0, 0xFFFF),
    "unsigned32": (0, 0xFFFFFFFF),
    "signed8": (-0x80, 0x7F),
    "signed16": (-0x8000, 0x7FFF),
    "signed32": (-0x80000000, 0x7FFFFFFF),
}
"""Data types of user parameters in lower case, with the least and the greatest value."""


def read(source: str | bytes) -> Gsd:
    """The file ``source``, with problems of syntax, of values and of what does not fit together."""
    return _Interpreter(parse(decode(source) if isinstance(source, bytes) else source)).gsd()


def identifiers(configuration: bytes) -> tuple[Identifier, ...]:
    """The identifiers of a configuration.

    Raises:
        ValueError: The bytes end inside of an identifier.
    """
    found = []
    octets = iter(configuration)
    for head in octets:
        direction = head >> 4 & 3
        if direction:
            length = _length(head & 0x4F)
            found.append(
                Identifier(
                    inputs=length if direction & 1 else 0,
                    outputs=length if direction & 2 else 0,
                    words=bool(head & 0x40),
                    consistent=bool(head & 0x80),
                    vendor=b"",
                )
            )
            continue
        output = _next(octets) if head & 0x80 else None
        given = _next(octets) if head & 0x40 else None
        lengths = [length for length in (output, given) if length is not None]
        found.append(
            Identifier(
                inputs=_length(given),
                outputs=_length(output),
                words=bool(lengths) and all(length & 0x40 for length in lengths),
                consistent=bool(lengths) and all(length & 0x80 for length in lengths),
                vendor=bytes(_next(octets) for _ in range(head & 0x0F)),
            )
        )
    return tuple(found)


def _next(octets: Iterator[int]) -> int:
    for octet in octets:
        return octet
    raise ValueError("the configuration ends inside of an identifier")


def _length(octet: int | None) -> int:
    """Bytes that a length byte counts; ``None`` counts none."""
    return 0 if octet is None else ((octet & 0x3F) + 1) * (2 if octet & 0x40 else 1)


T = TypeVar("T", PrmText, Parameter)


class _Interpreter:
    """Reads the statements of one document and collects what is wrong in them."""

    def __init__(self, document: Document) -> None:
        self._document = document
        self._problems = list(document.problems)

    def gsd(self) -> Gsd:
        root = _blocks(self._document, self._problems)
        keywords = self._keywords(root)
        prm_texts = self._unique("PrmText", self._prm_texts(root))
        parameters = self._unique("ExtUserPrmData", self._parameters(root, prm_texts))
        modules = self._modules(root, keywords, parameters)
        self._check_station(keywords, modules)
        for statement in root.statements(""):
            self._problems.append(_at(statement, "a number stands outside of a module"))
        return Gsd(
            document=self._document,
            keywords=keywords,
            prm_texts=prm_texts,
            parameters=parameters,
            user_data=self._user_data(root, "", "max_user_prm_data_len", parameters),
            diagnosis=tuple(self._diagnosis(root)),
            channel_errors=self._texts(root, "channel_diag"),
            modules=modules,
            slots=tuple(self._slots(root, modules)),
            problems=tuple(sorted(self._problems)),
        )

    def _note(self, statement: Statement, message: str) -> None:
        """Note a problem at the value of a statement."""
        self._problems.append(Problem(statement.value_line, statement.value_column, message))

    def _unique(self, kind: str, entries: Iterable[T]) -> dict[int, T]:
        found: dict[int, T] = {}
        for entry in entries:
            if entry.number in found:
                self._note(entry.statement, f"{kind} {entry.number} stands twice")
            found.setdefault(entry.number, entry)
        return found

    # Keywords

    def _keywords(self, block: _Block) -> dict[str, Statement]:
        found: dict[str, Statement] = {}
        for statement in block.statements():
            name = statement.name.lower()
            if not name or statement.key is not None:
                continue
            if name in found:
                self._problems.append(
                    _at(statement, f"'{statement.name}' stands twice, first in line {found[name].line}")
                )
            else:
                found[name] = statement
                self._check_value(name, statement)
        return found

    def _check_value(self, name: str, statement: Statement) -> None:
        value = statement.value
        if name in _TEXTS:
            if not isinstance(value, str):
                self._note(statement, f"'{statement.name}' is a text")
            else:
                self._check_text(statement, value, _TEXTS[name])
        elif name in _NUMBERS or name.startswith("maxtsdr_") or name.removesuffix("_supp").upper() in RATES:
            most = _NUMBERS.get(name, 0xFFFF if name.startswith("maxtsdr_") else 1)
            if not isinstance(value, int):
                self._note(statement, f"'{statement.name}' is a number")
            elif not 0 <= value <= most:
                self._note(statement, f"{value} is outside of 0 ... {most}")

    def _check_text(self, statement: Statement, text: str, longest: int = _LONGEST_TEXT) -> None:
        if not text:
            self._note(statement, "a text is empty")
        elif len(text) > longest:
            self._note(statement, f"a text has {len(text)} characters, at most {longest} are allowed")

    def _check_station(self, keywords: Mapping[str, Statement], modules: Sequence[Module]) -> None:
        modular = "modular_station" in keywords and keywords["modular_station"].value == 1
        for name in (*_MANDATORY, *(_MODULAR if modular else ())):
            if name.lower() not in keywords:
                self._problems.append(Problem(1, 1, f"'{name}' is missing"))
        for rate in RATES:
            supported = keywords.get(f"{rate}_supp".lower())
            if supported is not None and supported.value == 1 and f"maxtsdr_{rate}".lower() not in keywords:
                self._note(supported, f"'MaxTsdr_{rate}' is missing")
        if not modular and len(modules) > 1:
            self._problems.append(_at(modules[1].statement, "a station that is not modular has one module"))

    def _texts(self, block: _Block, name: str) -> dict[int, str]:
        """Texts by the number in parentheses: Text(1)="...", of a number that stands twice the first."""
        found: dict[int, str] = {}
        for statement in block.statements(name):
            if not isinstance(statement.key, int) or not isinstance(statement.value, str):
                self._note(statement, f"'{statement.name}' has a number and a text")
                continue
            self._check_text(statement, statement.value)
            if statement.key in found:
                self._problems.append(_at(statement, f"'{statement.name}({statement.key})' stands twice"))
            found.setdefault(statement.key, statement.value)
        return found

    # User parameters

    def _prm_texts(self, root: _Block) -> Iterator[PrmText]:
        for head, block in root.blocks("prmtext"):
            if not isinstance(head.value, int):
                self._note(head, "'PrmText' has a number")
                continue
            texts = self._texts(block, "text")
            if not texts:
                self._problems.append(_at(head, f"PrmText {head.value} has no text"))
            yield PrmText(head.value, texts, head)

    def _parameters(self, root: _Block, texts: Mapping[int, PrmText]) -> Iterator[Parameter]:
        for head, block in root.blocks("extuserprmdata"):
            if not isinstance(head.value, Named):
                self._note(head, "'ExtUserPrmData' has a number and a name")
                continue
            typed = next((s for s in block.statements() if isinstance(s.value, Choice)), None)
            if typed is None:
                self._problems.append(_at(head, f"ExtUserPrmData {head.value.number} has no data type"))
                continue
            yield self._parameter(head, head.value, typed, block, texts)

    def _parameter(
        self, head: Statement, named: Named, typed: Statement, block: _Block, texts: Mapping[int, PrmText]
    ) -> Parameter:
        assert isinstance(typed.value, Choice)
        bits = Area(typed.key, typed.key) if isinstance(typed.key, int) else typed.key
        self._check_parameter(typed, typed.value, bits)
        flags = {statement.name.lower(): statement for statement in block.statements()}
        text = flags.get("prm_text_ref")
        if text is not None and text.value not in texts:
            self._note(text, f"there is no PrmText {text.value}")
        return Parameter(
            number=named.number,
            name=named.name,
            type=typed.name,
            bits=bits,
            default=typed.value.default,
            allowed=typed.value.allowed,
            text=text.value if text is not None and isinstance(text.value, int) else None,
            changeable="changeable" not in flags or flags["changeable"].value != 0,
            visible="visible" not in flags or flags["visible"].value != 0,
            statement=head,
        )

    def _check_parameter(self, typed: Statement, choice: Choice, bits: Area | None) -> None:
        limits = _PARAMETER_TYPES.get(typed.name.lower())
        if limits is None:
            self._problems.append(_at(typed, f"'{typed.name}' is no data type"))
            return
        least, most = limits
        if typed.name.lower() in ("bit", "bitarea"):
            if bits is None or not 0 <= bits.first <= bits.last <= 7:
                self._problems.append(_at(typed, f"'{typed.name}' names bits 0 ... 7"))
                return
            most = (2 << bits.last - bits.first) - 1
        if not least <= choice.default <= most:
            self._note(typed, f"the default {choice.default} is outside of {least} ... {most}")
        elif choice.allowed is not None and choice.default not in choice.allowed:
            self._note(typed, f"the default {choice.default} is not allowed")

    def _user_data(self, block: _Block, prefix: str, length_name: str, parameters: Mapping[int, Parameter]) -> UserData:
        """Constants and references of a station or a module; ``prefix`` is "", "f_" or "x_"."""
        lengths = [s.value for s in block.statements(length_name) if isinstance(s.value, int)]
        length = lengths[0] if lengths else None
        constants, references = [], []
        for statement in block.statements(f"{prefix}ext_user_prm_data_const"):
            data = self._octets(statement)
            if data is not None and isinstance(statement.key, int):
                constants.append((statement.key, data))
                self._check_end(statement, statement.key + len(data), length)
        for statement in block.statements(f"{prefix}ext_user_prm_data_ref"):
            if not isinstance(statement.key, int) or not isinstance(statement.value, int):
                self._note(statement, f"'{statement.name}' has an offset and a number")
            elif statement.value not in parameters:
                self._note(statement, f"there is no ExtUserPrmData {statement.value}")
            else:
                references.append((statement.key, statement.value))
                self._check_end(statement, statement.key + 1, length)
        return UserData(length, tuple(constants), tuple(references))

    def _octets(self, statement: Statement) -> bytes | None:
        numbers = statement.value if isinstance(statement.value, tuple) else (statement.value,)
        if not isinstance(statement.key, int) or not all(isinstance(n, int) and 0 <= n <= 255 for n in numbers):
            self._note(statement, f"'{statement.name}' has an offset and bytes")
            return None
        return bytes(n for n in numbers if isinstance(n, int))

    def _check_end(self, statement: Statement, end: int, length: int | None) -> None:
        if length is not None and end > length:
            self._note(statement, f"the user parameters have {length} bytes, this one ends at {end}")

    # Diagnosis

    def _diagnosis(self, root: _Block) -> Iterator[Diagnosis]:
        plain = self._diagnosis_texts(root, None, "")
        if plain.bits or plain.areas:
            yield plain
        for head, block in root.blocks("unitdiagtype"):
            if isinstance(head.value, int):
                yield self._diagnosis_texts(block, head.value, "x_")
            else:
                self._note(head, "'UnitDiagType' has a number")

    def _diagnosis_texts(self, block: _Block, number: int | None, prefix: str) -> Diagnosis:
        areas = []
        for head, inner in block.blocks(f"{prefix}unit_diag_area"):
            if not isinstance(head.value, Area) or head.value.last < head.value.first:
                self._note(head, f"'{head.name}' has a first and a last bit")
                continue
            texts = self._texts(inner, f"{prefix}value")
            self._check_widths(head, head.value.last - head.value.first + 1, inner, f"{prefix}value")
            areas.append(DiagnosisArea(head.value.first, head.value.last, texts, head))
        return Diagnosis(number, self._texts(block, f"{prefix}unit_diag_bit"), tuple(areas))

    def _check_widths(self, head: Statement, width: int, block: _Block, name: str) -> None:
        if width > _WIDEST_AREA:
            self._note(head, f"an area has at most {_WIDEST_AREA} bits")
            return
        for statement in block.statements(name):
            if isinstance(statement.key, int) and not 0 <= statement.key < 1 << width:
                self._problems.append(_at(statement, f"{statement.key} does not fit into {width} bits"))

    # Modules

    def _modules(
        self, root: _Block, keywords: Mapping[str, Statement], parameters: Mapping[int, Parameter]
    ) -> tuple[Module, ...]:
        found = []
        references: set[int] = set()
        for head, block in root.blocks("module"):
            module = self._module(head, block, parameters)
            if module is None:
                continue
            found.append(module)
            self._check_lengths(module, keywords)
            if module.reference is not None and module.reference in references:
                self._problems.append(_at(head, f"the module reference {module.reference} stands twice"))
            references |= {module.reference} if module.reference is not None else set()
        return tuple(found)

    def _module(self, head: Statement, block: _Block, parameters: Mapping[int, Parameter]) -> Module | None:
        if not isinstance(head.value, Labelled) or not all(0 <= n <= 255 for n in head.value.numbers):
            self._note(head, "'Module' has a name and bytes")
            return None
        self._check_text(head, head.value.name)
        configuration = bytes(head.value.numbers)
        try:
            parts = identifiers(configuration)
        except ValueError as error:
            self._note(head, str(error))
            parts = ()
        references = [s.value for s in block.statements("") if isinstance(s.value, int)]
        plain, f_data, x_data = (
            self._user_data(block, prefix, f"{prefix}ext_module_prm_data_len", parameters)
            for prefix in ("", "f_", "x_")
        )
        return Module(
            name=head.value.name,
            configuration=configuration,
            identifiers=parts,
            reference=references[0] if references else None,
            keywords=self._keywords(block),
            user_data=plain,
            f_user_data=f_data,
            x_user_data=x_data,
            statement=head,
        )

    def _check_lengths(self, module: Module, keywords: Mapping[str, Statement]) -> None:
        for length, name in (
            (module.inputs, "Max_Input_Len"),
            (module.outputs, "Max_Output_Len"),
            (module.inputs + module.outputs, "Max_Data_Len"),
        ):
            limit = keywords.get(name.lower())
            if limit is not None and isinstance(limit.value, int) and length > limit.value:
                self._note(module.statement, f"the module has {length} bytes, {name} is {limit.value}")

    def _slots(self, root: _Block, modules: Sequence[Module]) -> Iterator[Slot]:
        known = {module.reference for module in modules}
        for _, block in root.blocks("slotdefinition"):
            for statement in block.statements("slot"):
                choice = statement.value
                if not isinstance(statement.key, int) or not isinstance(choice, Choice) or choice.allowed is None:
                    self._note(statement, "'Slot' has a number, a name, a default and module references")
                    continue
                if choice.default not in known:
                    self._note(statement, f"there is no module with the reference {choice.default}")
                elif choice.default not in choice.allowed:
                    self._note(statement, f"the default {choice.default} is not allowed in the slot")
                yield Slot(statement.key, choice.name, choice.default, choice.allowed, statement)
