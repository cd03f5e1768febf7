"""The first page: the devices, and the questions that people come with, each answered by links."""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

from generator.emit.html.blocks import Fact, Table
from generator.emit.html.coverage import edition, listed_sources
from generator.emit.html.links import Links
from generator.emit.html.places import code_id, error_id, object_id, page_of
from generator.emit.html.text import Piece, Prose, manual_link
from generator.emit.html.ways import Figure, Way, figures, to_address, to_errors, to_leds, to_parameters
from generator.model import Model

_QUESTIONS: tuple[tuple[str, str, Callable[[Links], Sequence[Prose]]], ...] = (
    ("question-error", "I have an error number", to_errors),
    ("question-led", "What is the LED telling me?", to_leds),
    ("question-parameter", "What is parameter \N{HORIZONTAL ELLIPSIS}?", to_parameters),
    ("question-address", "How do I set the address or the baud rate?", to_address),
)


@dataclass(frozen=True, slots=True)
class Card:
    """A device in short; ``figures`` count what is known of it and lead there."""

    title: str
    href: str
    facts: tuple[Fact, ...]
    figures: tuple[Figure, ...]


@dataclass(frozen=True, slots=True)
class Question:
    """A question with the places that answer it, device by device."""

    id: str
    text: str
    answers: tuple[Way, ...]


@dataclass(frozen=True, slots=True)
class HomeView:
    """Everything on the first page; ``devices``, ``errata`` and ``sources_count`` say how many there are."""

    devices: str
    cards: tuple[Card, ...]
    questions: tuple[Question, ...]
    errata: str
    sources_count: str
    sources: Table


@dataclass(frozen=True, slots=True)
class NotFoundView:
    """What helps a reader whose address leads nowhere; ``examples`` are addresses of entries."""

    examples: tuple[Piece, ...]
    cards: tuple[Card, ...]
    questions: tuple[Question, ...]


def not_found(devices: Sequence[Links]) -> NotFoundView:
    """View of the page of addresses that lead nowhere."""
    return NotFoundView(
        examples=tuple(dict.fromkeys(_examples(devices))),
        cards=tuple(map(_card, devices)),
        questions=tuple(question for question in _questions(devices) if question.answers),
    )


def _examples(devices: Sequence[Links]) -> Iterator[Piece]:
    """The page of a code, of an object and of an error."""
    codes = (page_of(one.device, code_id(code.number)) for one in devices for code in one.device.codes)
    objects = (page_of(one.device, object_id(entry)) for one in devices for entry in one.device.objects)
    errors = (page_of(one.device, error_id(e.kind, e.number)) for one in devices for e in one.device.errors)
    for pages in (codes, objects, errors):
        page = next(pages, "")
        if page:
            yield Piece(page, page)


def home(model: Model, devices: Sequence[Links]) -> HomeView:
    """View of the first page; ``devices`` are those of the model, as seen from it."""
    return HomeView(
        devices=str(len(devices)),
        cards=tuple(map(_card, devices)),
        questions=tuple(question for question in _questions(devices) if question.answers),
        errata=str(sum(len(links.device.errata) for links in devices)),
        sources_count=str(len(model.manuals)),
        sources=listed_sources(model),
    )


def _card(links: Links) -> Card:
    device = links.device
    facts = (
        Fact("Type", device.order_code),
        Fact("Bus", device.bus),
        Fact("Manual", (manual_link(device.manual.id), f", {edition(device.manual)}")),
    )
    return Card(device.title, page_of(device), facts, tuple(figures(links)))


def _questions(devices: Sequence[Links]) -> Iterator[Question]:
    for name, text, way in _QUESTIONS:
        answers = (Way(f"{one.device.order_code} {one.device.bus}", tuple(way(one))) for one in devices)
        yield Question(name, text, tuple(answer for answer in answers if answer.places))
