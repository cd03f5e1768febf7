"""Tables of a device by what a reader wants to know, in the order of putting it to work."""

from collections.abc import Iterable

from generator.model import Table

_TOPICS = {
    "identification": ("Identification", ("identity", "compatibility")),
    "technical-data": ("Technical data", ("technical-data",)),
    "connection": ("Terminals and pins", ("terminal", "connector")),
    "cable": ("Cable and network", ("cable", "bus-length", "topology")),
    "address": ("Address and bit rate", ("address", "baud-rate")),
    "bus": (
        "States and identifiers of the bus",
        ("protocol", "cob-id", "nmt-command", "nmt-state", "nmt-transition", "transmission-type"),
    ),
    "telegrams": ("Telegrams and commands", ("telegram", "command", "procedure")),
    "parameters": ("Parameters and settings", ("parameters", "configuration")),
    "timing": ("Timing", ("timing",)),
    "diagnosis": ("Diagnosis", ("diagnosis",)),
    "values": ("Values, types and units", ("data-type", "attributes", "units")),
    "other": ("Other tables", ("other",)),
}
"""Title of each topic, and the kinds of tables (``tables.schema.yaml``) that belong to it."""

_TOPIC_OF = {kind: topic for topic, (_, kinds) in _TOPICS.items() for kind in kinds}


ALSO = {"baudrate": "baud rate", "bitrate": "baud rate", "bit rate": "baud rate", "pinout": "connector pin"}
"""Words of the trade for things that the manuals call otherwise."""


def title_of(topic: str) -> str:
    """Heading of a topic."""
    return _TOPICS[topic][0]


def by_topic(tables: Iterable[Table]) -> dict[str, tuple[Table, ...]]:
    """Tables of every topic that has any, in the order of the topics; those of one topic by kind, as listed above."""
    found: dict[str, list[Table]] = {topic: [] for topic in _TOPICS}
    for table in tables:
        found[_TOPIC_OF.get(table.kind, "other")].append(table)
    order = {kind: place for place, kind in enumerate(_TOPIC_OF)}
    return {
        topic: tuple(sorted(group, key=lambda table: order.get(table.kind, len(order))))
        for topic, group in found.items()
        if group
    }
