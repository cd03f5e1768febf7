"""The target-free model of a device: frozen, slotted, exact.

Nothing here knows YAML, schemas, diagnostics or targets.  An object that exists is complete: the stage
that builds it (``generator.elaborate``) has resolved every reference, run and slot.  All numbers are
``int`` or ``fractions.Fraction``; floats do not occur.
"""

from generator.model.citation import ANYWHERE, Chapter, Cite, Cited, Manual, Origin, Where
from generator.model.code import Access, AttributeRow, Code, PrintedIndex, SubCode
from generator.model.device import CanOpenFacts, Device, Drive, DriveCommand, DriveModule, Model, Response, Slot
from generator.model.erratum import Erratum, ErratumPlace
from generator.model.error import ErrorEntry, PrintedNumber
from generator.model.gsd import Gsd
from generator.model.indicator import (
    CodeCounts,
    Delivered,
    IndicatorRow,
    IndicatorTable,
    Led,
    Light,
    Pattern,
    SwitchBlock,
    SwitchGroup,
    SwitchRow,
)
from generator.model.objects import CobId, DictionaryObject, StandardObject, StandardSubIndex, SubIndex
from generator.model.pin import Pin
from generator.model.reference import CodeRef, ErrorRef, ObjectRef
from generator.model.service import Choice, Does, Filler, Filling, Fillings, Message, Service, What
from generator.model.table import Column, Formula, FormulaExample, Table
from generator.model.telegram import Example, Field, FieldType, Layout, Sizes, Values
from generator.model.values import Bit, BitField, DataType, Default, NodeRelative, Option, Range

__all__ = [
    "ANYWHERE",
    "Access",
    "AttributeRow",
    "Bit",
    "BitField",
    "CanOpenFacts",
    "Chapter",
    "Choice",
    "Cite",
    "Cited",
    "CobId",
    "Code",
    "CodeCounts",
    "CodeRef",
    "Column",
    "DataType",
    "Default",
    "Delivered",
    "Device",
    "DictionaryObject",
    "Does",
    "Drive",
    "DriveCommand",
    "DriveModule",
    "Erratum",
    "ErratumPlace",
    "ErrorEntry",
    "ErrorRef",
    "Example",
    "Field",
    "FieldType",
    "Filler",
    "Filling",
    "Fillings",
    "Formula",
    "FormulaExample",
    "Gsd",
    "IndicatorRow",
    "IndicatorTable",
    "Layout",
    "Led",
    "Light",
    "Manual",
    "Message",
    "Model",
    "NodeRelative",
    "ObjectRef",
    "Option",
    "Origin",
    "Pattern",
    "Pin",
    "PrintedIndex",
    "PrintedNumber",
    "Range",
    "Response",
    "Service",
    "Sizes",
    "Slot",
    "StandardObject",
    "StandardSubIndex",
    "SubCode",
    "SubIndex",
    "SwitchBlock",
    "SwitchGroup",
    "SwitchRow",
    "Table",
    "Values",
    "What",
    "Where",
]
