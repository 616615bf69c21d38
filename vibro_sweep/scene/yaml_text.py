"""YAML as people mean it: the core schema of YAML 1.2, and nothing that can surprise or explode.

PyYAML resolves plain scalars by YAML 1.1, where ``1e-9`` is a string, ``010`` is eight and ``no`` is false.
The loader below keeps PyYAML's scanner and parser and resolves by YAML 1.2 (section 10.3.2) instead. A key
given twice, anchors, aliases and tags, deep nesting and very long texts are errors.
"""

import re

from yaml.composer import Composer
from yaml.constructor import BaseConstructor
from yaml.error import MarkedYAMLError, YAMLError
from yaml.events import AliasEvent
from yaml.nodes import MappingNode, ScalarNode, SequenceNode
from yaml.parser import Parser
from yaml.reader import Reader
from yaml.resolver import BaseResolver
from yaml.scanner import Scanner

MAX_BYTES = 250_000  # two seconds
MAX_DEPTH = 20


class YAMLTextError(ValueError):
    """The text is not the YAML that is read here; the message says where and why."""


def read_yaml(text: str) -> object:
    """The value of one YAML document: dict, list, str, int, float, bool or None.

    Raises YAMLTextError for what is not YAML, for more than one document, and for what the module refuses.
    """
    if len(text.encode(errors="replace")) > MAX_BYTES:
        raise YAMLTextError(f"longer than {MAX_BYTES} bytes")
    try:
        loader = _Loader(text)
        return loader.get_single_data()
    except MarkedYAMLError as error:
        mark = error.problem_mark or error.context_mark
        problem = ", ".join(part for part in (error.context, error.problem) if part)
        hint = _hint(error, text.splitlines()[: mark.line + 1])
        raise YAMLTextError(f"line {mark.line + 1}, column {mark.column + 1}: {problem}{hint}") from None
    except YAMLError as error:
        raise YAMLTextError(" ".join(str(error).split())) from None
    except (ValueError, OverflowError):  # PyYAML looks at no more than the digits of "\UFFFFFFFF"
        mark = loader.get_mark()
        raise YAMLTextError(f"line {mark.line + 1}, column {mark.column + 1}: an escape of no character") from None


def _hint(error: MarkedYAMLError, lines: list[str]) -> str:
    """The hint on what is likely to be meant, by the lines up to the one where reading stopped."""
    if "\\t" in (error.problem or ""):
        return "; lines are indented with spaces, not with tabs"
    for number, line in enumerate(lines, 1):
        if match := re.match(r"\s*(\w+)(:)([^\s:/].*)", line):
            return f"; line {number} needs a space after the colon: `{match[1]}: {match[3]}`"
    if error.context == "while parsing a flow mapping" or error.context == "while parsing a flow sequence":
        first_line = error.context_mark.line + 1
        return f"; a comma is missing, or the bracket that begins in line {first_line} is not closed"
    if error.problem == "mapping values are not allowed here":
        return "; the line is indented more than the one above it, or has a colon too many"
    return ""


def lines_of(text: str) -> dict[str, int]:
    """The line of each key and of each entry of a list, by its path, as `sweep.b.values[2]`; of a text that is YAML."""
    lines = {}

    def walk(node, path: str) -> None:
        if isinstance(node, MappingNode):
            for key, value in node.value:
                name = f"{path}.{key.value}" if path else key.value
                lines[name] = key.start_mark.line + 1
                walk(value, name)
        elif isinstance(node, SequenceNode):
            for i, item in enumerate(node.value):
                lines[f"{path}[{i}]"] = item.start_mark.line + 1
                walk(item, f"{path}[{i}]")

    walk(_Loader(text).get_single_node(), "")
    return lines


class _Loader(Reader, Scanner, Parser, Composer, BaseConstructor, BaseResolver):
    def __init__(self, text):
        Reader.__init__(self, text)
        Scanner.__init__(self)
        Parser.__init__(self)
        Composer.__init__(self)
        BaseConstructor.__init__(self)
        BaseResolver.__init__(self)
        self.depth = 0

    def compose_node(self, parent, index):
        event = self.peek_event()
        if isinstance(event, AliasEvent):
            raise _error(f"aliases are not allowed here: *{event.anchor}", event)
        if event.anchor is not None:
            raise _error(f"anchors are not allowed here: &{event.anchor}", event)
        if event.tag is not None:
            raise _error(f"tags are not allowed here: {event.tag}", event)
        if self.depth == MAX_DEPTH:
            raise _error(f"nested more than {MAX_DEPTH} levels deep", event)
        self.depth += 1
        node = super().compose_node(parent, index)
        self.depth -= 1
        if isinstance(node, ScalarNode) and any("\ud800" <= letter <= "\udfff" for letter in node.value):
            raise _error("an escape of no character", event)
        return node

    def construct_map(self, node):
        mapping = {}
        for key_node, value_node in node.value:
            key = key_node.value
            if not isinstance(key, str):
                raise _error("a key must be a word", key_node)
            if key in mapping:
                raise _error(f"the key {key!r} is given twice", key_node)
            mapping[key] = self.construct_object(value_node, deep=True)
        return mapping

    def construct_int(self, node):
        base = {"0o": 8, "0x": 16}.get(node.value[:2], 10)
        try:
            return int(node.value, base)
        except ValueError:  # Python refuses to convert thousands of digits
            raise _error(f"an integer of {len(node.value)} digits", node) from None

    def construct_float(self, node):
        return float(re.sub(r"\.(inf|nan)", r"\1", node.value.lower()))


def _error(problem, at):
    return MarkedYAMLError(problem=problem, problem_mark=at.start_mark)


def _scalar(name, pattern, first, construct):
    tag = f"tag:yaml.org,2002:{name}"
    _Loader.add_implicit_resolver(tag, re.compile(rf"(?:{pattern})\Z"), list(first))
    _Loader.add_constructor(tag, construct)


_scalar("bool", "true|True|TRUE|false|False|FALSE", "tTfF", lambda loader, node: node.value.lower() == "true")
_scalar("int", r"[-+]?[0-9]+|0o[0-7]+|0x[0-9a-fA-F]+", "-+0123456789", _Loader.construct_int)
_scalar(
    "float",
    r"[-+]?(?:\.[0-9]+|[0-9]+(?:\.[0-9]*)?)(?:[eE][-+]?[0-9]+)?|[-+]?\.(?:inf|Inf|INF)|\.(?:nan|NaN|NAN)",
    "-+.0123456789",
    _Loader.construct_float,
)
_scalar("null", "null|Null|NULL|~|", ["n", "N", "~", ""], lambda loader, node: None)
_Loader.add_constructor("tag:yaml.org,2002:str", lambda loader, node: node.value)
_Loader.add_constructor(
    "tag:yaml.org,2002:seq",
    lambda loader, node: [loader.construct_object(item, deep=True) for item in node.value],
)
_Loader.add_constructor("tag:yaml.org,2002:map", _Loader.construct_map)
