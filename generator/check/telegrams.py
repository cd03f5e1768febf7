"""Checks of what can be executed: telegrams, formulas, DIP switches, LED patterns."""

from collections.abc import Iterator
from dataclasses import replace
from itertools import combinations

from generator.check.finding import Finding
from generator.check.objects import missing_code
from generator.codec import CodecError, decode, encode
from generator.model import Choice, CodeRef, DataType, Device, Example, Layout, Message, Model, Service, Values
from generator.model.telegram import OPEN, Value
from generator.wire import Call, Layouts, Octets, agree, bind, build, carries

_TO_DEVICE = "to device"

_TERMINALS = "terminal"
"""Kind of the tables that list the labels on a module."""


def examples(model: Model, device: Device) -> Iterator[Finding]:
    """Rules telegram-bytes, telegram-values: each example decodes to its values and encodes to its bytes."""
    layouts = {layout.id: layout for layout in device.layouts}
    for example in device.examples:
        if example.printed != example.data:
            yield _finding(
                "telegram-bytes",
                example,
                show(example.printed),
                show(example.data),
                f"the printed bytes of '{example.id}' are not the ones that are used",
            )
        yield from _executed(example, layouts[example.layout])


def _executed(example: Example, layout: Layout) -> Iterator[Finding]:
    try:
        values = decode(layout, example.data)
    except CodecError as error:
        yield _finding(
            "telegram-values", example, show(example.data), layout.id, f"'{example.id}' does not decode: {error}"
        )
        return
    for name, said, found in _differences(example.values, values, ""):
        yield _finding(
            "telegram-values",
            example,
            str(said),
            str(found),
            f"'{example.id}': {name} is {_hex(found)} in the bytes, not {_hex(said)}",
        )
    try:
        data = encode(layout, example.values)
    except CodecError as error:
        yield _finding(
            "telegram-values", example, show(example.data), layout.id, f"'{example.id}' does not encode: {error}"
        )
        return
    if len(data) != len(example.data) or any(
        a != b for a, b in zip(data, example.data, strict=True) if a is not None and b is not None
    ):
        yield _finding(
            "telegram-bytes",
            example,
            show(example.data),
            show(data),
            f"the values of '{example.id}' encode to other bytes",
        )


def show(data: tuple[int | None, ...]) -> str:
    """Bytes as the spec writes them."""
    return " ".join("XX" if octet is None else f"{octet:02X}" for octet in data)


def _hex(value: Value) -> str:
    return f"{value} (0x{value:X})" if isinstance(value, int) and value >= 0 else str(value)


def _differences(said: Values, found: Values, path: str) -> Iterator[tuple[str, Value, Value]]:
    for name, value in said.items():
        actual = found.get(name, "absent")
        if isinstance(value, tuple) and isinstance(actual, tuple) and len(value) == len(actual):
            for position, (a, b) in enumerate(zip(value, actual, strict=True)):
                yield from _differences(a, b, f"{path}{name}[{position}].")
        elif value != actual and OPEN not in (value, actual):
            yield path + name, value, actual


def _finding(rule: str, example: Example, printed: str, expected: str, message: str) -> Finding:
    return Finding(
        rule=rule,
        subject=f"telegram:{example.id}",
        place="bytes",
        printed=printed,
        expected=expected,
        message=message,
        where=example.where,
    )


def identifiers(model: Model, device: Device) -> Iterator[Finding]:
    """Rule cob-id: the identifier of an example is one that the predefined connection set gives its node."""
    for example in device.examples:
        if example.identifier is None or example.node is None:
            continue
        if example.identifier not in [cob_id.at(example.node) for cob_id in model.cob_ids]:
            yield Finding(
                rule="cob-id",
                subject=f"telegram:{example.id}",
                place="identifier",
                printed=example.identifier,
                expected="none",
                message=f"0x{example.identifier:X} is no predefined identifier of node {example.node}",
                where=example.where,
            )


def services(model: Model, device: Device) -> Iterator[Finding]:
    """Rules reference and telegram-service: services tell errors that are listed, and build the examples."""
    kinds = {error.kind for error in device.errors}
    for service in device.services:
        if service.errors is not None and service.errors not in kinds:
            yield Finding(
                rule="reference",
                subject=f"service:{service.id}",
                place="errors",
                printed=service.errors,
                expected=", ".join(sorted(kinds)) or "none",
                message=f"the device has no errors of kind '{service.errors}'",
                where=service.where,
            )
    layouts = {layout.id: layout for layout in device.layouts}
    for example in device.examples:
        used = [
            (service, message)
            for service in device.services
            for message in (service.request if example.direction == _TO_DEVICE else service.answer,)
            if message is not None and example.layout in _layouts(message)
        ]
        built = [data for service, message in used for data in _rebuilt(service, message, layouts, example)]
        if built and not any(agree(data, example.data) for data in built):
            nearest = max(built, key=lambda data: sum(a == b for a, b in zip(data, example.data, strict=False)))
            yield _finding(
                "telegram-service",
                example,
                show(example.data),
                show(nearest),
                f"no service of the device builds '{example.id}'",
            )


def messages(model: Model, device: Device) -> Iterator[Finding]:
    """Rule telegram-service: the telegrams of a service can be built with the greatest numbers of the device."""
    layouts = {layout.id: layout for layout in device.layouts}
    numbers = Call(
        index=max([*(code.index for code in device.codes), *(entry.index for entry in device.objects)], default=0),
        code=max((code.number for code in device.codes), default=0),
        subindex=max((sub.number for entry in device.objects for sub in entry.subindexes), default=0),
        register=0,
    )
    for service in device.services:
        error = max((entry.last for entry in device.errors if entry.kind == service.errors), default=0)
        for data_type in (data_type for data_type in DataType if carries(service, data_type)):
            value = 0 if data_type.is_number else b""
            call = replace(numbers, data_type=data_type, error=error, value=value)
            problem = next((p for m in service.messages if (p := _obstacle(service, m, layouts, call))), None)
            if problem is not None:
                yield Finding(
                    rule="telegram-service",
                    subject=f"service:{service.id}",
                    place="values",
                    printed=problem,
                    expected="a telegram",
                    message=f"a telegram of '{service.id}' cannot be built: {problem}",
                    where=service.where,
                    hint="correct 'values', or the layout",
                )
                break


def _obstacle(service: Service, message: Message, layouts: Layouts, call: Call) -> str | None:
    try:
        build(service, message, layouts, call)
    except CodecError as error:
        return str(error)
    return None


def _layouts(message: Message) -> tuple[object, ...]:
    if isinstance(message.layout, Choice):
        return tuple(name for _, name in message.layout.cases)
    return (message.layout,)


def _rebuilt(service: Service, message: Message, layouts: Layouts, example: Example) -> Iterator[Octets]:
    """What a service makes of what an example says, once for each data type that it may be about."""
    for data_type in DataType:
        call = bind(message, layouts, example.data, Call(data_type=data_type))
        if call is None:
            continue
        try:
            yield build(service, message, layouts, call).data
        except CodecError:
            continue


def formulas(model: Model, device: Device) -> Iterator[Finding]:
    """Rule formula-example: worked examples give the printed result."""
    for formula in device.formulas:
        for example in formula.examples:
            try:
                result = formula.evaluate(dict(example.values))
            except KeyError as error:
                yield Finding(
                    rule="formula-example",
                    subject=f"formula:{formula.id}",
                    place="values",
                    printed="none",
                    expected=str(error.args[0]),
                    message=f"the example gives no value for {error.args[0]}",
                    where=example.where,
                )
                continue
            except ZeroDivisionError:
                yield Finding(
                    rule="formula-example",
                    subject=f"formula:{formula.id}",
                    place="values",
                    printed=example.result,
                    expected="none",
                    message=f"{formula.expression} divides by 0",
                    where=example.where,
                )
                continue
            if result != example.result:
                yield Finding(
                    rule="formula-example",
                    subject=f"formula:{formula.id}",
                    place="result",
                    printed=example.result,
                    expected=result,
                    message=f"{formula.expression} gives {result}, not {example.result}",
                    where=example.where,
                )


def assignments(model: Model, device: Device) -> Iterator[Finding]:
    """Rule connector-pins: the assignment of a connector names each of its contacts once."""
    for table in device.tables:
        if table.assignment is None:
            continue
        printed = sorted(str(pin) for pin, _ in table.assignment.signals)
        contacts = sorted(str(contact.number) for contact in table.assignment.connector.contacts)
        if printed != contacts:
            yield Finding(
                rule="connector-pins",
                subject=f"table:{table.id}",
                place="contacts",
                printed=", ".join(printed),
                expected=", ".join(contacts),
                message=f"the contacts of the table are not those of the {table.assignment.connector.name}",
                where=table.where,
            )


def switches(model: Model, device: Device) -> Iterator[Finding]:
    """Rules switch-row, switch-distinct and reference: weights give the printed value, no position stands twice."""
    for group in device.switches:
        subject = f"switch:{group.id}"
        for row in group.rows:
            if (
                group.weights
                and row.value.isdecimal()
                and "x" not in row.positions
                and group.sum(row.positions) != int(row.value)
            ):
                yield Finding(
                    rule="switch-row",
                    subject=subject,
                    place=f"row {row.value}",
                    printed=row.positions,
                    expected=str(group.sum(row.positions)),
                    message=f"the switches of row {row.value} add up to {group.sum(row.positions)}",
                    where=row.where,
                )
        for a, b in combinations(group.rows, 2):
            if a.fits(b.positions):
                yield Finding(
                    rule="switch-distinct",
                    subject=subject,
                    place=f"row {b.value}",
                    printed=b.positions,
                    expected="a position of its own",
                    message=f"the rows {a.value} and {b.value} have the same position",
                    where=b.where,
                )
        named = [("sets", ref) for ref in group.sets]
        named += [("code_counts", ref) for ref in (group.code_counts.codes if group.code_counts else ())]
        for place, ref in named:
            problem = missing_code(CodeRef(ref.number, ref.subcode), device)
            if problem:
                yield Finding(
                    rule="reference",
                    subject=subject,
                    place=place,
                    printed=str(ref),
                    expected="a code of the device",
                    message=problem,
                    where=group.where,
                )
        terminals = {row[0] for table in device.tables if table.kind == _TERMINALS for row in table.rows}
        if group.block and group.block.label not in terminals:
            yield Finding(
                rule="reference",
                subject=subject,
                place="block",
                printed=group.block.label,
                expected="the first cell of a row of a table of terminals",
                message=f"no table of terminals has '{group.block.label}'",
                where=group.where,
            )


def patterns(model: Model, device: Device) -> Iterator[Finding]:
    """Rule led-pattern: the rows of an LED table can be told apart."""
    for table in device.indicators:
        for a, b in combinations(table.rows, 2):
            if all(p.overlaps(q) for p, q in zip(a.patterns, b.patterns, strict=True)):
                yield Finding(
                    rule="led-pattern",
                    subject=f"led:{table.id}",
                    place=f"row {b.state}",
                    printed=b.state,
                    expected=a.state,
                    message=f"'{a.state}' and '{b.state}' look the same",
                    where=b.where,
                )
