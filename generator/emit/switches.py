"""What the positions of DIP switches mean, in sentences."""

from generator.model import SwitchGroup


def stand(group: SwitchGroup, positions: str) -> str:
    """Positions as a sentence would say them: "ON" of a single switch, "all OFF", "16, 4 ON"; "x" is left out."""
    shown = {"1": "ON", "0": "OFF"}
    kinds = set(positions)
    if len(kinds) == 1 and kinds <= set(shown):
        return shown[positions[0]] if len(positions) == 1 else f"all {shown[positions[0]]}"
    marked = (
        (word, [label for label, position in zip(group.labels, positions, strict=True) if position == sign])
        for sign, word in shown.items()
    )
    return ", ".join(f"{' '.join(labels)} {word}" for word, labels in marked if labels)


def remarks(group: SwitchGroup) -> tuple[str, ...]:
    """What there is to say of a group beyond its rows: its block, its state when new, when a code counts, its notes."""
    derived = []
    if group.block is not None:
        derived.append(f"Part of the block {group.block.label}.")
    if group.delivered is not None:
        derived.append(f"Delivered with the switches {stand(group, group.delivered.positions)}.")
    if group.code_counts is not None:
        codes = " / ".join(map(str, group.code_counts.codes))
        when = " or ".join(stand(group, positions) for positions in group.code_counts.positions)
        derived.append(f"With the switches {when}, {codes} counts instead of them.")
    return (*derived, *group.notes)
