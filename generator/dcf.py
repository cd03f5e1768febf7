"""The command ``dcf``: from arguments as typed to the files of one configured device.

Every argument is checked against the model before anything is rendered; all mistakes are reported together.
"""

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from generator import notation
from generator.diagnostics import suggestion
from generator.emit import dcf
from generator.emit.base import Output
from generator.emit.canopen import BusObject, Configuration, Entry, ObjectDictionary, object_dictionaries
from generator.emit.eds import holds
from generator.mistakes import Mistake, MistakesError
from generator.model import Code, CodeRef, DataType, Model, ObjectRef
from generator.naming import words

_HEXADECIMAL = re.compile(r"0[xX][0-9A-Fa-f]+")
_DECIMAL = re.compile(r"[+-]?[0-9]+(\.[0-9]+)?")
_LONGEST = 1000
"""Characters that a setting may have; texts of drives are much shorter."""
_EXAMPLE = "C13351=2, C13320/1=0x185 or I-1017=100"


@dataclass(frozen=True, slots=True, kw_only=True)
class Request:
    """The arguments as typed; ``None`` where an option is left out."""

    device: str | None
    slot: str | None
    product: str | None
    node: str
    bit_rate: str
    settings: tuple[str, ...]


def files(model: Model, request: Request) -> Mapping[str, Output]:
    """The files that the request asks for, by name.

    Raises:
        MistakesError: All that is wrong with the request.
        EmitError: The device cannot be described by an EDS.
    """
    mistakes: list[Mistake] = []
    dictionary = _dictionary(model, request)
    node = _node(request.node, dictionary.facts.node_addresses, mistakes)
    bit_rate = _bit_rate(request.bit_rate, dictionary, mistakes)
    values: dict[tuple[int, int], int | str] = {}
    for argument in request.settings:
        try:
            _Setting(argument, dictionary, node).into(values)
        except MistakesError as error:
            mistakes += error.mistakes
    if mistakes:
        raise MistakesError(mistakes)
    return dcf.render(model, dictionary, Configuration(node=node, bit_rate=bit_rate, values=values))


# Which dictionary


def _dictionary(model: Model, request: Request) -> ObjectDictionary:
    devices = [device for device in model.devices if device.canopen]
    device = devices[_choice("--device", request.device, [device.id for device in devices], "CANopen devices")]
    dictionaries = object_dictionaries(device)
    slots = list(dict.fromkeys(dictionary.slot or "" for dictionary in dictionaries))
    slot = slots[_choice("--slot", request.slot, slots, f"slots of {device.id}")]
    dictionaries = tuple(dictionary for dictionary in dictionaries if (dictionary.slot or "") == slot)
    labels = [_argument(dictionary.product.label) for dictionary in dictionaries]
    return dictionaries[_choice("--product", request.product, labels, f"products of {device.id}")]


def _argument(label: str) -> str:
    """A label as one word, in the spelling that the names of files have."""
    return "_".join(re.findall(r"[A-Za-z0-9]+", label))


def _choice(option: str, typed: str | None, names: Sequence[str], what: str) -> int:
    """Place of what was typed among the names, which may be left out where there is one."""
    if typed is None:
        if len(names) == 1:
            return 0
        message = f"{option} is missing, as there are several {what}" if names else f"there are no {what}"
        raise MistakesError([Mistake(option="", argument="", message=message, hint=suggestion("", names, what))])
    for place, name in enumerate(names):
        if words(typed) and words(name) == words(typed):
            return place
    nameless = list(names) == [""]
    message = f"there are no {what}" if nameless else f"'{typed}' is not among the {what}"
    hint = f"leave {option} out" if nameless else suggestion(typed, names, what)
    raise MistakesError([Mistake(option=option, argument=typed, message=message, hint=hint)])


def _node(typed: str, nodes: range, mistakes: list[Mistake]) -> int:
    number = _whole(typed)
    if number in nodes:
        return number
    message = f"'{typed}' is no node-ID"
    legal = f"{nodes[0]} ... {nodes[-1]}"
    mistakes.append(Mistake(option="--node", argument=typed, message=message, compared=(("legal", legal),)))
    return 0


def _bit_rate(typed: str, dictionary: ObjectDictionary, mistakes: list[Mistake]) -> int:
    number = _whole(typed)
    rates = dictionary.facts.baud_rates
    if number in rates:
        return number
    message = f"{dictionary.device.order_code} has no bit rate of '{typed}' kbit/s"
    legal = ", ".join(str(rate) for rate in rates)
    mistakes.append(Mistake(option="--baud", argument=typed, message=message, compared=(("legal", legal),)))
    return 0


def _whole(typed: str) -> int:
    """A number as typed, -1 for other text."""
    return int(typed) if re.fullmatch("[0-9]{1,9}", typed) else -1


# What is set to what


class _Setting:
    """One ``--set NAME=VALUE``.

    Every method that finds a mistake raises ``MistakesError``.
    """

    def __init__(self, argument: str, dictionary: ObjectDictionary, node: int) -> None:
        name, equals, value = argument.partition("=")
        self._argument = argument
        self._dictionary = dictionary
        self._node = node
        self._name = name.strip()
        self._value = value.strip()
        if not equals or not self._name or not self._value:
            raise self._mistake(f"'{argument}' is not NAME=VALUE", hint=f"write it like {_EXAMPLE}")
        if len(argument) > _LONGEST:
            raise self._mistake(f"a setting has at most {_LONGEST} characters")

    def into(self, values: dict[tuple[int, int], int | str]) -> None:
        """Add the setting to the values."""
        for reference in self._references():
            entry, value = self._target(reference)
            place = (entry.index, value.subindex)
            if place in values:
                raise self._mistake(f"{reference} is set twice")
            wire = self._wire(reference, value)
            self._check_node(reference, wire)
            values[place] = wire

    def _mistake(
        self, message: str, compared: Sequence[tuple[str, str]] = (), hint: str = "", at_value: bool = False
    ) -> MistakesError:
        part = self._value if at_value else self._name
        column = self._argument.index(part, self._argument.index("=") + 1 if at_value else 0) if part else 0
        return MistakesError(
            [
                Mistake(
                    option="--set",
                    argument=self._argument,
                    column=column,
                    length=len(part),
                    message=message,
                    compared=tuple(compared),
                    hint=hint,
                )
            ]
        )

    # The name

    def _references(self) -> list[CodeRef | ObjectRef]:
        try:
            runs = notation.references(self._name)
        except notation.NotationError as error:
            raise self._mistake(f"'{self._name}' names no code or object", hint=f"write it like {_EXAMPLE}") from error
        found = [item for run in runs for item in run.items if isinstance(item, CodeRef | ObjectRef)]
        whole = not any(run.open_run for run in runs) and len(found) == sum(len(run.items) for run in runs)
        if not found or not whole or "P-" in self._name:
            raise self._mistake(f"'{self._name}' names no single code or object", hint=f"write it like {_EXAMPLE}")
        return found

    def _target(self, reference: CodeRef | ObjectRef) -> tuple[BusObject, Entry]:
        if isinstance(reference, CodeRef):
            entry = self._dictionary.object(self._code(reference).index)
            subindex = reference.subcode
        else:
            entry = self._dictionary.object(reference.index)
            subindex = reference.subindex
        if entry is None:
            names = [found.designation for found in self._dictionary.objects]
            hint = suggestion(str(reference), names, "objects")
            raise self._mistake(f"{self._dictionary.device.order_code} has no {reference}", hint=hint)
        return entry, self._entry(entry, subindex)

    def _code(self, reference: CodeRef) -> Code:
        device, slot = self._dictionary.device, self._dictionary.slot
        codes = {code.number: code for code in device.codes_of_slot(slot) if not code.internal}
        if reference.number in codes:
            return codes[reference.number]
        designation = str(CodeRef(reference.number))
        other = next((code for code in device.codes if code.number == reference.number), None)
        if other is None:
            hint = suggestion(designation, [code.designation for code in codes.values()], "codes")
            raise self._mistake(f"{device.order_code} has no code {designation}", hint=hint)
        if other.internal:
            raise self._mistake(f"{designation} is internal to the drive")
        twin = next((code for code in codes.values() if code.slot and code.twin_of == other.twin_of), None)
        hint = f"in slot {slot} it is {twin.designation}" if twin else ""
        raise self._mistake(f"{designation} is a code of slot {other.slot}, not of {slot}", hint=hint)

    def _entry(self, entry: BusObject, subindex: int | None) -> Entry:
        if subindex is None and entry.object_type != "VAR":
            numbers = f"{entry.entries[0].subindex} ... {entry.entries[-1].subindex}"
            hint = f"write {entry.designation}/{entry.entries[-1].subindex} for the last one"
            raise self._mistake(f"{entry.designation} has sub-indexes {numbers}; name one of them", hint=hint)
        value = entry.entry(subindex or 0)
        label = entry.designation if subindex is None else f"{entry.designation}/{subindex}"
        if value is None:
            abort = dict(entry.refused).get(subindex or 0)
            if abort is not None:
                raise self._mistake(f"the device refuses any access to {label} with abort code 0x{abort:08X}")
            known = ", ".join(str(found.subindex) for found in entry.entries)
            raise self._mistake(f"there is no {label}", compared=[("sub-indexes", known)])
        if "w" not in value.access:
            raise self._mistake(f"{label} can only be read", compared=[("access", value.access)])
        return value

    # The value

    def _wire(self, reference: CodeRef | ObjectRef, entry: Entry) -> int | str:
        if entry.data_type.is_number:
            return self._number(reference, entry)
        if entry.data_type not in (DataType.VISIBLE_STRING, DataType.OCTET_STRING):
            raise self._mistake(f"{reference} is of type {entry.data_type.canopen_name}, which no DCF sets")
        if not holds(self._value):
            message = f"a DCF cannot hold the text '{self._value}'"
            raise self._mistake(message, hint="use printable ASCII without ; # = and quotes", at_value=True)
        if entry.length is not None and len(self._value) > entry.length:
            lengths = [("characters", str(len(self._value))), ("at most", str(entry.length))]
            raise self._mistake(f"the text is too long for {reference}", compared=lengths, at_value=True)
        return self._value

    def _number(self, reference: CodeRef | ObjectRef, entry: Entry) -> int:
        wire = self._labelled(reference, entry)
        if wire is None:
            wire = self._measured(reference, entry)
        kind = entry.data_type
        low, high = (kind.lowest, kind.highest) if entry.low is None or entry.high is None else (entry.low, entry.high)
        if not low <= wire <= high:
            legal = f"{self._shown(low, entry)} ... {self._shown(high, entry)}"
            compared = [("value", self._shown(wire, entry)), ("range", legal)]
            raise self._mistake(f"the value lies outside the range of {reference}", compared=compared, at_value=True)
        if entry.options and entry.low is None and wire not in {option.value for option in entry.options}:
            raise self._mistake(
                f"{wire} is not in the selection list of {reference}",
                compared=[("list", ", ".join(f"{option.value} ({option.label})" for option in entry.options))],
                at_value=True,
            )
        return wire

    def _labelled(self, reference: CodeRef | ObjectRef, entry: Entry) -> int | None:
        """Value whose label was typed, ``None`` where there is none."""
        typed = words(self._value)
        found = {option.value for option in entry.options if typed and words(option.label) == typed}
        if len(found) > 1:
            numbers = ", ".join(str(value) for value in sorted(found))
            message = f"'{self._value}' stands more than once in the selection list of {reference}"
            raise self._mistake(message, compared=[("values", numbers)], hint="give the number", at_value=True)
        return found.pop() if found and not self._is_number() else None

    def _is_number(self) -> bool:
        return bool(_HEXADECIMAL.fullmatch(self._value) or _DECIMAL.fullmatch(self._value))

    def _measured(self, reference: CodeRef | ObjectRef, entry: Entry) -> int:
        """Wire value of a number: decimal ones are in the unit of the code, hexadecimal ones travel as they stand."""
        if _HEXADECIMAL.fullmatch(self._value):
            return int(self._value, 16)
        if _DECIMAL.fullmatch(self._value):
            wire = Fraction(self._value) * entry.scaling
            if wire.denominator == 1:
                return wire.numerator
            step = self._shown(1, entry)
            message = f"{self._value} lies between two values of {reference}"
            raise self._mistake(message, compared=[("step", step)], at_value=True)
        try:
            return notation.node_relative(self._value).at(self._node)
        except notation.NotationError:
            labels = [option.label for option in entry.options]
            hint = suggestion(self._value, labels, "labels") if labels else "numbers are written 10, -1.5 or 0x1F"
            raise self._mistake(f"'{self._value}' is no value of {reference}", hint=hint, at_value=True) from None

    def _shown(self, wire: int, entry: Entry) -> str:
        """A wire value in the unit of the code."""
        value = Fraction(wire, entry.scaling)
        return str(value.numerator) if value.denominator == 1 else f"{float(value):g}"

    def _check_node(self, reference: CodeRef | ObjectRef, wire: int | str) -> None:
        """A node address among the settings is that of ``--node``."""
        address = self._dictionary.facts.node_address
        if not isinstance(reference, CodeRef) or address is None:
            return
        if (
            self._code(reference).twin_of == address
            and self._node in self._dictionary.facts.node_addresses
            and wire != self._node
        ):
            compared = [("--set", str(wire)), ("--node", str(self._node))]
            raise self._mistake(f"{reference} is the node address", compared=compared, hint="leave it out")
