"""A device as it is set up in one network: its DCF (CiA 306), and its EDS with the node-ID already added.

Not a target of the build: what a file holds depends on the settings that a user names.
"""

from collections.abc import Iterator

from generator.emit.base import Output
from generator.emit.canopen import Configuration, ObjectDictionary, at_node, number_text
from generator.emit.eds import file_stem, output, text
from generator.model import Model


def render(model: Model, dictionary: ObjectDictionary, configuration: Configuration) -> dict[str, Output]:
    """The two files by name; both hold numbers where the device's rules follow the node-ID.

    Raises:
        EmitError: A name, default or text cannot be written in an EDS.
    """
    stem = f"{file_stem(dictionary)}_node{configuration.node}"
    eds, dcf = f"{stem}.eds", f"{stem}.dcf"
    resolved = at_node(dictionary, configuration.node)
    notes = [f"For node-ID {configuration.node} alone, which the identifiers below contain."]
    settings = list(_settings(resolved, configuration))
    if settings:
        settings = [f"Set: {', '.join(settings)}."]
    network = f"The bit rate is {configuration.bit_rate} kbit/s; name and number of the network are placeholders."
    return {
        eds: output(text(model, resolved, eds, notes=notes)),
        dcf: output(
            text(
                model,
                resolved,
                dcf,
                notes=[*notes, network, *settings],
                configuration=configuration,
                last_eds=eds,
            )
        ),
    }


def _settings(dictionary: ObjectDictionary, configuration: Configuration) -> Iterator[str]:
    for entry in dictionary.objects:
        for value in entry.entries:
            setting = configuration.values.get((entry.index, value.subindex))
            if setting is not None:
                label = entry.designation if entry.object_type == "VAR" else f"{entry.designation}/{value.subindex}"
                yield f"{label} to {number_text(value, setting) if isinstance(setting, int) else setting}"
